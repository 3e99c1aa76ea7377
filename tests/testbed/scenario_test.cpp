// Scenario files: what reads, reads back, and what cannot make sense is refused before simulating.
#include "tools/testbed/scenario.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/testbed/example_run.h"
#include "tests/testbed/temporary_folder.h"
#include "tools/testbed/input_error.h"

namespace polnav::testbed {
namespace {

std::string ErrorOf(const std::string& text, const std::vector<std::string>& set = {}) {
  std::vector<ScenarioOverride> overrides;
  for (const std::string& s : set) overrides.push_back({s, "--set " + s});
  try {
    (void)ParseScenario(text, "s.yaml", overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string ErrorWith(const std::string& set) { return ErrorOf(ExampleScenarioYaml(), {set}); }

TEST(Scenario, ReadsTheExample) {
  const Scenario s = ParseScenario(ExampleScenarioYaml(), "s.yaml");
  EXPECT_EQ(s.name, "example");
  EXPECT_EQ(s.seed, 42U);
  EXPECT_EQ(s.paper, std::vector<std::string>{"Chu2021"});
  EXPECT_EQ(s.site.utc, "2020-11-11T07:00:00Z");
  EXPECT_TRUE(s.sensors.stereo.has_value());
  EXPECT_FALSE(s.sensors.reference.has_value());
  EXPECT_EQ(s.criteria.size(), 2U);
  EXPECT_EQ(s.criteria[0].at_most, 1.0);
  EXPECT_FALSE(s.criteria[1].at_most.has_value());
}

TEST(Scenario, ReadsBackFromItsResolvedForm) {
  const Scenario s = ParseScenario(ExampleScenarioYaml(), "s.yaml");
  const std::string resolved = ResolvedYaml(s);
  EXPECT_EQ(ResolvedYaml(ParseScenario(resolved, "resolved.yaml")), resolved);
  EXPECT_NE(resolved.find("latitude_deg: 38.832"), std::string::npos);
}

TEST(Scenario, KeepsSeveralLinesOfDescription) {
  Scenario s = ParseScenario(ExampleScenarioYaml(), "s.yaml");
  s.description = "two lines: of text\nand # the second\n";
  EXPECT_EQ(ParseScenario(ResolvedYaml(s), "r.yaml").description, s.description);
}

TEST(Scenario, RefusesAnEstimatorWithoutItsSensors) {
  EXPECT_EQ(ErrorOf("name: a\nestimators:\n  start: {}\n  run: [stereo]\n"),
            "s.yaml:4: estimators.run: 'stereo' needs cameras, but sensors.stereo is off");
  EXPECT_EQ(ErrorWith("sensors.polarimeter=null"),
            "s.yaml:15: estimators.run: 'stereo_polarization' needs a polarimeter, but "
            "sensors.polarimeter is off");
  EXPECT_EQ(ErrorWith("estimators.run=[compass_stokes]"),
            "--set estimators.run=[compass_stokes]: estimators.run: 'compass_stokes' needs a sky "
            "camera, but sensors.polarization_camera is off");
  EXPECT_EQ(ErrorWith("estimators.run=[ukf_no_polarization]"),
            "--set estimators.run=[ukf_no_polarization]: estimators.run: 'ukf_no_polarization' "
            "needs optical flow, but sensors.optical_flow is off");
}

TEST(Scenario, RefusesEstimatorsThatItDoesNotKnow) {
  EXPECT_EQ(ErrorWith("estimators.run=[sterio]"),
            "--set estimators.run=[sterio]: estimators.run: 'sterio' is not one of: stereo, "
            "stereo_polarization, polarization, compass_lsq, compass_ransac_tls, compass_stokes, "
            "compass_zenith, ukf_paper, ukf_paper_no_polarization, ukf, ukf_no_polarization; did "
            "you mean 'stereo'?");
  EXPECT_EQ(ErrorWith("estimators.run=[stereo, stereo]"),
            "--set estimators.run=[stereo, stereo]: estimators.run: 'stereo' is listed twice");
  EXPECT_EQ(ErrorWith("estimators.close_loops=[stereos]"),
            "--set estimators.close_loops=[stereos]: estimators.close_loops: 'stereos' is not one "
            "of: stereo, stereo_polarization, polarization, compass_lsq, compass_ransac_tls, "
            "compass_stokes, compass_zenith, ukf_paper, ukf_paper_no_polarization, ukf, "
            "ukf_no_polarization; did you mean 'stereo'?");
}

TEST(Scenario, RefusesLensesThatCannotBeRendered) {
  const auto lens = [](const std::string& keys) {
    return ErrorWith("sensors.stereo={width_px: 672, height_px: 376, model: equidistant, " + keys +
                     "}");
  };
  EXPECT_EQ(lens("focal_px: 330, k1: 0, k2: 0"), "no error");
  EXPECT_NE(lens("focal_px: 300, k1: 0, k2: 0")
                .find("sensors.stereo.focal_px: the picture's corners are 73.4 degrees from the "
                      "axis; at most 70 can be rendered"),
            std::string::npos);
  EXPECT_NE(lens("focal_px: 330, k1: -0.3, k2: 0").find("folds back"), std::string::npos);
  EXPECT_NE(ErrorWith("sensors.stereo={model: fisheye}").find("radtan, equidistant"),
            std::string::npos);
}

TEST(Scenario, RefusesAnExposureLongerThanAFrame) {
  EXPECT_NE(
      ErrorWith("sensors.stereo={rate_hz: 20, exposure_time_s: 0.03, rolling_shutter_s: 0.03}")
          .find("take longer than the time between two pictures"),
      std::string::npos);
}

TEST(Scenario, RefusesDurationsThatAreNotWholeMilliseconds) {
  EXPECT_EQ(ErrorWith("duration_s=1.0005"),
            "--set duration_s=1.0005: duration_s: 1.0005 s is not a whole number of milliseconds");
  EXPECT_EQ(ErrorWith("duration_s=0"),
            "--set duration_s=0: duration_s: 0 is out of range, [0.001, 86400]");
  EXPECT_EQ(ErrorWith("duration_s=0.3"), "no error");
}

TEST(Scenario, RefusesWhatCannotBeSimulated) {
  EXPECT_EQ(ErrorOf("duration_s: 5\n"), "s.yaml: name: a scenario needs a name");
  EXPECT_EQ(ErrorWith("site.utc=yesterday"),
            "--set site.utc=yesterday: site.utc: 'yesterday' is no date like "
            "2020-11-11T07:00:00Z");
  EXPECT_EQ(ErrorWith("sensors.imu.rate_hz=333"),
            "--set sensors.imu.rate_hz=333: sensors.imu.rate_hz: 333 Hz does not fit whole steps "
            "of the simulation");
  EXPECT_EQ(ErrorOf("name: a\nvehicle:\n  car: {}\n  turntable: {}\n"),
            "s.yaml:2: vehicle: 'car', 'turntable' and 'hexapod' exclude each other");
  EXPECT_EQ(ErrorOf("name: a\nsensors:\n  polarization_camera:\n    layout: 0,45/90\n"),
            "s.yaml:4: sensors.polarization_camera.layout: mosaic layout '0,45/90': expected each "
            "of 0, 45, 90, 135 once, first row / second row, such as 90,45/135,0");
}

TEST(Scenario, AnImuPresetIsOverriddenByWhatIsWritten) {
  const Scenario s = ParseScenario(
      "name: a\nsensors:\n  imu:\n    gyro_bias_sigma_deg_s: 0.5\n    preset: icm20602\n",
      "s.yaml");
  EXPECT_EQ(s.sensors.imu->gyro_bias_sigma_deg_s, 0.5) << "whichever comes first";
  EXPECT_EQ(s.sensors.imu->accel_bias_sigma_mg, 40.0);
  const std::string resolved = ResolvedYaml(s);
  const Scenario again = ParseScenario(resolved, "resolved.yaml");
  EXPECT_EQ(ResolvedYaml(again), resolved);
  EXPECT_EQ(again.sensors.imu->preset, "icm20602");
  EXPECT_EQ(again.sensors.imu->gyro_bias_sigma_deg_s, 0.5);
  EXPECT_EQ(ParseScenario(resolved, "r.yaml", {{"sensors.imu.gyro_bias_sigma_deg_s=2", "--set"}})
                .sensors.imu->gyro_bias_sigma_deg_s,
            2.0);
}

TEST(Scenario, RefusesAnImuThatItDoesNotKnow) {
  EXPECT_EQ(ErrorOf("name: a\nsensors:\n  imu:\n    preset: icm20601\n"),
            "s.yaml:4: sensors.imu.preset: 'icm20601' is not one of: adis16475_2, icm20602, "
            "span_cpt, hg4930, perfect; did you mean 'icm20602'?");
  EXPECT_EQ(ErrorOf("name: a\nsensors:\n  imu:\n    temperature: {end_deg_c: 300}\n"),
            "s.yaml:4: sensors.imu.temperature.end_deg_c: 300 is out of range, [-60, 125]");
}

TEST(Scenario, RefusesOutagesThatCannotHappen) {
  const std::string head = "name: a\nduration_s: 100\nsensors:\n  reference:\n    outages:\n";
  EXPECT_EQ(ErrorOf(head + "      - {start_s: 10, duration_s: 5}\n      - {start_s: 20}\n"),
            "no error");
  EXPECT_EQ(ErrorOf(head + "      - {start_s: 100}\n"),
            "s.yaml:6: sensors.reference.outages.0.start_s: 100 s is not before the run's end, "
            "100 s");
  EXPECT_EQ(ErrorOf(head + "      - {start_s: 10, duration_s: 20}\n      - {start_s: 25}\n"),
            "s.yaml:7: sensors.reference.outages.1.start_s: 25 s is before the end of the outage "
            "above, 30 s: list them in order, without overlap");
  EXPECT_EQ(ErrorOf(head + "      - {start_s: 10, duration_s: 0}\n"),
            "s.yaml:6: sensors.reference.outages.0.duration_s: 0 is out of range, [0.001, 86400]");
}

TEST(Scenario, RefusesCriteriaThatCannotBeJudged) {
  EXPECT_EQ(ErrorWith("criteria.0.metric=estimators.stereo.heading_deg.rmes"),
            "--set criteria.0.metric=estimators.stereo.heading_deg.rmes: criteria.0.metric: "
            "'estimators.stereo.heading_deg.rmes' is no metric of a run; did you mean "
            "'estimators.stereo.heading_deg.rmse'? (polnav list shows all)");
  EXPECT_EQ(ErrorOf("name: a\ncriteria:\n  - name: c\n    metric: wall_s\n"),
            "s.yaml:3: criteria.0: a criterion needs at_most, at_least or below");
  EXPECT_EQ(ErrorOf("name: a\ncriteria:\n  - {name: c, at_most: 1}\n"),
            "s.yaml:3: criteria.0: a criterion needs a metric");
  EXPECT_EQ(ErrorOf("name: a\ncriteria:\n  - {metric: wall_s, at_most: 1}\n"),
            "s.yaml:3: criteria.0: a criterion needs a name");
  EXPECT_EQ(ErrorOf("name: a\ncriteria:\n"
                    "  - {name: c, metric: estimators.stereo.ate_m.rmse, at_most: 1}\n"),
            "s.yaml:3: criteria.0.metric: estimator 'stereo' is not in estimators.run");
  EXPECT_EQ(ErrorOf("name: a\ncriteria:\n  - {name: c, metric: wall_s, at_most: 1}\n"
                    "  - {name: c, metric: wall_s, at_most: 2}\n"),
            "s.yaml:4: criteria.1.name: 'c' is given twice");
}

TEST(Scenario, AcceptsMetricsThatTheRunNames) {
  EXPECT_EQ(ErrorOf("name: a\ncriteria:\n"
                    "  - {name: c, metric: timing_ms.render.p99, at_most: 1}\n"
                    "  - {name: d, metric: streams.imu.count, at_least: 1}\n"),
            "no error");
}

std::string WorldError(const std::string& world) { return ErrorOf("name: a\nworld:\n" + world); }

TEST(Scenario, RefusesAnActorWithNowhereToGo) {
  EXPECT_EQ(WorldError("  actors:\n    - kind: bus\n      path_m: [[1, 2]]\n"),
            "s.yaml:5: world.actors.0.path_m: a path needs two points or more, this one has 1");
  EXPECT_EQ(WorldError("  actors:\n    - kind: bus\n"),
            "s.yaml:4: world.actors.0.path_m: a path needs two points or more, this one has 0");
  EXPECT_EQ(WorldError("  actors:\n    - path_m: [[1, 2], [3, 4], [3, 4]]\n"),
            "s.yaml:4: world.actors.0.path_m: the points 1 and 2 of the path are the same");
  EXPECT_EQ(WorldError("  actors:\n    - path_m: [[1, 2], [3]]\n"),
            "s.yaml:4: world.actors.0.path_m: expected a list of 2 numbers, got 1 items");
  EXPECT_EQ(WorldError("  actors:\n    - kind: tram\n"),
            "s.yaml:4: world.actors.0.kind: 'tram' is not one of: car, bus, pedestrian");
  EXPECT_EQ(WorldError("  actors:\n    - path_m: [[1, 2], [3, 4.5]]\n      loop: true\n"),
            "no error");
}

TEST(Scenario, RefusesTrafficOnANarrowRoad) {
  EXPECT_EQ(WorldError("  track: {road_width_m: 4}\n  traffic: {cars: 3}\n"),
            "s.yaml:4: world.traffic: cars and buses pass the ego on both sides: they need a "
            "road_width_m of 7.6 or more, the track has 4");
}

TEST(Scenario, RefusesAStructureWhereItCannotStand) {
  EXPECT_EQ(WorldError("  structures:\n    - {kind: bridge, start_m: 400}\n"),
            "s.yaml:4: world.structures.0.start_m: lies outside the track of 377 m");
  EXPECT_EQ(
      WorldError("  structures:\n    - kind: tunnel\n      start_m: 350\n      length_m: 40\n"),
      "s.yaml:6: world.structures.0.length_m: reaches beyond the end of the track of 377 m");
  EXPECT_EQ(WorldError("  structures:\n    - {kind: plain_wall, start_m: -5, length_m: 40}\n"),
            "s.yaml:4: world.structures.0.start_m: a plain_wall must keep 5 m off the start, where "
            "the cameras set their exposure");
  EXPECT_EQ(WorldError("  structures:\n    - {kind: tunnel, start_m: 50, length_m: 40}\n"
                       "    - {kind: bridge, start_m: 80, length_m: 4}\n"),
            "s.yaml:5: world.structures.1.start_m: overlaps the tunnel from 50 m on");
}

TEST(Scenario, LooksForASceneFileBesideTheScenario) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "s.yaml";
  std::ofstream(file) << "name: a\nworld:\n  scene_file:\n    path: town.obj\n";
  const auto error = [&] {
    try {
      (void)LoadScenario(file);
    } catch (const InputError& e) {
      return std::string(e.what());
    }
    return std::string("no error");
  };
  const std::string at = file.string() + ":4: world.scene_file.path: scene file '" +
                         (folder.path() / "town.obj").string() + "': ";
  EXPECT_EQ(error(), at + "there is no such file");
  std::ofstream(folder.path() / "town.obj") << "v 0 0 0\nv 1 0 0\nl 1 2\n";
  EXPECT_EQ(error(), at + "it holds no faces");
  std::ofstream(folder.path() / "town.obj")
      << "mtllib town.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n";
  std::ofstream(folder.path() / "town.mtl") << "newmtl m\nmap_Kd bricks.png\n";
  EXPECT_EQ(error(), at + "the texture 'bricks.png' of its material 'm' is missing or no image");
  std::ofstream(folder.path() / "town.mtl") << "newmtl m\nKd 0.5 0.5 0.5\n";
  EXPECT_EQ(error(), "no error");
  EXPECT_EQ(ErrorOf("name: a\nworld:\n  scene_file: {scale: 2}\n"),
            "s.yaml:3: world.scene_file.path: expected the path of a glTF or OBJ file");
}

}  // namespace
}  // namespace polnav::testbed
