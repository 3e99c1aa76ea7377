#include "nav/graph/bundle_adjustment.h"

#include <Eigen/Cholesky>
#include <algorithm>

#include "nav/graph/edges.h"
#include "nav/graph/normal_equations.h"

namespace polnav::nav {
namespace {

// Levenberg-Marquardt. The window is nearly linear about the last solution: no damping until a step
// fails. It would hold on to old values: keyframes' velocities are tied to each other by the IMU a
// million times more firmly than their common value is known.
constexpr double kFirstDamping = 1e-8;
constexpr double kDampingFactor = 10.0;
constexpr double kMostDamping = 1e2;
// A smaller relative gain of cost is no gain.
constexpr double kLeastGain = 1e-4;

void Step(const NormalEquations& equations, const Eigen::VectorXd& step, double damping,
          Window& window) {
  const WindowLayout& layout = equations.layout();
  for (std::size_t i = 0; i < window.keyframes.size(); ++i) {
    Keyframe& keyframe = window.keyframes[i];
    keyframe.T_WB = Perturb(keyframe.T_WB, step.segment<6>(layout.Pose(i)));
    if (!layout.inertial) continue;
    const auto at = layout.Motion(i);
    keyframe.motion.v_WI += step.segment<3>(at);
    keyframe.motion.gyro_bias += step.segment<3>(at + 3);
    keyframe.motion.accel_bias += step.segment<3>(at + 6);
  }
  window.errors += step.segment<kSkyErrors>(layout.Errors());
  const auto landmark_steps = equations.LandmarkSteps(step, damping);
  auto next = landmark_steps.begin();
  for (auto& [id, landmark] : window.landmarks) landmark.coordinates += *next++;
}

// The values of the unknowns, to return to.
class Values {
 public:
  explicit Values(const Window& window) : errors_(window.errors) {
    for (const Keyframe& k : window.keyframes) states_.emplace_back(k.T_WB, k.motion);
    for (const auto& [id, landmark] : window.landmarks) {
      coordinates_.push_back(landmark.coordinates);
    }
  }
  void Restore(Window& window) const {
    for (std::size_t i = 0; i < states_.size(); ++i) {
      window.keyframes[i].T_WB = states_[i].first;
      window.keyframes[i].motion = states_[i].second;
    }
    window.errors = errors_;
    auto next = coordinates_.begin();
    for (auto& [id, landmark] : window.landmarks) landmark.coordinates = *next++;
  }

 private:
  SkyErrors errors_;
  std::vector<std::pair<Pose, Motion>> states_;
  std::vector<Eigen::Vector3d> coordinates_;
};

}  // namespace

BundleAdjustmentSummary AdjustBundle(const RectifiedCamera& camera,
                                     const BundleAdjustmentOptions& options, Window& window) {
  BundleAdjustmentSummary summary{.equations = LinearizeWindow(camera, options, window)};
  NormalEquations& equations = summary.equations;
  summary.initial_cost = summary.final_cost = equations.cost();
  double damping = 0.0;
  while (summary.iterations < options.max_iterations && damping <= kMostDamping) {
    ++summary.iterations;
    const NormalEquations::Reduced reduced = equations.Reduce(damping);
    const Eigen::LLT<Eigen::MatrixXd> solver(reduced.H);
    const Eigen::VectorXd step = -solver.solve(reduced.g);
    if (solver.info() != Eigen::Success || !step.allFinite()) {
      damping = std::max(kFirstDamping, damping * kDampingFactor);
      continue;
    }
    summary.usable = true;
    const double promised = reduced.landmarks_gain - 0.5 * reduced.g.dot(step);
    if (promised <= kLeastGain * equations.cost()) {  // not worth a look at what it brings
      Step(equations, step, damping, window);
      break;
    }
    const Values before(window);
    Step(equations, step, damping, window);
    NormalEquations next = LinearizeWindow(camera, options, window);
    const double gain = equations.cost() - next.cost();
    if (!(gain >= 0.0)) {
      before.Restore(window);
      if (-gain <= kLeastGain * equations.cost()) break;  // at the bottom, but for rounding
      damping = std::max(kFirstDamping, damping * kDampingFactor);
      continue;
    }
    const bool done = gain <= kLeastGain * equations.cost();
    equations = std::move(next);
    summary.final_cost = equations.cost();
    damping = 0.0;
    if (done) break;
  }
  return summary;
}

std::vector<std::uint64_t> RemoveOutliers(const RectifiedCamera& camera, const PixelSigmas& sigmas,
                                          double max_sigmas, Window& window) {
  const std::vector<Viewpoint> viewpoints = ViewpointsOf(camera, window);
  std::vector<std::uint64_t> removed;
  for (auto it = window.landmarks.begin(); it != window.landmarks.end();) {
    Landmark& landmark = it->second;
    const Viewpoint& host = viewpoints[IndexOf(window, landmark.host)];
    const auto outlying = [&](const Sighting& s) {
      const Viewpoint& target = viewpoints[IndexOf(window, s.keyframe)];
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
