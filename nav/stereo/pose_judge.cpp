#include "nav/stereo/pose_judge.h"

#include <Eigen/Cholesky>
#include <algorithm>

namespace polnav::nav {
namespace {

// Chi square of six degrees of freedom that one in 3,000 exceeds. Over five scenarios without a
// fault of the IMU (7,000 frames) none exceeded 17; drops on the lens reach 200, a stuck IMU 40.
constexpr double kContradiction = 25.0;

// Of the proven landmarks must agree. A coach that pulls away may fill seven tenths of the view; in
// a fault of the IMU nine tenths and more agree with each other.
constexpr double kNearlyAll = 0.8;

// Of all points must agree where the proven landmarks do not tell: drops on the lens make six
// tenths.
constexpr double kMost = 0.7;

// With fewer of all points agreeing with the IMU, the pictures are asked alone.
constexpr double kFew = 0.5;

bool Contradicts(const Pose& T_WB, const Pose& expected, const Matrix6d& covariance) {
  const Eigen::Matrix<double, 6, 1> d = Difference(T_WB, expected);
  return d.dot(Eigen::LDLT<Matrix6d>(covariance).solve(d)) > kContradiction;
}

bool IsNearlyAll(int agreeing, const std::vector<LandmarkView>& proven, int min_inliers) {
  return agreeing >= min_inliers && agreeing >= kNearlyAll * static_cast<double>(proven.size());
}

int ProvenInliers(const PoseSolution& solution, const std::vector<LandmarkView>& views) {
  int n = 0;
  for (std::size_t i = 0; i < views.size(); ++i) n += solution.inlier[i] && views[i].proven;
  return n;
}

}  // namespace

PoseVerdict JudgePose(const RectifiedCamera& camera, const PoseQuestion& question,
                      const PoseSolverOptions& options, int min_inliers) {
  const PosePrior& by_imu = question.by_imu;
  PoseVerdict verdict{
      .solution = SolvePose(camera, question.kept, by_imu.T_WB, options, min_inliers, by_imu),
      .views = question.kept};
  const auto& first = verdict.solution;
  const bool contradicts = first && Contradicts(first->T_WB, by_imu.T_WB, by_imu.covariance);
  const bool few = !first || first->inliers < kFew * static_cast<double>(question.all.size());
  if (!contradicts && !few) return verdict;

  std::vector<LandmarkView> proven;
  std::ranges::copy_if(question.all, std::back_inserter(proven), &LandmarkView::proven);
  const bool proven_stand =
      first && IsNearlyAll(ProvenInliers(*first, question.kept), proven, min_inliers);
  const auto alone = SolvePose(camera, proven, by_imu.T_WB, options, min_inliers);
  const bool agreed = alone && IsNearlyAll(alone->inliers, proven, min_inliers);
  if (agreed && Contradicts(alone->T_WB, by_imu.T_WB, by_imu.covariance + alone->covariance)) {
    return {.solution = SolvePose(camera, question.all, alone->T_WB, options, min_inliers),
            .views = question.all,
            .imu_wrong = true};
  }
  if (!contradicts) return verdict;
  // Proven landmarks that are far bear either out: then all points together have to be many more.
  if (proven_stand && first->inliers > kMost * static_cast<double>(question.all.size())) {
    verdict.imu_wrong = true;
    return verdict;
  }
  if (!agreed) return {.solution = {}, .views = {}, .pictures_wrong = true};
  return {.solution = SolvePose(camera, proven, by_imu.T_WB, options, min_inliers, by_imu),
          .views = proven,
          .pictures_wrong = true};
}

}  // namespace polnav::nav
