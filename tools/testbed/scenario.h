// What happens in a run: where, under which sky, driven how, sensed by what, judged by which
// criteria? One YAML file; its keys are the field names below and in the option structs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "nav/polarization/compass_options.h"
#include "nav/polarization/options.h"
#include "nav/stereo/options.h"
#include "nav/ukf/options.h"
#include "sim/faults/fault_options.h"
#include "sim/simulator.h"
#include "sky/skylight.h"
#include "sky/sun.h"
#include "tools/testbed/yaml_document.h"

namespace polnav::testbed {

// How well an estimator is told where it starts; it finds out everything else by itself.
struct StartOptions {
  double position_sigma_m = 0.01;
  double heading_sigma_deg = 0.5;
  double level_sigma_deg = 1.0;  // of the assumption that the vehicle starts level
  // It stands for so long first, and estimators may trust in that: ukf_paper takes the IMU's mean
  // readings off those after. The vehicle has to be told as well: its walk's start_delay_s.
  double standing_s = 0.0;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("position_sigma_m", position_sigma_m, {.min = 1e-4, .max = 1000.0});
    v("heading_sigma_deg", heading_sigma_deg, {.min = 1e-3, .max = 180.0});
    v("level_sigma_deg", level_sigma_deg, {.min = 1e-3, .max = 45.0});
    v("standing_s", standing_s, {.min = 0.0, .max = 3600.0});
  }
};

struct EstimatorOptions {
  std::vector<std::string> run;  // names; see estimators.h
  // Names of those that correct themselves where a place is seen again. The others are odometry.
  std::vector<std::string> close_loops;
  StartOptions start;
  nav::StereoOptions stereo;
  nav::PolarizationOptions polarization;
  nav::CompassOptions compass;
  nav::UkfOptions ukf;
  nav::PaperUkfOptions ukf_paper;
  // The sky camera goes through a calibration turn before the run; see calibration_turn.h.
  bool calibrate_sky_camera = false;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("run", run);
    v("close_loops", close_loops);
    v("start", start);
    v("stereo", stereo);
    v("polarization", polarization);
    v("compass", compass);
    v("ukf", ukf);
    v("ukf_paper", ukf_paper);
    v("calibrate_sky_camera", calibrate_sky_camera);
  }
};

// One sentence that a run must make true. metric and below are dotted paths into result.json.
struct Criterion {
  std::string name;
  std::string metric;
  std::optional<double> at_most;
  std::optional<double> at_least;
  std::string below;  // another metric; empty when not compared

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("name", name);
    v("metric", metric);
    v("at_most", at_most);
    v("at_least", at_least);
    v("below", below);
  }
};

struct Scenario {
  std::string name;
  std::string description;
  std::vector<std::string> paper;  // keys of docs/bibliography.md; their tables go into the report
  double duration_s = 60.0;        // a whole number of milliseconds
  std::uint64_t seed = 1;
  sky::SiteOptions site;
  sky::SkyOptions sky;
  sim::WorldOptions world;
  sim::VehicleOptions vehicle;
  sim::SensorOptions sensors;
  std::vector<sim::DisturbanceOptions> disturbances;
  std::vector<sim::FaultOptions> faults;
  EstimatorOptions estimators;
  std::vector<Criterion> criteria;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("name", name);
    v("description", description);
    v("paper", paper);
    v("duration_s", duration_s, {.min = 0.001, .max = 86400.0});
    v("seed", seed);
    v("site", site);
    v("sky", sky);
    v("world", world);
    v("vehicle", vehicle);
    v("sensors", sensors);
    v("disturbances", disturbances);
    v("faults", faults);
    v("estimators", estimators);
    v("criteria", criteria);
  }
};

// What the command line changes in a scenario file; see ApplyOverride.
struct ScenarioOverride {
  std::string assignment;  // key.path=value
  std::string source;      // how the user said it
};

// Throws InputError for whatever a run at this level could not make sense of, before anything is
// simulated.
[[nodiscard]] Scenario LoadScenario(const std::filesystem::path& path,
                                    const std::vector<ScenarioOverride>& overrides = {},
                                    sim::Level level = sim::Level::kImage);
[[nodiscard]] Scenario ParseScenario(const std::string& text, const std::string& file,
                                     const std::vector<ScenarioOverride>& overrides = {},
                                     sim::Level level = sim::Level::kImage);

// The same of a document that was read before, which is left as it is. Its lines are forgotten:
// errors name the file only.
[[nodiscard]] Scenario ScenarioOf(const YamlDocument& document,
                                  const std::vector<ScenarioOverride>& overrides, sim::Level level);

// The part of the checks that holds whether the measurements are simulated or recorded: the date,
// faults, estimators and criteria, against the sensors on board.
void CheckListening(const YamlDocument& document, const Scenario& scenario,
                    sim::Level level = sim::Level::kImage);

// Every key with its value, defaults included; reads back as the same scenario.
[[nodiscard]] std::string ResolvedYaml(const Scenario& scenario);

}  // namespace polnav::testbed
