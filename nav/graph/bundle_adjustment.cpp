#include "nav/graph/bundle_adjustment.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <memory>

#include "nav/graph/costs.h"

namespace polnav::nav {
namespace {

// Owns what Ceres works on and writes the solution back. Ceres eliminates the blocks of a group in
// the order of their addresses: each kind lives in one array, in the window's order, or the sums
// would depend on where the heap put things.
class Problem {
 public:
  Problem(const RectifiedCamera& camera, const BundleAdjustmentOptions& options, Window& window)
      : camera_(camera), options_(options), window_(window), huber_(options.huber_sigmas) {
    ceres::Problem::Options problem_options;
    problem_options.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    problem_options.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    problem_ = std::make_unique<ceres::Problem>(problem_options);
    AddKeyframes();
    AddLandmarks();
  }

  BundleAdjustmentSummary Solve() {
    ceres::Solver::Options solver;
    solver.linear_solver_type = ceres::DENSE_SCHUR;
    solver.linear_solver_ordering = ordering_;
    solver.max_num_iterations = options_.max_iterations;
    solver.num_threads = 1;  // sums in one order: the same bytes everywhere
    solver.function_tolerance = 1e-6;
    solver.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(solver, problem_.get(), &summary);
    if (summary.IsSolutionUsable()) WriteBack();
    return {.usable = summary.IsSolutionUsable(),
            .iterations = static_cast<int>(summary.iterations.size()),
            .initial_cost = summary.initial_cost,
            .final_cost = summary.final_cost};
  }

 private:
  void AddKeyframes() {
    ordering_ = std::make_shared<ceres::ParameterBlockOrdering>();
    poses_.reserve(window_.keyframes.size());
    for (const Keyframe& k : window_.keyframes) poses_.push_back(ToBlock(k.T_WB));
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      problem_->AddParameterBlock(poses_[i].data(), 7, &manifold_);
      ordering_->AddElementToGroup(poses_[i].data(), 1);
      const Keyframe& k = window_.keyframes[i];
      if (k.heading) {
        problem_->AddResidualBlock(new HeadingCost(*k.heading), nullptr, poses_[i].data());
      }
      if (k.level) problem_->AddResidualBlock(new LevelCost(*k.level), nullptr, poses_[i].data());
    }
    std::vector<double*> first;
    for (std::size_t i = 0; i < window_.prior.linearized.size(); ++i) {
      first.push_back(poses_[i].data());
    }
    problem_->AddResidualBlock(new PriorCost(window_.prior), nullptr, first);
  }

  void AddLandmarks() {
    coordinates_.reserve(window_.landmarks.size());
    for (const auto& [id, landmark] : window_.landmarks) {
      coordinates_.push_back(landmark.coordinates);
      double* coordinates = coordinates_.back().data();
      problem_->AddParameterBlock(coordinates, 3);
      ordering_->AddElementToGroup(coordinates, 0);
      const std::size_t host = IndexOf(window_, landmark.host);
      for (const Sighting& s : landmark.sightings) {
        if (s.keyframe == landmark.host) {
          problem_->AddResidualBlock(new HostCost(camera_, s.pixel, options_.sigmas), &huber_,
                                     coordinates);
          continue;
        }
        problem_->AddResidualBlock(new ReprojectionCost(camera_, s.pixel, options_.sigmas), &huber_,
                                   poses_[host].data(), poses_[IndexOf(window_, s.keyframe)].data(),
                                   coordinates);
      }
    }
  }

  void WriteBack() {
    for (std::size_t i = 0; i < poses_.size(); ++i) {
      window_.keyframes[i].T_WB = ToPose(poses_[i].data());
    }
    std::size_t next = 0;
    for (auto& [id, landmark] : window_.landmarks) landmark.coordinates = coordinates_[next++];
  }

  const RectifiedCamera& camera_;
  const BundleAdjustmentOptions& options_;
  Window& window_;
  ceres::HuberLoss huber_;
  PoseManifold manifold_;
  std::vector<PoseBlock> poses_;
  std::vector<Eigen::Vector3d> coordinates_;
  std::shared_ptr<ceres::ParameterBlockOrdering> ordering_;
  std::unique_ptr<ceres::Problem> problem_;
};

}  // namespace

BundleAdjustmentSummary AdjustBundle(const RectifiedCamera& camera,
                                     const BundleAdjustmentOptions& options, Window& window) {
  return Problem(camera, options, window).Solve();
}

std::vector<std::uint64_t> RemoveOutliers(const RectifiedCamera& camera, const PixelSigmas& sigmas,
                                          double max_sigmas, Window& window) {
  std::vector<std::uint64_t> removed;
  for (auto it = window.landmarks.begin(); it != window.landmarks.end();) {
    Landmark& landmark = it->second;
    const Pose& host = window.keyframes[IndexOf(window, landmark.host)].T_WB;
    const auto outlying = [&](const Sighting& s) {
      const Pose& target = window.keyframes[IndexOf(window, s.keyframe)].T_WB;
      const auto r = Reproject(camera, host, target, landmark.coordinates, s.pixel, sigmas);
      return !r || r->residual.cwiseAbs().maxCoeff() > max_sigmas;
    };
    std::erase_if(landmark.sightings, outlying);
    // Without its own first sighting a landmark is no longer tied to its host.
    const bool gone =
        landmark.sightings.empty() || landmark.sightings.front().keyframe != landmark.host;
    if (gone) removed.push_back(it->first);
    it = gone ? window.landmarks.erase(it) : std::next(it);
  }
  return removed;
}

}  // namespace polnav::nav
