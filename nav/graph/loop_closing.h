// How far has odometry run off, now that places are seen again?
//
// Keeps every keyframe in a pose graph with the returns, the sky's headings and the level in it,
// and answers in W what odometry knows in O, the frame of its own that the window has drifted to.
// The window is left alone: without loop closing nothing in it is different.
#pragma once

#include "nav/api/estimate.h"
#include "nav/graph/place_memory.h"
#include "nav/graph/pose_graph.h"
#include "nav/graph/window.h"

namespace polnav::nav {

struct LoopOptions {
  double optimize_every_m = 10.0;  // of way, sooner at the start; shorter: slower
  PoseGraphOptions graph;
  PlaceOptions places;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("optimize_every_m", optimize_every_m, {.min = 0.0, .max = 1000.0});
    v("graph", graph);
    v("places", places);
  }
};

class LoopCloser {
 public:
  // start: on the first keyframe.
  LoopCloser(const LoopOptions& options, const Prior& start);

  // The window's newest keyframe, just adjusted, how sure the window is of it, and what it sees.
  // Every keyframe must come. Tells `report` of a return, and of an optimization that failed.
  void Add(const RectifiedCamera& camera, const Window& window, const Matrix6d& covariance,
           const StereoFeatures& features, const PoseSolverOptions& solver, Report& report);

  [[nodiscard]] Pose InWorld(const Pose& T_OB) const { return T_WO_ * T_OB; }

  // Of the newest keyframe's (dp, dtheta) in W.
  [[nodiscard]] const Matrix6d& covariance() const { return covariance_; }

  [[nodiscard]] const PoseGraph& graph() const { return graph_; }

 private:
  void AddNode(const Keyframe& keyframe, const SkyErrors& errors);
  void LevelNewest(const Keyframe& keyframe, const Matrix6d& covariance);
  void RefreshSteps(const Window& window);
  void Optimize(Report& report);

  LoopOptions options_;
  PoseGraph graph_;
  PlaceMemory places_;
  Pose newest_T_OB_;  // of the last node
  Pose T_WO_;
  Matrix6d covariance_ = Matrix6d::Zero();
  double way_m_ = 0.0;
  double optimized_m_ = 0.0;  // way at the last optimization
};

}  // namespace polnav::nav
