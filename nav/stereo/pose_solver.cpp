#include "nav/stereo/pose_solver.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace polnav::nav {
namespace {

struct Normal {
  Matrix6d H = Matrix6d::Zero();
  Eigen::Matrix<double, 6, 1> g = Eigen::Matrix<double, 6, 1>::Zero();
};

struct PriorInformation {
  Pose T_WB;
  Matrix6d information;
};

std::optional<PriorInformation> InformationOf(const std::optional<PosePrior>& prior) {
  if (!prior) return std::nullopt;
  return PriorInformation{prior->T_WB,
                          Eigen::LDLT<Matrix6d>(prior->covariance).solve(Matrix6d::Identity())};
}

Normal Linearize(const RectifiedCamera& camera, const std::vector<LandmarkView>& views,
                 const Pose& T_WB, const PoseSolverOptions& options,
                 const std::optional<PriorInformation>& prior) {
  Normal n;
  if (prior) {
    n.H = prior->information;
    n.g = n.H * Difference(T_WB, prior->T_WB);
  }
  const Viewpoint target = ViewpointOf(camera, T_WB);
  for (const LandmarkView& view : views) {
    const auto e = Reproject(camera, view.host, target, view.landmark, view.pixel, options.sigmas);
    if (!e) continue;
    const double norm = e->residual.norm();
    const double weight = norm <= options.huber_sigmas ? 1.0 : options.huber_sigmas / norm;
    n.H += weight * e->by_target.transpose() * e->by_target;
    n.g += weight * e->by_target.transpose() * e->residual;
  }
  return n;
}

}  // namespace

std::optional<PoseSolution> SolvePose(const RectifiedCamera& camera,
                                      const std::vector<LandmarkView>& views, const Pose& T_WB,
                                      const PoseSolverOptions& options, int min_inliers,
                                      const std::optional<PosePrior>& prior) {
  if (static_cast<int>(views.size()) < min_inliers) return std::nullopt;
  const std::optional<PriorInformation> known = InformationOf(prior);
  PoseSolution solution{.T_WB = T_WB};
  for (int i = 0; i < options.max_iterations; ++i) {
    const Normal n = Linearize(camera, views, solution.T_WB, options, known);
    const Eigen::LDLT<Matrix6d> solver(n.H);
    if (solver.info() != Eigen::Success || !solver.isPositive()) return std::nullopt;
    const Eigen::Matrix<double, 6, 1> step = -solver.solve(n.g);
    if (!step.allFinite()) return std::nullopt;
    solution.T_WB = Perturb(solution.T_WB, step);
    // 1e-5 m and 1e-5 rad: a hundredth of what one frame's pixels resolve.
    if (step.cwiseAbs().maxCoeff() < 1e-5) break;
  }
  std::vector<LandmarkView> inliers;
  double chi2 = 0.0;
  int degrees_of_freedom = -6;
  const Viewpoint target = ViewpointOf(camera, solution.T_WB);
  for (const LandmarkView& view : views) {
    const auto e = Reproject(camera, view.host, target, view.landmark, view.pixel, options.sigmas);
    const bool in = e && e->residual.cwiseAbs().maxCoeff() <= options.inlier_sigmas;
    solution.inlier.push_back(in);
    if (!in) continue;
    inliers.push_back(view);
    chi2 += e->residual.squaredNorm();
    degrees_of_freedom += view.pixel.disparity_px ? 3 : 2;
  }
  solution.inliers = static_cast<int>(inliers.size());
  if (solution.inliers < min_inliers) return std::nullopt;
  const Normal n = Linearize(camera, inliers, solution.T_WB, options, known);
  const Eigen::LDLT<Matrix6d> solver(n.H);
  if (solver.info() != Eigen::Success || !solver.isPositive()) return std::nullopt;
  solution.T_WB = Perturb(solution.T_WB, -solver.solve(n.g));
  solution.nis = chi2 / std::max(1, degrees_of_freedom);
  solution.covariance = solver.solve(Matrix6d::Identity());
  return solution;
}

}  // namespace polnav::nav
