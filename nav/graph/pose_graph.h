// Where were all keyframes, given everything that is known about them at once?
//
// The whole drive as poses and what ties them: steps of visual odometry, returns to known places,
// headings from the sky and the accelerometer's level. Unlike the window it forgets nothing, so a
// place seen again corrects the lap before as well, and years of sky average.
//
// Odometry errs in two ways: at random, growing with the square root of the way, and steadily
// (calibration, bias of the tracker), growing with the way. The steady part is a twist per metre in
// B that all steps share; it is estimated along with the poses once returns or the sky show it.
//
// Fails when a false return passes the robust weight, and where steady errors change on the way.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "nav/api/estimate.h"
#include "nav/graph/window.h"

namespace polnav::nav {

using Vector6d = Eigen::Matrix<double, 6, 1>;

struct PoseGraphOptions {
  // Random part of odometry over one metre, one sigma; grows with the square root of the way.
  // Measured on drives of 5 to 20 m, as are the steady ones on laps.
  double step_position_sigma_m = 0.02;
  double step_angle_sigma_deg = 0.02;
  // Steady part: translation per metre of way [-] and rotation per metre of way.
  double drift_position_sigma = 0.005;
  double drift_angle_sigma_deg = 0.002;
  double return_huber_sigmas = 3.0;  // a return that departs by more counts for less
  int max_iterations = 4;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("step_position_sigma_m", step_position_sigma_m, {.min = 1e-4, .max = 10.0});
    v("step_angle_sigma_deg", step_angle_sigma_deg, {.min = 1e-4, .max = 10.0});
    v("drift_position_sigma", drift_position_sigma, {.min = 1e-6, .max = 1.0});
    v("drift_angle_sigma_deg", drift_angle_sigma_deg, {.min = 1e-6, .max = 10.0});
    v("return_huber_sigmas", return_huber_sigmas, {.min = 0.1, .max = 100.0});
    v("max_iterations", max_iterations, {.min = 1, .max = 100});
  }
};

struct GraphNode {
  std::uint64_t keyframe = 0;  // Keyframe::id
  TimeNs stamp = 0;
  Pose T_WB;
  std::optional<HeadingEdge> heading;
  std::optional<LevelEdge> level;
};

// T_ft of node `to` as seen from node `from`, and one sigma of its random error.
struct RelativeEdge {
  std::size_t from = 0;
  std::size_t to = 0;
  Pose T_ft;
  double position_sigma_m = 0.0;
  double angle_sigma_rad = 0.0;
  double length_m = 0.0;  // of way; scales the steady error. Zero for returns.
};

struct PoseGraph {
  Prior start;  // on the first node
  std::vector<GraphNode> nodes;
  std::vector<RelativeEdge> steps;
  std::vector<RelativeEdge> returns;
  Vector6d drift = Vector6d::Zero();  // (translation [m], rotation [rad]) per metre, in B
};

// Residual in sigmas with exact Jacobians; those of the poses by (dp, dtheta) in W.
struct RelativeResidual {
  Vector6d residual;
  Matrix6d by_from;
  Matrix6d by_to;
  Matrix6d by_drift;
};

[[nodiscard]] RelativeResidual EvaluateRelative(const RelativeEdge& edge, const Pose& T_Wf,
                                                const Pose& T_Wt, const Vector6d& drift);

struct PoseGraphSummary {
  bool usable = false;  // false: the graph is as it was
  int iterations = 0;
  double initial_cost = 0.0;
  double final_cost = 0.0;
  Matrix6d newest_covariance = Matrix6d::Zero();  // of the last node's (dp, dtheta) in W
};

// Gauss-Newton over all nodes and the steady drift, by sparse Cholesky.
[[nodiscard]] PoseGraphSummary OptimizePoseGraph(const PoseGraphOptions& options, PoseGraph& graph);

}  // namespace polnav::nav
