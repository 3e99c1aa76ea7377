// What a replay listens with: the recording's own scenario, or defaults from its sensors.
#include "tools/testbed/dataset/replay_settings.h"

#include <gtest/gtest.h>

#include "tests/testbed/dataset/dataset_files.h"
#include "tests/testbed/temporary_folder.h"
#include "tools/testbed/input_error.h"

namespace polnav::testbed {
namespace {

using Names = std::vector<std::string>;

class Settings : public ::testing::Test {
 protected:
  Settings() {
    info_.name = "flight";
    info_.duration = 20'000'000'000;
    info_.rig = sim::NominalRig(SmallScenario().sensors);
  }
  std::string ErrorOf(const std::string& set) {
    try {
      (void)ReplaySettings(info_, {{set, "--set " + set}});
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  TemporaryFolder folder_;
  DatasetInfo info_;
};

TEST_F(Settings, EstimatorsFollowFromTheSensors) {
  EXPECT_EQ(ReplaySettings(info_, {}).estimators.run, Names({"stereo", "stereo_polarization"}));
  info_.rig.polarimeter.reset();
  EXPECT_EQ(ReplaySettings(info_, {}).estimators.run, Names{"stereo"});
  info_.rig.stereo.reset();
  EXPECT_EQ(ReplaySettings(info_, {}).estimators.run, Names{"ukf_no_polarization"});
  info_.rig.optical_flow.reset();
  EXPECT_EQ(ReplaySettings(info_, {}).estimators.run, Names{"compass_stokes"});
  EXPECT_NE(ErrorOf("estimators.run=[stereo]").find("'stereo' needs cameras"), std::string::npos);
}

TEST_F(Settings, FaultsAreHeldAgainstTheDatasetsOwnSensorsAndLength) {
  EXPECT_EQ(ErrorOf("faults=[{sensor: imu, start_s: 19, off: {}}]"), "no error");
  EXPECT_NE(ErrorOf("faults=[{sensor: imu, start_s: 21, off: {}}]").find("after the end"),
            std::string::npos);
  EXPECT_NE(ErrorOf("faults=[{sensor: reference, off: {}}]").find("'reference' is not a sensor"),
            std::string::npos);
}

TEST_F(Settings, WhatOnlyASimulationCouldFollowIsRefused) {
  EXPECT_EQ(
      ErrorOf("sensors.imu.rate_hz=50")
          .find("--set sensors.imu.rate_hz=50: a replay does not simulate; it can change: name"),
      0U);
  EXPECT_NE(ErrorOf("duration_s=3"), "no error");
  EXPECT_NE(ErrorOf("site.utc=yesterday").find("is no date"), std::string::npos);
  EXPECT_EQ(ErrorOf("site.utc=2014-06-25T10:00:00Z"), "no error");
}

// A recording cut short carries faults from after its end, as the live run did.
TEST_F(Settings, TheRecordingsOwnScenarioComesFirst) {
  Scenario scenario = SmallScenario();
  scenario.faults.push_back({.sensor = "imu", .start_s = 30.0, .off = sim::OffFault{}});
  info_.scenario_file = folder_.path() / "scenario.yaml";
  WriteText(info_.scenario_file, ResolvedYaml(scenario));
  const Scenario settings = ReplaySettings(info_, {{"seed=9", "--seed 9"}});
  EXPECT_EQ(settings.name, "small");
  EXPECT_EQ(settings.seed, 9U);
  EXPECT_EQ(settings.estimators.run, Names{"stereo"});
  EXPECT_EQ(settings.faults.size(), 1U);
  EXPECT_FALSE(NeedsSun(settings));
}

}  // namespace
}  // namespace polnav::testbed
