#include "tools/testbed/report/chart_data.h"

#include <algorithm>
#include <cmath>

#include "tools/testbed/disturbed_times.h"
#include "tools/testbed/report.h"
#include "tools/testbed/report/diagnostic_data.h"
#include "tools/testbed/score.h"
#include "tools/testbed/trajectory.h"

namespace polnav::testbed {
namespace {

constexpr std::size_t kMaxPoints = 2000;

// A chart needs no more digits than a screen has pixels; the file gets smaller. NaN becomes null.
Json Rounded(double value) {
  if (!std::isfinite(value)) return nullptr;
  return std::round(value * 1e5) / 1e5;
}

Json Picked(const std::vector<double>& values, const std::vector<std::size_t>& indices) {
  Json list = Json::array();
  for (const std::size_t i : indices) list.push_back(Rounded(values[i]));
  return list;
}

// Every n-th, and the last: for a path seen from above, which has no peaks to keep, and for clouds
// of points, which extremes alone would show hollow.
std::vector<std::size_t> EveryNth(std::size_t size) {
  const std::size_t stride = std::max<std::size_t>(1, (size + kMaxPoints - 2) / (kMaxPoints - 1));
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < size; i += stride) indices.push_back(i);
  if (size > 0 && indices.back() != size - 1) indices.push_back(size - 1);
  return indices;
}

Json PathData(const Trajectory& trajectory) {
  Json x = Json::array();
  Json y = Json::array();
  for (const std::size_t i : EveryNth(trajectory.size())) {
    x.push_back(Rounded(trajectory[i].T_WB.p.x()));
    y.push_back(Rounded(trajectory[i].T_WB.p.y()));
  }
  return {{"x", x}, {"y", y}};
}

Json EstimatorData(const EstimatorRun& run, const Trajectory& truth) {
  const ErrorSeries series = ComputeErrors(truth, run.estimates, run.heading_only);
  const std::vector<std::size_t> heading = Thin(series.heading_deg, kMaxPoints);
  const std::vector<std::size_t> position = Thin(series.position_m, kMaxPoints);
  Json sigma = Json::array();
  for (const std::size_t i : heading) {
    const std::optional<double>& s = series.heading_sigma_deg[i];
    sigma.push_back(s ? Rounded(*s) : Json(nullptr));
  }
  Json data;
  data["name"] = run.name;
  if (!run.heading_only) data["path"] = PathData(TrajectoryOf(run.estimates));
  data["heading"] = {{"t", Picked(series.t_s, heading)},
                     {"error", Picked(series.heading_deg, heading)},
                     {"sigma", sigma}};
  if (!run.heading_only) {
    data["position"] = {{"t", Picked(series.t_s, position)},
                        {"error", Picked(series.position_m, position)}};
  }
  data["nees"] = NeesData(series);
  data["inside"] = DiagnosticData(run.diagnostics);
  return data;
}

Json ReadingData(const std::vector<HeadingReading>& readings) {
  std::vector<double> t_s;
  std::vector<double> error_deg;
  for (const HeadingReading& reading : readings) {
    t_s.push_back(reading.t_s);
    error_deg.push_back(nav::RadToDeg(reading.error_rad));
  }
  const std::vector<std::size_t> indices = EveryNth(readings.size());
  return {{"t", Picked(t_s, indices)}, {"error", Picked(error_deg, indices)}};
}

Json MemoryData(const RunRecord& record) {
  const std::size_t n = record.rss_mb.size();
  const double step_s = n > 1 ? record.sim_duration_s / static_cast<double>(n - 1) : 0.0;
  std::vector<double> t_s(n);
  for (std::size_t i = 0; i < n; ++i) t_s[i] = static_cast<double>(i) * step_s;
  const std::vector<std::size_t> indices = Thin(record.rss_mb, kMaxPoints);
  return {{"t", Picked(t_s, indices)}, {"mb", Picked(record.rss_mb, indices)}};
}

// Amplitudes by frequency, thinned by their peaks; a micrometre a second squared is no line.
Json LineData(const std::vector<double>& amplitudes, double step_hz) {
  Json f = Json::array();
  Json v = Json::array();
  for (const std::size_t i : Thin(amplitudes, kMaxPoints)) {
    f.push_back(Rounded(static_cast<double>(i) * step_hz));
    v.push_back(std::round(amplitudes[i] * 1e6) / 1e6);
  }
  return {{"t", f}, {"v", v}};
}

// With the rate of the steps where the vehicle walks: two a cycle.
Json ForceData(const std::optional<ForceLines>& force, const sim::VehicleOptions& vehicle) {
  if (!force) return nullptr;
  Json data = {{"up", LineData(force->up_m_s2, force->step_hz)},
               {"ahead", LineData(force->ahead_m_s2, force->step_hz)},
               {"steps_hz", nullptr}};
  if (vehicle.hexapod) data["steps_hz"] = Rounded(2.0 / vehicle.hexapod->gait.cycle_s);
  return data;
}

Json StretchData(const std::vector<Stretch>& stretches) {
  Json list = Json::array();
  for (const Stretch& s : stretches) list.push_back({{"begin", s.begin_s}, {"end", s.end_s}});
  return list;
}

}  // namespace

std::vector<std::size_t> Thin(const std::vector<double>& values, std::size_t max_points) {
  std::vector<std::size_t> indices;
  if (values.size() <= max_points) {
    for (std::size_t i = 0; i < values.size(); ++i) indices.push_back(i);
    return indices;
  }
  // Two points a block, and the two ends.
  const std::size_t blocks = std::max<std::size_t>(1, (max_points - 2) / 2);
  indices.push_back(0);
  for (std::size_t b = 0; b < blocks; ++b) {
    const auto begin = values.begin() + static_cast<std::ptrdiff_t>(b * values.size() / blocks);
    const auto end = values.begin() + static_cast<std::ptrdiff_t>((b + 1) * values.size() / blocks);
    const auto [low, high] = std::minmax_element(begin, end);
    const auto [first, second] = std::minmax({low - values.begin(), high - values.begin()});
    for (const std::ptrdiff_t i : {first, second}) {
      if (static_cast<std::size_t>(i) > indices.back()) {
        indices.push_back(static_cast<std::size_t>(i));
      }
    }
  }
  if (indices.back() != values.size() - 1) indices.push_back(values.size() - 1);
  return indices;
}

Json ChartData(const RunRecord& record, const Scenario& scenario) {
  const Trajectory truth = TrajectoryOf(record.truth);
  Json data;
  data["end_s"] = record.sim_duration_s;
  data["truth"] = PathData(truth);
  data["estimators"] = Json::array();
  for (const EstimatorRun& run : record.estimators) {
    data["estimators"].push_back(EstimatorData(run, truth));
  }
  data["readings"] = ReadingData(record.polarization_readings);
  data["force"] = ForceData(record.force, scenario.vehicle);
  data["memory"] = MemoryData(record);
  data["faults"] = StretchData(FaultTimes(scenario.faults, record.sim_duration_s));
  data["disturbances"] = StretchData(record.disturbed);
  return data;
}

}  // namespace polnav::testbed
