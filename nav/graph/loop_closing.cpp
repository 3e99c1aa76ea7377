#include "nav/graph/loop_closing.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <stdexcept>

#include "nav/graph/edges.h"

namespace polnav::nav {
namespace {

// What a step that hardly moves may err by all the same.
constexpr double kLeastWay_m = 0.1;

// Sigmas of a step that vision followed.
RelativeEdge FollowedStep(const PoseGraphOptions& options, const Pose& T_ft) {
  const double way = T_ft.p.norm();
  const double root = std::sqrt(std::max(way, kLeastWay_m));
  return {.T_ft = T_ft,
          .position_sigma_m = options.step_position_sigma_m * root,
          .angle_sigma_rad = DegToRad(options.step_angle_sigma_deg) * root,
          .length_m = way};
}

RelativeEdge CoastedStep(const Pose& T_ft, const CoastSigmas& sigmas) {
  return {.T_ft = T_ft, .position_sigma_m = sigmas.position_m, .angle_sigma_rad = sigmas.angle_rad};
}

// The level that the IMU keeps errs slowly, with its bias: keyframes close together share most of
// the error, and each counts for its share of this time.
constexpr double kLevelTime_s = 30.0;

LevelEdge LevelOf(const Keyframe& keyframe, const Matrix6d& covariance, double since_s) {
  const double share = std::max(1.0, kLevelTime_s / std::max(since_s, 1e-3));
  return {.up_B = keyframe.T_WB.q.conjugate() * Eigen::Vector3d::UnitZ(),
          .sigma_rad = std::sqrt(share * covariance.diagonal().segment<2>(3).maxCoeff())};
}

Pose StepCorrected(const RelativeEdge& step, const Vector6d& drift) {
  return {ExpRotation(-step.length_m * drift.tail<3>()) * step.T_ft.q,
          step.T_ft.p - step.length_m * drift.head<3>()};
}

}  // namespace

LoopCloser::LoopCloser(const LoopOptions& options, const Prior& start)
    : options_(options), graph_{.start = start}, places_(options.places) {}

void LoopCloser::Add(const RectifiedCamera& camera, const Window& window,
                     const Matrix6d& covariance, const StereoFeatures& features,
                     const PoseSolverOptions& solver, Report& report) {
  RefreshSteps(window);
  AddNode(window.keyframes.back(), window.errors);
  if (window.inertial) LevelNewest(window.keyframes.back(), covariance);
  if (const auto seen = places_.Recognize(camera, graph_.nodes, features, solver)) {
    graph_.returns.push_back(*seen);
    report.returns = 1;
  }
  // The first metres matter most, and cost least.
  if (way_m_ - optimized_m_ >= std::min(options_.optimize_every_m, 0.1 * way_m_)) {
    Optimize(report);
  }
  T_WO_ = graph_.nodes.back().T_WB * newest_T_OB_.Inverse();
  places_.Remember(camera, graph_.nodes, features);
}

void LoopCloser::AddNode(const Keyframe& keyframe, const SkyErrors& errors) {
  if (keyframe.id != graph_.nodes.size()) {
    throw std::logic_error("LoopCloser: a keyframe is missing");
  }
  graph_.nodes.emplace_back();
  GraphNode& node = graph_.nodes.back();
  node.keyframe = keyframe.id;
  node.stamp = keyframe.stamp;
  node.T_WB = keyframe.T_WB;
  node.heading = keyframe.heading;
  if (node.heading) node.heading->heading_rad -= node.heading->by_errors.dot(errors);
  const std::size_t at = graph_.nodes.size() - 1;
  if (at > 0) {
    const Pose T_ft = newest_T_OB_.Inverse() * keyframe.T_WB;
    RelativeEdge step = keyframe.coasted ? CoastedStep(T_ft, *keyframe.coasted)
                                         : FollowedStep(options_.graph, T_ft);
    step.from = at - 1;
    step.to = at;
    node.T_WB = graph_.nodes[at - 1].T_WB * StepCorrected(step, graph_.drift);
    way_m_ += T_ft.p.norm();
    covariance_.diagonal().head<3>().array() += step.position_sigma_m * step.position_sigma_m;
    covariance_.diagonal().tail<3>().array() += step.angle_sigma_rad * step.angle_sigma_rad;
    graph_.steps.push_back(step);
  }
  newest_T_OB_ = keyframe.T_WB;
}

void LoopCloser::LevelNewest(const Keyframe& keyframe, const Matrix6d& covariance) {
  const std::size_t nodes = graph_.nodes.size();
  const double since_s =
      nodes < 2 ? kLevelTime_s : ToSeconds(keyframe.stamp - graph_.nodes[nodes - 2].stamp);
  graph_.nodes.back().level = LevelOf(keyframe, covariance, since_s);
}

// Adjusted again, the window knows its steps better than when they were made.
void LoopCloser::RefreshSteps(const Window& window) {
  for (std::size_t i = 1; i + 1 < window.keyframes.size(); ++i) {
    const Keyframe& from = window.keyframes[i - 1];
    const Keyframe& to = window.keyframes[i];
    graph_.steps[to.id - 1].T_ft = from.T_WB.Inverse() * to.T_WB;
  }
  if (window.keyframes.size() > 1) newest_T_OB_ = std::prev(window.keyframes.end(), 2)->T_WB;
}

void LoopCloser::Optimize(Report& report) {
  const PoseGraphSummary summary = OptimizePoseGraph(options_.graph, graph_);
  if (!summary.usable) {  // tried again with the next keyframe
    ++report.failed_solves;
    return;
  }
  covariance_ = summary.newest_covariance;
  optimized_m_ = way_m_;
}

}  // namespace polnav::nav
