#include "tools/testbed/level_checks.h"

#include <gtest/gtest.h>

#include "tools/testbed/input_error.h"

namespace polnav::testbed {
namespace {

std::string ErrorOf(const std::string& yaml, sim::Level level = sim::Level::kMeasurement) {
  try {
    (void)ParseScenario("name: a\nduration_s: 20\n" + yaml, "s.yaml", {}, level);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string ErrorOfFault(const std::string& fault, sim::Level level = sim::Level::kMeasurement) {
  return ErrorOf("sensors: {stereo: {}, imu: {}}\nfaults:\n  - {" + fault + "}\n", level);
}

TEST(CheckLevel, MeasurementLevelNeedsNoPictures) {
  EXPECT_EQ(ErrorOf("sensors: {stereo: {}, polarimeter: {}, polarization_camera: {}}\n"),
            "no error");
  EXPECT_EQ(ErrorOf("sensors: {imu: {}}\n"), "no error");
  EXPECT_EQ(ErrorOf("sensors: {stereo: {exposure_time_s: 0.01, auto_exposure: true}}\n"),
            "no error");
}

TEST(CheckLevel, RefusesWhatOnlyPicturesHave) {
  const std::string truth = "sensors: {stereo: {ground_truth: true}}\n";
  EXPECT_EQ(ErrorOf(truth),
            "s.yaml:3: sensors.stereo.ground_truth: depth and flow belong to pictures, and --level "
            "measurement draws none");
  EXPECT_EQ(ErrorOf(truth, sim::Level::kImage), "no error");
  EXPECT_EQ(ErrorOf("sensors: {stereo: {rolling_shutter_s: 0.02}}\n"),
            "s.yaml:3: sensors.stereo.rolling_shutter_s: --level measurement sees all rows at one "
            "instant: 0, or --level image");
}

TEST(CheckLevel, RefusesFaultsOfGreyLevels) {
  EXPECT_EQ(ErrorOfFault("sensor: stereo, corrupt: {}"),
            "s.yaml:5: faults.0.corrupt: acts on pictures, and --level measurement draws none");
  EXPECT_EQ(ErrorOfFault("sensor: stereo, noise: {level: 0.1}"),
            "s.yaml:5: faults.0.noise: changes grey levels, and --level measurement draws no "
            "pictures; give feature_px to sensor 'stereo_features' instead");
  EXPECT_EQ(ErrorOfFault("sensor: stereo, corrupt: {}", sim::Level::kImage), "no error");
}

TEST(CheckLevel, FaultsOfArrivalActOnEither) {
  for (const char* kind : {"off", "drop", "duplicate", "delay", "reorder", "stuck"}) {
    EXPECT_EQ(ErrorOfFault(std::string("sensor: stereo, ") + kind + ": {}"), "no error") << kind;
  }
  EXPECT_EQ(ErrorOfFault("sensor: stereo, clock: {offset_s: 0.1}"), "no error");
}

TEST(CheckLevel, FeaturesAreASensorOnlyWhereNoPicturesAre) {
  const std::string bias = "sensor: stereo_features, bias: {feature_px: [1, 0, 0]}";
  EXPECT_EQ(ErrorOfFault(bias), "no error");
  EXPECT_EQ(ErrorOfFault(bias, sim::Level::kImage),
            "s.yaml:5: faults.0.sensor: 'stereo_features' is not a sensor of this scenario, which "
            "are: stereo, imu");
}

// Both act on the same stream: what excludes each other does so under either name.
TEST(CheckLevel, KnowsBothNamesOfTheStream) {
  EXPECT_EQ(ErrorOf("sensors: {stereo: {}}\nfaults:\n  - {sensor: stereo, off: {}}\n"
                    "  - {sensor: stereo_features, drop: {}}\n"),
            "s.yaml:6: faults.1: 'drop' of 'stereo_features' overlaps in time with 'off' in "
            "faults.0, and they exclude each other");
}

TEST(FaultsAt, MoveFromPicturesToFeatures) {
  std::vector<sim::FaultOptions> faults(2);
  faults[0].sensor = "stereo";
  faults[1].sensor = "imu";
  EXPECT_EQ(FaultsAt(sim::Level::kImage, faults)[0].sensor, "stereo");
  EXPECT_EQ(FaultsAt(sim::Level::kMeasurement, faults)[0].sensor, "stereo_features");
  EXPECT_EQ(FaultsAt(sim::Level::kMeasurement, faults)[1].sensor, "imu");
}

TEST(FeatureOptions, AreCheckedLikeAllOthers) {
  EXPECT_EQ(ErrorOf("sensors:\n  stereo:\n    features: {outlier_share: 1.5}\n"),
            "s.yaml:5: sensors.stereo.features.outlier_share: 1.5 is out of range, [0, 1]");
  EXPECT_EQ(ErrorOf("sensors:\n  stereo:\n    features: {pixel_sgima_px: 1}\n"),
            "s.yaml:5: sensors.stereo.features.pixel_sgima_px: unknown key; did you mean "
            "'pixel_sigma_px'?");
}

}  // namespace
}  // namespace polnav::testbed
