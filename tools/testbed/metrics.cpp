#include "tools/testbed/metrics.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>
#include <string_view>

#include "tools/testbed/estimators.h"
#include "tools/testbed/yaml_document.h"

namespace polnav::testbed {
namespace {

constexpr std::array<std::string_view, 4> kRunMetrics{"sim_duration_s", "wall_s",
                                                      "real_time_factor", "peak_rss_mb"};

std::vector<std::string> Split(const std::string& path) {
  std::vector<std::string> parts;
  std::stringstream stream(path);
  for (std::string part; std::getline(stream, part, '.');) parts.push_back(part);
  return parts;
}

Json ToJson(const std::optional<RpeScore>& rpe) {
  if (!rpe) return nullptr;
  return {{"trans_m", ToJson(rpe->trans_m)}, {"rot_deg", ToJson(rpe->rot_deg)}};
}

Json OrNull(const std::optional<double>& value) { return value ? Json(*value) : Json(nullptr); }

// unit: suffix of what has one.
Json TriadJson(const TriadBiasScore& triad, const std::string& unit) {
  return {{"last_" + unit, triad.last},
          {"last_sigma_" + unit, triad.last_sigma},
          {"within_3_sigma", triad.within_3_sigma},
          {"nees_last", OrNull(triad.nees_last)},
          {"nees", OrNull(triad.nees)}};
}

// Leaves out what is null.
void Flatten(const Json& tree, const std::string& path, std::vector<std::string>& paths) {
  if (tree.is_null()) return;
  if (!tree.is_object()) {
    paths.push_back(path);
    return;
  }
  for (const auto& [key, item] : tree.items()) Flatten(item, JoinKey(path, key), paths);
}

}  // namespace

Json ToJson(const Statistics& s) {
  return {{"rmse", s.rmse}, {"mean", s.mean}, {"median", s.median}, {"std", s.std},
          {"min", s.min},   {"max", s.max},   {"sse", s.sse},       {"count", s.count}};
}

Json ToJson(const HeadingScore& h) {
  return {{"mean_abs", h.mean_abs}, {"mean", h.mean}, {"rmse", h.rmse},
          {"std", h.std},           {"max", h.max},   {"last", h.last}};
}

Json ToJson(const EstimatorScore& score) {
  Json json;
  json["ate_m"] = score.ate_m ? ToJson(*score.ate_m) : Json(nullptr);
  json["rpe_1m"] = ToJson(score.rpe_1m);
  json["rpe_20m"] = ToJson(score.rpe_20m);
  json["rpe_100m"] = ToJson(score.rpe_100m);
  json["heading_deg"] = ToJson(score.heading_deg);
  json["position_m"] = nullptr;
  if (score.position_m) {
    json["position_m"] = ToJson(score.position_m->error);
    json["position_m"]["horizontal_rmse"] = score.position_m->horizontal_rmse;
    json["position_m"]["last"] = score.position_m->last;
  }
  json["drift_percent"] = score.drift_percent ? Json(*score.drift_percent) : Json(nullptr);
  json["nees"] = nullptr;
  if (score.nees) {
    json["nees"] = {
        {"position", score.nees->position ? Json(*score.nees->position) : Json(nullptr)},
        {"heading", score.nees->heading},
        {"heading_within_3_sigma", score.nees->heading_within_3_sigma}};
  }
  if (score.recovery) {
    const Recovery& r = *score.recovery;
    json["recovery"] = {{"heading_s", OrNull(r.heading_s)},
                        {"tracking_s", r.tracking_s},
                        {"disturbances", r.disturbances}};
  }
  json["tracked_fraction"] = score.tracked_fraction;
  return json;
}

Json ToJson(const BiasScore& score) {
  return {{"gyro", TriadJson(score.gyro_deg_s, "deg_s")},
          {"accel", TriadJson(score.accel_mg, "mg")}};
}

std::vector<std::string> EstimatorMetrics(bool heading_only, bool biases) {
  EstimatorScore full;
  full.nees.emplace();
  full.recovery = Recovery{.heading_s = 0.0};
  if (!heading_only) {
    full.ate_m.emplace();
    full.rpe_1m.emplace();
    full.rpe_20m.emplace();
    full.rpe_100m.emplace();
    full.position_m.emplace();
    full.drift_percent.emplace();
    full.nees->position = 0.0;
  }
  std::vector<std::string> paths;
  Flatten(ToJson(full), "", paths);
  if (biases && !heading_only) {
    const TriadBiasScore triad{.nees_last = 0.0, .nees = 0.0};
    Flatten(ToJson(BiasScore{triad, triad}), "biases", paths);
  }
  return paths;
}

std::vector<std::string> AllMetrics() {
  std::vector<std::string> paths(kRunMetrics.begin(), kRunMetrics.end());
  for (const EstimatorInfo& info : kEstimators) {
    for (const std::string& metric : EstimatorMetrics(info.heading_only, info.estimates_biases)) {
      paths.push_back("estimators." + std::string(info.name) + "." + metric);
    }
  }
  return paths;
}

bool IsMetric(const std::string& path) {
  const std::vector<std::string> parts = Split(path);
  if (parts.size() == 3 && parts[0] == "streams") return parts[2] == "count";
  if (parts.size() == 3 && parts[0] == "timing_ms") {
    return parts[2] == "median" || parts[2] == "p99";
  }
  // By sensor: which ones an estimator judges is known only when it has run.
  if (parts.size() == 5 && parts[0] == "estimators" && parts[2] == "nis") {
    return FindInfo(parts[1]) != nullptr &&
           (parts[4] == "mean" || parts[4] == "count" || parts[4] == "gated");
  }
  static const std::vector<std::string> all = [] {
    std::vector<std::string> metrics = AllMetrics();
    std::sort(metrics.begin(), metrics.end());
    return metrics;
  }();
  return std::binary_search(all.begin(), all.end(), path);
}

std::string EstimatorOfMetric(const std::string& path) {
  const std::vector<std::string> parts = Split(path);
  return parts.size() > 1 && parts[0] == "estimators" ? parts[1] : "";
}

std::optional<double> MetricAt(const Json& result, const std::string& path) {
  const Json* node = &result;
  for (const std::string& part : Split(path)) {
    if (!node->is_object() || !node->contains(part)) return std::nullopt;
    node = &(*node)[part];
  }
  if (!node->is_number()) return std::nullopt;
  const double value = node->get<double>();
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

}  // namespace polnav::testbed
