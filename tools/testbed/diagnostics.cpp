#include "tools/testbed/diagnostics.h"

#include <cmath>

#include "tools/testbed/statistics.h"

namespace polnav::testbed {
namespace {

Json Spread(const std::vector<FrameDiagnostics>& frames, int FrameDiagnostics::*field) {
  std::vector<double> values;
  for (const FrameDiagnostics& frame : frames) values.push_back(frame.*field);
  const Statistics s = Summarize(values);
  return {{"median", s.median}, {"min", s.min}, {"max", s.max}};
}

Json VisionNis(const std::vector<FrameDiagnostics>& frames) {
  std::vector<double> values;
  for (const FrameDiagnostics& frame : frames) {
    if (frame.vision_nis) values.push_back(*frame.vision_nis);
  }
  if (values.empty()) return nullptr;
  return {{"median", Percentile(values, 50.0)}, {"p99", Percentile(values, 99.0)}};
}

Json SkyJson(const std::vector<nav::SkyResidual>& sky) {
  std::vector<double> used_deg;
  double nis = 0.0;
  for (const nav::SkyResidual& r : sky) {
    if (r.gated) continue;
    used_deg.push_back(nav::RadToDeg(r.residual_rad));
    nis += std::pow(r.residual_rad / r.sigma_rad, 2);
  }
  Json json = {{"readings", sky.size()}, {"gated", sky.size() - used_deg.size()}};
  if (used_deg.empty()) return json;
  const Statistics s = Summarize(used_deg);
  json["mean_deg"] = s.mean;
  json["rms_deg"] = s.rmse;
  json["nis"] = nis / static_cast<double>(used_deg.size());
  return json;
}

}  // namespace

void Diagnostics::Add(const nav::Report& report) {
  sky.insert(sky.end(), report.sky.begin(), report.sky.end());
  if (!report.estimate) return;
  frames.push_back({.t_s = nav::ToSeconds(report.estimate->stamp),
                    .features = report.features,
                    .inliers = report.inliers,
                    .flow_rejected = report.flow_rejected,
                    .pose_rejected = report.pose_rejected,
                    .map_rejected = report.map_rejected,
                    .window_keyframes = report.window_keyframes,
                    .window_landmarks = report.window_landmarks,
                    .vision_nis = report.vision_nis});
}

void Diagnostics::AddInnovations(const nav::Report& report) {
  for (const nav::Innovation& innovation : report.innovations) {
    InnovationCounts& counts = innovations[std::string(innovation.sensor)];
    counts.dof = innovation.dof;
    if (innovation.gated) {
      ++counts.gated;
      continue;
    }
    ++counts.count;
    counts.nis_sum += innovation.nis;
  }
}

Json NisJson(const Diagnostics& diagnostics) {
  Json json = nullptr;
  for (const auto& [sensor, counts] : diagnostics.innovations) {
    const double mean = counts.count > 0 ? counts.nis_sum / static_cast<double>(counts.count) : 0.0;
    json[sensor] = {
        {"mean", mean}, {"dof", counts.dof}, {"count", counts.count}, {"gated", counts.gated}};
  }
  return json;
}

Json ToJson(const Diagnostics& diagnostics) {
  const std::vector<FrameDiagnostics>& frames = diagnostics.frames;
  if (frames.empty()) return nullptr;
  Json json = {{"frames", frames.size()},
               {"features", Spread(frames, &FrameDiagnostics::features)},
               {"inliers", Spread(frames, &FrameDiagnostics::inliers)},
               {"window_keyframes", Spread(frames, &FrameDiagnostics::window_keyframes)},
               {"window_landmarks", Spread(frames, &FrameDiagnostics::window_landmarks)},
               {"vision_nis", VisionNis(frames)}};
  if (!diagnostics.sky.empty()) json["sky"] = SkyJson(diagnostics.sky);
  return json;
}

}  // namespace polnav::testbed
