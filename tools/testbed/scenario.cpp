#include "tools/testbed/scenario.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <stdexcept>

#include "sim/sensors/lens_warp.h"
#include "sky/mosaic.h"
#include "tools/testbed/disturbance_checks.h"
#include "tools/testbed/estimators.h"
#include "tools/testbed/fault_checks.h"
#include "tools/testbed/flow_checks.h"
#include "tools/testbed/level_checks.h"
#include "tools/testbed/metrics.h"
#include "tools/testbed/option_loader.h"
#include "tools/testbed/option_tree.h"
#include "tools/testbed/world_check.h"
#include "tools/testbed/yaml_document.h"

namespace polnav::testbed {
namespace {

void CheckBasics(const YamlDocument& document, const Scenario& scenario) {
  if (scenario.name.empty()) FailAt(document, "name", "a scenario needs a name");
  const double ms = scenario.duration_s * 1000.0;
  // Decimal milliseconds are not exact in binary; anything a person means is far from 1e-6 ms.
  if (std::abs(ms - std::round(ms)) > 1e-6) {
    FailAt(document, "duration_s",
           fmt::format("{} s is not a whole number of milliseconds", scenario.duration_s));
  }
}

void CheckRates(const YamlDocument& document, const sim::SensorOptions& sensors) {
  const auto check = [&](const char* sensor, const auto& options) {
    if (!options || sim::IsSampleRate(options->rate_hz)) return;
    FailAt(document, fmt::format("sensors.{}.rate_hz", sensor),
           fmt::format("{} Hz does not fit whole steps of the simulation", options->rate_hz));
  };
  check("stereo", sensors.stereo);
  check("imu", sensors.imu);
  check("polarimeter", sensors.polarimeter);
  check("polarization_camera", sensors.polarization_camera);
  check("reference", sensors.reference);
  check("optical_flow", sensors.optical_flow);
}

void CheckStereo(const YamlDocument& document,
                 const std::optional<sim::StereoCameraOptions>& stereo) {
  if (!stereo) return;
  const double field_rad = sim::AngleOfField(sim::NominalStereo(*stereo).left);
  if (std::isnan(field_rad)) {
    FailAt(document, "sensors.stereo.model",
           fmt::format("with this distortion the {} lens folds back before the picture's corners",
                       stereo->model));
  }
  if (field_rad > sim::kWidestAngle_rad) {
    FailAt(document, "sensors.stereo.focal_px",
           fmt::format("the picture's corners are {:.1f} degrees from the axis; at most {:.0f} can "
                       "be rendered: a longer focal length or fewer pixels",
                       nav::RadToDeg(field_rad), nav::RadToDeg(sim::kWidestAngle_rad)));
  }
  if (stereo->exposure_time_s + stereo->rolling_shutter_s > 1.0 / stereo->rate_hz) {
    FailAt(document, "sensors.stereo.exposure_time_s",
           "exposure and readout take longer than the time between two pictures");
  }
}

void CheckVehicle(const YamlDocument& document, const sim::VehicleOptions& vehicle) {
  if (sim::CountOf(vehicle) > 1) {
    FailAt(document, "vehicle", "'car', 'turntable' and 'hexapod' exclude each other");
  }
  if (!vehicle.hexapod) return;
  const sim::WalkOptions& walk = vehicle.hexapod->walk;
  const double turn_rate_rad_s = nav::DegToRad(walk.turn_rate_deg_s);
  if (!sim::IsWithinReach(*vehicle.hexapod, 0.0, 0.0)) {
    FailAt(document, "vehicle.hexapod.gait.reach_m",
           "standing so wide at this body height is out of reach of the legs' joints");
  }
  if (!sim::IsWithinReach(*vehicle.hexapod, walk.speed_m_s, turn_rate_rad_s)) {
    FailAt(document, "vehicle.hexapod.walk.speed_m_s",
           fmt::format("the joints cannot reach where the feet must go at {} m/s, {} deg/s and "
                       "{} s a cycle: slower, shorter cycles or longer legs",
                       walk.speed_m_s, walk.turn_rate_deg_s, vehicle.hexapod->gait.cycle_s));
  }
}

void CheckPolarizationCamera(const YamlDocument& document,
                             const std::optional<sim::PolarizationCameraOptions>& camera) {
  if (!camera) return;
  const std::string key = "sensors.polarization_camera";
  if (camera->width_px % 2 != 0) FailAt(document, key + ".width_px", "a mosaic's width is even");
  if (camera->height_px % 2 != 0) FailAt(document, key + ".height_px", "a mosaic's height is even");
  try {
    (void)sky::ParseLayout(camera->layout);
  } catch (const std::invalid_argument& error) {
    FailAt(document, key + ".layout", error.what());
  }
}

void CheckOutages(const YamlDocument& document, const Scenario& scenario) {
  if (!scenario.sensors.reference) return;
  double free_from_s = 0.0;
  const auto& outages = scenario.sensors.reference->outages;
  for (std::size_t i = 0; i < outages.size(); ++i) {
    const std::string key = fmt::format("sensors.reference.outages.{}.start_s", i);
    // --duration cuts a run short on purpose: what would have come later does not come.
    const bool cut = document.overrides.contains("duration_s");
    if (outages[i].start_s >= scenario.duration_s && !cut) {
      FailAt(document, key,
             fmt::format("{} s is not before the run's end, {} s", outages[i].start_s,
                         scenario.duration_s));
    }
    if (outages[i].start_s < free_from_s) {
      FailAt(document, key,
             fmt::format("{} s is before the end of the outage above, {} s: list them in order, "
                         "without overlap",
                         outages[i].start_s, free_from_s));
    }
    free_from_s = outages[i].start_s + outages[i].duration_s;
  }
}

const EstimatorInfo& FindEstimator(const YamlDocument& document, const std::string& key,
                                   const std::string& name) {
  if (const EstimatorInfo* const info = FindInfo(name)) return *info;
  std::vector<std::string> names;
  for (const EstimatorInfo& known : kEstimators) names.emplace_back(known.name);
  const std::string nearest = NearestWord(name, names);
  FailAt(document, key,
         fmt::format("'{}' is not one of: {}{}", name, fmt::join(names, ", "),
                     nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest)));
}

void CheckSensors(const YamlDocument& document, const EstimatorInfo& info,
                  const sim::SensorOptions& sensors) {
  struct Need {
    bool missing;
    const char* what;
    const char* key;
  };
  for (const auto& [missing, what, key] : {
           Need{info.needs_stereo && !sensors.stereo, "cameras", "stereo"},
           Need{info.needs_polarimeter && !sensors.polarimeter, "a polarimeter", "polarimeter"},
           Need{info.needs_imu && !sensors.imu, "an IMU", "imu"},
           Need{info.needs_optical_flow && !sensors.optical_flow, "optical flow", "optical_flow"},
           Need{info.needs_polarization_camera && !sensors.polarization_camera, "a sky camera",
                "polarization_camera"},
       }) {
    if (!missing) continue;
    FailAt(document, "estimators.run",
           fmt::format("'{}' needs {}, but sensors.{} is off", info.name, what, key));
  }
}

void CheckEstimators(const YamlDocument& document, const Scenario& scenario) {
  std::set<std::string> seen;
  for (const std::string& name : scenario.estimators.run) {
    const EstimatorInfo& info = FindEstimator(document, "estimators.run", name);
    if (!seen.insert(name).second) {
      FailAt(document, "estimators.run", fmt::format("'{}' is listed twice", name));
    }
    CheckSensors(document, info, scenario.sensors);
  }
  for (const std::string& name : scenario.estimators.close_loops) {
    (void)FindEstimator(document, "estimators.close_loops", name);
  }
}

void CheckMetric(const YamlDocument& document, const Scenario& scenario, const std::string& key,
                 const std::string& metric) {
  if (IsMetric(metric)) {
    const std::string estimator = EstimatorOfMetric(metric);
    const auto& run = scenario.estimators.run;
    // --estimators leaves some out on purpose: their criteria are skipped, not wrong.
    const bool chosen = document.overrides.contains("estimators.run");
    if (estimator.empty() || chosen || std::find(run.begin(), run.end(), estimator) != run.end()) {
      return;
    }
    FailAt(document, key, fmt::format("estimator '{}' is not in estimators.run", estimator));
  }
  const std::string nearest = NearestWord(metric, AllMetrics());
  FailAt(document, key,
         fmt::format("'{}' is no metric of a run{} (polnav list shows all)", metric,
                     nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest)));
}

void CheckCriteria(const YamlDocument& document, const Scenario& scenario) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < scenario.criteria.size(); ++i) {
    const Criterion& criterion = scenario.criteria[i];
    const std::string key = fmt::format("criteria.{}", i);
    if (criterion.name.empty()) FailAt(document, key, "a criterion needs a name");
    if (!names.insert(criterion.name).second) {
      FailAt(document, key + ".name", fmt::format("'{}' is given twice", criterion.name));
    }
    if (criterion.metric.empty()) FailAt(document, key, "a criterion needs a metric");
    CheckMetric(document, scenario, key + ".metric", criterion.metric);
    if (!criterion.below.empty()) {
      CheckMetric(document, scenario, key + ".below", criterion.below);
    }
    if (!criterion.at_most && !criterion.at_least && criterion.below.empty()) {
      FailAt(document, key, "a criterion needs at_most, at_least or below");
    }
  }
}

Scenario FromDocument(YamlDocument document, const std::vector<ScenarioOverride>& overrides,
                      sim::Level level) {
  for (const auto& [assignment, source] : overrides) {
    ApplyOverride(document, assignment, source);
  }
  Scenario scenario;
  LoadOptions(document, scenario);
  ResolveSceneFile(document, scenario.world);
  CheckBasics(document, scenario);
  CheckWorld(document, scenario.world);
  CheckVehicle(document, scenario.vehicle);
  CheckRates(document, scenario.sensors);
  CheckStereo(document, scenario.sensors.stereo);
  CheckPolarizationCamera(document, scenario.sensors.polarization_camera);
  CheckFlow(document, scenario);
  CheckDisturbances(document, scenario);
  CheckOutages(document, scenario);
  CheckListening(document, scenario, level);
  CheckLevel(document, scenario, level);
  return scenario;
}

}  // namespace

void CheckListening(const YamlDocument& document, const Scenario& scenario, sim::Level level) {
  if (!sky::ParseUtc(scenario.site.utc)) {
    FailAt(document, "site.utc",
           fmt::format("'{}' is no date like 2020-11-11T07:00:00Z", scenario.site.utc));
  }
  CheckFaults(document, scenario, level);
  CheckEstimators(document, scenario);
  CheckCriteria(document, scenario);
}

Scenario LoadScenario(const std::filesystem::path& path,
                      const std::vector<ScenarioOverride>& overrides, sim::Level level) {
  return FromDocument(ReadYaml(path), overrides, level);
}

Scenario ParseScenario(const std::string& text, const std::string& file,
                       const std::vector<ScenarioOverride>& overrides, sim::Level level) {
  return FromDocument(ParseYaml(text, file), overrides, level);
}

Scenario ScenarioOf(const YamlDocument& document, const std::vector<ScenarioOverride>& overrides,
                    sim::Level level) {
  return FromDocument({document.file, YAML::Clone(document.root), document.overrides}, overrides,
                      level);
}

std::string ResolvedYaml(const Scenario& scenario) { return ToYaml(OptionValues(scenario)); }

}  // namespace polnav::testbed
