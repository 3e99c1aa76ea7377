#include "nav/stereo/pose_judge.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace polnav::nav {
namespace {

// Chi square of six degrees of freedom that one in 3,000 exceeds. Over four scenarios without a
// fault of the IMU (5,800 frames) none exceeded 17; drops on the lens reach 200, a stuck IMU 40.
constexpr double kContradiction = 25.0;

// Of the proven landmarks must agree. A coach that pulls away may fill seven tenths of the view; in
// a fault of the IMU nine tenths and more agree with each other.
constexpr double kNearlyAll = 0.8;

// Of all points must agree where the proven landmarks do not tell: drops on the lens make six
// tenths.
constexpr double kMost = 0.7;

// With fewer of all points agreeing with the IMU, the pictures are asked alone.
constexpr double kFew = 0.5;

double SquareOf(const Pose& T_WB, const Pose& expected, const Matrix6d& covariance) {
  const Eigen::Matrix<double, 6, 1> d = Difference(T_WB, expected);
  return d.dot(Eigen::LDLT<Matrix6d>(covariance).solve(d));
}

bool IsNearlyAll(int agreeing, const std::vector<LandmarkView>& proven, int min_inliers) {
  return agreeing >= min_inliers && agreeing >= kNearlyAll * static_cast<double>(proven.size());
}

int ProvenInliers(const PoseSolution& solution, const std::vector<LandmarkView>& views) {
  int n = 0;
  for (std::size_t i = 0; i < views.size(); ++i) n += solution.inlier[i] && views[i].proven;
  return n;
}

// Squares of what the views are off by at a pose. One that does not fit at all counts as four: a
// single point on something that moves must not outvote the rest.
double CostOf(const RectifiedCamera& camera, const std::vector<LandmarkView>& views,
              const Pose& T_WB, const PixelSigmas& sigmas) {
  constexpr double kMostOfOne = 4.0;
  const Viewpoint target = ViewpointOf(camera, T_WB);
  double cost = 0.0;
  for (const LandmarkView& view : views) {
    const auto e = Reproject(camera, view.host, target, view.landmark, view.pixel, sigmas);
    cost += e ? std::min(e->residual.squaredNorm(), kMostOfOne) : kMostOfOne;
  }
  return cost;
}

// What the proven landmarks say by themselves.
struct Testimony {
  std::vector<LandmarkView> proven;
  std::optional<PoseSolution> alone;  // nothing where they do not agree with each other
  std::optional<PoseSolution> with_imu;
  bool against_imu = false;
};

Testimony Hear(const RectifiedCamera& camera, const PoseQuestion& question,
               const PoseSolverOptions& options, int min_inliers) {
  const PosePrior& by_imu = question.by_imu;
  Testimony t;
  std::ranges::copy_if(question.all, std::back_inserter(t.proven), &LandmarkView::proven);
  t.alone = SolvePose(camera, t.proven, by_imu.T_WB, options, min_inliers);
  if (t.alone && !IsNearlyAll(t.alone->inliers, t.proven, min_inliers)) t.alone.reset();
  t.with_imu = SolvePose(camera, t.proven, by_imu.T_WB, options, min_inliers, by_imu);
  if (!t.alone || !t.with_imu) {
    t.against_imu = t.alone.has_value();
    return t;
  }
  // A ratio of likelihoods: few points may fit another pose as well, and the IMU all the same.
  const double compromise = CostOf(camera, t.proven, t.with_imu->T_WB, options.sigmas) +
                            SquareOf(t.with_imu->T_WB, by_imu.T_WB, by_imu.covariance);
  const double free = CostOf(camera, t.proven, t.alone->T_WB, options.sigmas);
  t.against_imu = compromise > free + kContradiction;
  return t;
}

}  // namespace

PoseVerdict JudgePose(const RectifiedCamera& camera, const PoseQuestion& question,
                      const PoseSolverOptions& options, int min_inliers) {
  const PosePrior& by_imu = question.by_imu;
  PoseVerdict verdict{
      .solution = SolvePose(camera, question.kept, by_imu.T_WB, options, min_inliers, by_imu),
      .views = question.kept};
  const auto& first = verdict.solution;
  const auto all = static_cast<double>(question.all.size());
  const bool contradicts =
      first && SquareOf(first->T_WB, by_imu.T_WB, by_imu.covariance) > kContradiction;
  const bool few = !first || first->inliers < kFew * all;
  if (!contradicts && !few) return verdict;

  const Testimony heard = Hear(camera, question, options, min_inliers);
  if (heard.against_imu) {
    return {.solution = SolvePose(camera, question.all, heard.alone->T_WB, options, min_inliers),
            .views = question.all,
            .imu_wrong = true};
  }
  if (!contradicts) return verdict;
  // Proven landmarks that are far bear either out: then all points together have to be many more.
  if (first->inliers > kMost * all &&
      IsNearlyAll(ProvenInliers(*first, question.kept), heard.proven, min_inliers)) {
    verdict.imu_wrong = true;
    return verdict;
  }
  if (!heard.alone) return {.solution = {}, .views = {}, .pictures_wrong = true};
  return {.solution = heard.with_imu, .views = heard.proven, .pictures_wrong = true};
}

}  // namespace polnav::nav
