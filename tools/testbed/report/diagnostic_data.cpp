#include "tools/testbed/report/diagnostic_data.h"

#include <cmath>
#include <functional>
#include <limits>

#include "tools/testbed/report.h"

namespace polnav::testbed {
namespace {

constexpr std::size_t kMaxPoints = 1000;  // of each of many lines

// Three digits: as many as a chart shows.
Json Short(double value) {
  if (value == 0.0) return 0;
  const double step = std::pow(10.0, std::floor(std::log10(std::abs(value))) - 2.0);
  const double rounded = std::round(value / step) * step;
  return std::stod(std::to_string(rounded));  // without the rounding's tail of digits
}

// Leaves out what is no number.
Json Line(std::vector<double> t_s, std::vector<double> values) {
  std::size_t kept = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isfinite(values[i])) continue;
    t_s[kept] = t_s[i];
    values[kept++] = values[i];
  }
  values.resize(kept);
  Json t = Json::array();
  Json v = Json::array();
  for (const std::size_t i : Thin(values, kMaxPoints)) {
    t.push_back(std::round(t_s[i] * 100.0) / 100.0);
    v.push_back(Short(values[i]));
  }
  return {{"t", t}, {"v", v}};
}

Json Line(const std::vector<FrameDiagnostics>& frames,
          const std::function<double(const FrameDiagnostics&)>& value) {
  std::vector<double> t_s;
  std::vector<double> values;
  for (const FrameDiagnostics& frame : frames) {
    t_s.push_back(frame.t_s);
    values.push_back(value(frame));
  }
  return Line(t_s, values);
}

// Extremes alone would show a cloud hollow.
Json SkyData(const std::vector<nav::SkyResidual>& sky) {
  Json used = {{"t", Json::array()}, {"v", Json::array()}};
  Json gated = used;
  Json sigma = used;
  const std::size_t stride = sky.size() / (2 * kMaxPoints) + 1;
  for (std::size_t i = 0; i < sky.size(); ++i) {
    const nav::SkyResidual& r = sky[i];
    if (i % stride != 0 && !r.gated) continue;
    const double t_s = std::round(nav::ToSeconds(r.stamp) * 100.0) / 100.0;
    Json& list = r.gated ? gated : used;
    list["t"].push_back(t_s);
    list["v"].push_back(Short(nav::RadToDeg(r.residual_rad)));
    if (i % (2 * stride) != 0) continue;
    sigma["t"].push_back(t_s);
    sigma["v"].push_back(Short(nav::RadToDeg(r.sigma_rad)));
  }
  return {{"used", used}, {"gated", gated}, {"sigma", sigma}};
}

}  // namespace

Json DiagnosticData(const Diagnostics& diagnostics) {
  const std::vector<FrameDiagnostics>& frames = diagnostics.frames;
  if (frames.empty()) return nullptr;
  using Frame = FrameDiagnostics;
  Json data = {
      {"offered", Line(frames, [](const Frame& f) { return f.features; })},
      {"inliers", Line(frames, [](const Frame& f) { return f.inliers; })},
      {"flow", Line(frames, [](const Frame& f) { return f.flow_rejected; })},
      {"pose", Line(frames, [](const Frame& f) { return f.pose_rejected; })},
      {"map", Line(frames, [](const Frame& f) { return f.map_rejected; })},
      {"keyframes", Line(frames, [](const Frame& f) { return f.window_keyframes; })},
      {"landmarks", Line(frames, [](const Frame& f) { return f.window_landmarks; })},
      {"nis", Line(frames,
                   [](const Frame& f) {
                     return f.vision_nis.value_or(std::numeric_limits<double>::quiet_NaN());
                   })},
  };
  if (!diagnostics.sky.empty()) data["sky"] = SkyData(diagnostics.sky);
  return data;
}

Json NeesData(const ErrorSeries& series) {
  std::vector<double> heading;
  for (std::size_t i = 0; i < series.t_s.size(); ++i) {
    const std::optional<double>& sigma = series.heading_sigma_deg[i];
    heading.push_back(sigma ? std::pow(series.heading_deg[i] / *sigma, 2)
                            : std::numeric_limits<double>::quiet_NaN());
  }
  Json data = {{"heading", Line(series.t_s, heading)}};
  // One entry a pair unless some covariance was not positive definite.
  if (!series.position_nees.empty() && series.position_nees.size() == series.t_s.size()) {
    data["position"] = Line(series.t_s, series.position_nees);
  }
  return data;
}

}  // namespace polnav::testbed
