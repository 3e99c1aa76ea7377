// How did an estimator fare inside, frame by frame?
//
// Counts, window and consistency of what it believed of its own residuals; no truth enters. Wall
// times are not here: they are in RunRecord::timing.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "nav/api/estimate.h"
#include "tools/testbed/option_tree.h"

namespace polnav::testbed {

// As nav::Report has them.
struct FrameDiagnostics {
  double t_s = 0.0;
  int features = 0;
  int inliers = 0;
  int flow_rejected = 0;
  int pose_rejected = 0;
  int map_rejected = 0;
  int window_keyframes = 0;
  int window_landmarks = 0;
  std::optional<double> vision_nis;
};

// Of one sensor's updates of a filter.
struct InnovationCounts {
  double nis_sum = 0.0;  // of those that were not gated
  int dof = 0;
  std::size_t count = 0;  // not gated
  std::size_t gated = 0;
};

struct Diagnostics {
  std::vector<FrameDiagnostics> frames;  // that were answered
  std::vector<nav::SkyResidual> sky;

  std::map<std::string, InnovationCounts> innovations;  // by sensor

  // Of a frame.
  void Add(const nav::Report& report);
  // Of any measurement.
  void AddInnovations(const nav::Report& report);
};

// estimators.<name>.nis of result.json: {sensor: {mean, dof, count, gated}}; mean is dof where the
// filter is consistent, a little less since the gate takes away the tail. Null without updates.
[[nodiscard]] Json NisJson(const Diagnostics& diagnostics);

// estimators.<name>.diagnostics of result.json. Null without frames. NIS of the sky: mean squared
// residual over sigma, of what was not gated; 1 when the sigmas are honest.
[[nodiscard]] Json ToJson(const Diagnostics& diagnostics);

}  // namespace polnav::testbed
