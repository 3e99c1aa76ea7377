#include "tools/testbed/fault_checks.h"

#include <gtest/gtest.h>

#include "tools/testbed/input_error.h"

namespace polnav::testbed {
namespace {

constexpr const char* kSensors =
    "sensors:\n  stereo: {}\n  imu: {}\n  polarimeter: {}\n  polarization_camera: {}\n";

std::string ErrorOf(const std::string& faults,
                    const std::vector<ScenarioOverride>& overrides = {}) {
  try {
    (void)ParseScenario(std::string("name: a\nduration_s: 20\n") + kSensors + "faults:\n" + faults,
                        "s.yaml", overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string ErrorOfOne(const std::string& fault) { return ErrorOf("  - {" + fault + "}\n"); }

TEST(CheckFaults, AcceptsEachKind) {
  for (const char* fault :
       {"sensor: imu, stuck: {}", "sensor: imu, bias: {gyro_deg_s: [1, 0, 0]}",
        "sensor: imu, drift: {accel_mg: [1, 0, 0], over_s: 5}", "sensor: imu, noise: {times: 3}",
        "sensor: polarimeter, noise: {level: 0.01}", "sensor: polarimeter, dead_channel: {}",
        "sensor: polarization_camera, dead_channel: {channel: 3}",
        "sensor: stereo, corrupt: {look: bit_flips}", "sensor: stereo, clock: {offset_s: 0.1}",
        "sensor: stereo, off: {}", "sensor: stereo, drop: {}", "sensor: stereo, duplicate: {}",
        "sensor: stereo, delay: {}", "sensor: stereo, reorder: {}"}) {
    EXPECT_EQ(ErrorOfOne(fault), "no error") << fault;
  }
}

TEST(CheckFaults, WantsASensorThatIsThere) {
  EXPECT_EQ(ErrorOfOne("sensor: sterio, off: {}"),
            "s.yaml:9: faults.0.sensor: 'sterio' is not a sensor of this scenario, which are: "
            "stereo, imu, polarimeter, polarization_camera; did you mean 'stereo'?");
  EXPECT_EQ(ErrorOfOne("sensor: reference, off: {}"),
            "s.yaml:9: faults.0.sensor: 'reference' is not a sensor of this scenario, which are: "
            "stereo, imu, polarimeter, polarization_camera");
  EXPECT_EQ(ErrorOfOne("off: {}"),
            "s.yaml:9: faults.0: a fault needs a sensor, one of: stereo, imu, polarimeter, "
            "polarization_camera");
}

TEST(CheckFaults, WantsOneKindThatFits) {
  EXPECT_EQ(ErrorOfOne("sensor: imu"),
            "s.yaml:9: faults.0: a fault needs one of: stuck, bias, drift, noise, dead_channel, "
            "corrupt, clock, off, drop, duplicate, delay, reorder");
  EXPECT_EQ(ErrorOfOne("sensor: imu, off: {}, stuck: {}"),
            "s.yaml:9: faults.0: 'stuck' and 'off' exclude each other: one kind an entry");
  EXPECT_EQ(ErrorOfOne("sensor: imu, dead_channel: {}"),
            "s.yaml:9: faults.0.dead_channel: makes no sense for 'imu'");
  EXPECT_EQ(ErrorOfOne("sensor: imu, corrupt: {}"),
            "s.yaml:9: faults.0.corrupt: makes no sense for 'imu'");
}

TEST(CheckFaults, WantsAmountsThatTheSensorHas) {
  EXPECT_EQ(ErrorOfOne("sensor: imu, bias: {heading_deg: 3}"),
            "s.yaml:9: faults.0.bias.heading_deg: 'imu' has none");
  EXPECT_EQ(ErrorOfOne("sensor: imu, bias: {}"),
            "s.yaml:9: faults.0.bias: does nothing: no amount for 'imu' is given");
  EXPECT_EQ(ErrorOfOne("sensor: polarimeter, noise: {times: 3}"),
            "s.yaml:9: faults.0.noise.times: the rig does not state the noise of 'polarimeter'; "
            "give one sigma instead");
  EXPECT_EQ(ErrorOfOne("sensor: imu, noise: {times: 3, accel_mg: [1, 1, 1]}"),
            "s.yaml:9: faults.0.noise: either times or sigmas, not both");
}

TEST(CheckFaults, KnowsThePartsOfASensor) {
  EXPECT_EQ(ErrorOfOne("sensor: polarization_camera, dead_channel: {channel: 4}"),
            "s.yaml:9: faults.0.dead_channel.channel: 4 is out of range, a mosaic has channels 0 "
            "to 3");
  EXPECT_EQ(ErrorOfOne("sensor: polarization_camera, corrupt: {side: left}"),
            "s.yaml:9: faults.0.corrupt.side: 'polarization_camera' has no sides");
  EXPECT_EQ(ErrorOfOne("sensor: polarization_camera, corrupt: {look: missing}"),
            "s.yaml:9: faults.0.corrupt.look: 'missing' is for one of a pair; use drop or off");
}

TEST(CheckFaults, RefusesWhatComesAfterTheEndButForACutRun) {
  EXPECT_EQ(ErrorOfOne("sensor: imu, start_s: 20, off: {}"),
            "s.yaml:9: faults.0.start_s: 20 s is after the end; the scenario lasts 20 s");
  EXPECT_EQ(
      ErrorOf("  - {sensor: imu, start_s: 10, off: {}}\n", {{"duration_s=5", "--duration 5"}}),
      "no error");
}

TEST(CheckFaults, RefusesOverlapsThatExcludeEachOther) {
  const std::string off = "  - {sensor: imu, start_s: 2, duration_s: 4, off: {}}\n";
  EXPECT_EQ(ErrorOf(off + "  - {sensor: imu, start_s: 5, noise: {times: 2}}\n"),
            "s.yaml:10: faults.1: 'noise' of 'imu' overlaps in time with 'off' in faults.0, and "
            "they exclude each other");
  EXPECT_EQ(ErrorOf(off + "  - {sensor: imu, start_s: 6, noise: {times: 2}}\n"), "no error");
  EXPECT_EQ(ErrorOf(off + "  - {sensor: stereo, start_s: 5, off: {}}\n"), "no error");
}

}  // namespace
}  // namespace polnav::testbed
