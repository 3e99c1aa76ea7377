// A flow sensor that could say nothing is refused before anything is simulated.
#include "tools/testbed/flow_checks.h"

#include <gtest/gtest.h>

#include "tools/testbed/input_error.h"

namespace polnav::testbed {
namespace {

std::string ErrorOf(const std::string& flow, const std::string& rest = "") {
  try {
    (void)ParseScenario("name: a\nsensors:\n  optical_flow: {" + flow + "}\n" + rest, "s.yaml");
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(FlowChecks, TakesTheDefaultsAndItsFaults) {
  EXPECT_EQ(ErrorOf(""), "no error");
  EXPECT_EQ(ErrorOf("", "faults: [{sensor: flow, start_s: 1, bias: {range_m: 0.1}}]\n"),
            "no error");
}

TEST(FlowChecks, RefusesRatesThatDoNotFit) {
  EXPECT_EQ(ErrorOf("internal_rate_hz: 400"),
            "s.yaml:3: sensors.optical_flow.internal_rate_hz: 400 Hz does not fit whole steps of "
            "the simulation");
  EXPECT_EQ(ErrorOf("internal_rate_hz: 125"),
            "s.yaml:3: sensors.optical_flow.internal_rate_hz: 125 pictures a second do not make 50 "
            "readings a second: expected a whole number for each");
  EXPECT_NE(ErrorOf("rate_hz: 333").find("sensors.optical_flow.rate_hz: 333 Hz does not fit"),
            std::string::npos);
}

TEST(FlowChecks, RefusesASensorOutOfItsRange) {
  EXPECT_EQ(ErrorOf("range_min_m: 2, range_max_m: 1"),
            "s.yaml:3: sensors.optical_flow.range_min_m: 2 m is not below range_max_m, 1 m");
  EXPECT_EQ(ErrorOf("position_m: [0, 0, 6]"),
            "s.yaml:3: sensors.optical_flow.position_m: the sensor is 6 m or more above the "
            "ground, beyond range_max_m, 5 m");
  EXPECT_EQ(
      ErrorOf("position_m: [0, 0, -0.9]", "vehicle: {turntable: {position_m: [0, 0, 1]}}\n"),
      "s.yaml:3: sensors.optical_flow.position_m: the sensor is 0.1 m above the ground, below "
      "range_min_m, 0.3 m");
  EXPECT_EQ(ErrorOf("position_m: [0.2, 0, 0.1]", "vehicle: {hexapod: {}}\n"),
            "s.yaml:3: sensors.optical_flow.position_m: the sensor is 0.185 m above the ground, "
            "below range_min_m, 0.3 m");
  EXPECT_EQ(ErrorOf("position_m: [0.2, 0, 0.3]", "vehicle: {hexapod: {}}\n"), "no error");
  EXPECT_NE(ErrorOf("range_max_m: -1").find("out of range"), std::string::npos);
}

}  // namespace
}  // namespace polnav::testbed
