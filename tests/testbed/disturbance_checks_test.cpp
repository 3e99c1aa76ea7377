#include "tools/testbed/disturbance_checks.h"

#include <gtest/gtest.h>

#include "tools/testbed/input_error.h"

namespace polnav::testbed {
namespace {

std::string ErrorOf(const std::string& disturbance, const std::string& more = "",
                    const std::vector<ScenarioOverride>& overrides = {}) {
  try {
    (void)ParseScenario(
        "name: a\nduration_s: 20\n" + more + "disturbances:\n  - " + disturbance + "\n", "s.yaml",
        overrides);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

TEST(CheckDisturbances, AcceptsEachKind) {
  for (const char* kind :
       {"{passing: {}}", "{darkness: {}}", "{overexposure: {}}", "{glare: {}}", "{fog: {}}",
        "{rain: {}}", "{dirt: {}}", "{cloud_passage: {}}", "{low_features: {start_m: 20}}",
        "{canopy: {}}", "{tunnel: {start_m: 40}}", "{bridge: {}}"}) {
    EXPECT_EQ(ErrorOf(kind), "no error") << kind;
  }
}

TEST(CheckDisturbances, WantsExactlyOneKind) {
  EXPECT_EQ(ErrorOf("{start_s: 3}"),
            "s.yaml:4: disturbances.0: a disturbance needs one kind, such as passing, fog or "
            "tunnel");
  EXPECT_EQ(ErrorOf("{fog: {}, rain: {}}"),
            "s.yaml:4: disturbances.0: a disturbance has one kind, not 2: fog, rain");
}

TEST(CheckDisturbances, RefusesWhatComesAfterTheEnd) {
  EXPECT_EQ(ErrorOf("{start_s: 20, fog: {}}"),
            "s.yaml:4: disturbances.0.start_s: 20 s is after the end of the scenario, at 20 s");
  EXPECT_EQ(ErrorOf("{start_s: 10, fog: {}}", "", {{"duration_s=5", "--duration 5"}}), "no error");
}

TEST(CheckDisturbances, RefusesStretchesThatCannotStandOnTheRoad) {
  EXPECT_EQ(ErrorOf("{tunnel: {start_m: 400}}"),
            "s.yaml:4: disturbances.0.tunnel.start_m: lies outside the track of 377 m");
  EXPECT_EQ(ErrorOf("{canopy: {length_m: 400}}"),
            "s.yaml:4: disturbances.0.canopy.length_m: reaches beyond the end of the track of 377 "
            "m");
  EXPECT_EQ(ErrorOf("{tunnel: {start_m: 60}}",
                    "world: {structures: [{kind: bridge, start_m: 65, length_m: 8}]}\n"),
            "s.yaml:5: disturbances.0.tunnel.start_m: overlaps the bridge from 65 m on");
  EXPECT_EQ(ErrorOf("{start_s: 3, canopy: {}}"),
            "s.yaml:4: disturbances.0.start_s: a stretch of road is there all the time: it has "
            "none");
}

TEST(CheckDisturbances, RefusesWhoNeverPasses) {
  EXPECT_EQ(
      ErrorOf("{passing: {speed_m_s: 6}}"),
      "s.yaml:4: disturbances.0.passing.speed_m_s: 6 m/s never passes a vehicle that drives 6 "
      "m/s");
  EXPECT_EQ(ErrorOf("{passing: {speed_m_s: 6}}", "vehicle: {turntable: {}}\n"), "no error");
  EXPECT_EQ(ErrorOf("{cloud_passage: {}}", "sky: {wind_m_s: 0}\n"),
            "s.yaml:5: disturbances.0.cloud_passage: no cloud passes: sky.wind_m_s is 0");
}

}  // namespace
}  // namespace polnav::testbed
