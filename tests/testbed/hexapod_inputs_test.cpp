// What no walker and none of its filters can be: refused before anything is simulated, naming file,
// line, key and what was expected; the command line then ends with 2 and leaves nothing behind.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tests/testbed/example_run.h"
#include "tests/testbed/temporary_folder.h"
#include "tools/polnav/command_line.h"
#include "tools/testbed/option_range.h"

namespace polnav::testbed {
namespace {

// The section comes from line 2.
std::string ScenarioWith(const std::string& section, const std::string& flow) {
  return "name: walk\n" + section +
         "duration_s: 1\n"
         "site: {latitude_deg: 38.88, longitude_deg: 121.53, utc: \"2020-09-15T07:00:00Z\"}\n"
         "sensors:\n  imu: {preset: icm20602, rate_hz: 100}\n  optical_flow: " +
         flow + "\n  polarimeter: {rate_hz: 20}\n";
}

class HexapodInputs : public ::testing::Test {
 protected:
  // The exit code; the message without the folder.
  int Run(const std::string& section, const std::string& flow = "{rate_hz: 50}") {
    std::ofstream(file_) << ScenarioWith(section, flow);
    std::ostringstream err;
    const int code = RunCommandLine({"run", file_, "--level", "measurement", "--out", out_},
                                    {out_text_, err, false}, ExampleRun);
    message_ = err.str();
    const std::string start = "polnav: " + folder_.path().string() + "/";
    if (message_.starts_with(start)) message_ = message_.substr(start.size());
    EXPECT_EQ(std::filesystem::exists(out_), code != kExitBadInput) << message_;
    return code;
  }

  TemporaryFolder folder_;
  std::string file_ = (folder_.path() / "s.yaml").string();
  std::string out_ = (folder_.path() / "out").string();
  std::ostringstream out_text_;
  std::string message_;
};

// Keys of sigmas and the like: what must not be negative.
struct SigmaKeys {
  std::vector<std::string> keys;

  void operator()(const char* name, const double&, const OptionRange&) {
    const std::string key = name;
    if (key.find("sigma") != std::string::npos || key.find("sensitivity") != std::string::npos) {
      keys.push_back(key);
    }
  }
  void operator()(const char*, const auto&) {}
};

template <typename Options>
std::vector<std::string> SigmasOf() {
  Options options;
  SigmaKeys keys;
  options.Visit(keys);
  return keys.keys;
}

TEST_F(HexapodInputs, AWalkIsTaken) {
  EXPECT_NE(Run("vehicle: {hexapod: {}}\nestimators:\n  run: [ukf, ukf_paper]\n"), kExitBadInput)
      << message_;
}

TEST_F(HexapodInputs, ANegativeSigmaOfAFilter) {
  const auto refuse = [&](const std::string& filter, const std::string& key) {
    EXPECT_EQ(Run(fmt::format("estimators:\n  run: [{0}]\n  {0}: {{{1}: -0.01}}\n", filter, key)),
              kExitBadInput)
        << key;
    const std::string expected =
        fmt::format("s.yaml:4: estimators.{}.{}: -0.01 is out of range, [", filter, key);
    EXPECT_EQ(message_.substr(0, expected.size()), expected);
  };
  const std::vector<std::string> ours = SigmasOf<nav::UkfOptions>();
  const std::vector<std::string> papers = SigmasOf<nav::PaperUkfOptions>();
  EXPECT_GE(ours.size(), 9U);
  EXPECT_GE(papers.size(), 6U);
  for (const std::string& key : ours) refuse("ukf", key);
  for (const std::string& key : papers) refuse("ukf_paper", key);
  for (const char* key : {"position_sigma_m", "heading_sigma_deg", "level_sigma_deg"}) {
    refuse("start", key);
  }
}

TEST_F(HexapodInputs, ASigmaThatIsNoNumber) {
  for (const char* value : {".nan", ".inf", "wide"}) {
    EXPECT_EQ(Run(fmt::format("estimators:\n  ukf:\n    slope_sigma: {}\n", value)), kExitBadInput)
        << value;
    EXPECT_EQ(message_.substr(0, 36), "s.yaml:4: estimators.ukf.slope_sigma");
  }
}

TEST_F(HexapodInputs, AGaitThatTheJointsCannotReach) {
  EXPECT_EQ(Run("vehicle:\n  hexapod:\n    gait: {reach_m: 0.4}\n"), kExitBadInput);
  EXPECT_EQ(message_,
            "s.yaml:4: vehicle.hexapod.gait.reach_m: standing so wide at this body height is out "
            "of reach of the legs' joints\n");
  EXPECT_EQ(Run("vehicle:\n  hexapod:\n    walk: {speed_m_s: 1.5}\n"), kExitBadInput);
  EXPECT_TRUE(
      message_.starts_with("s.yaml:4: vehicle.hexapod.walk.speed_m_s: the joints cannot reach "
                           "where the feet must go at 1.5 m/s"))
      << message_;
}

TEST_F(HexapodInputs, AServoWithoutTorqueOrSpeed) {
  EXPECT_EQ(Run("vehicle:\n  hexapod:\n    servo: {stall_torque_n_m: 0}\n"), kExitBadInput);
  EXPECT_EQ(message_,
            "s.yaml:4: vehicle.hexapod.servo.stall_torque_n_m: 0 is out of range, [0.01, 100]\n");
  EXPECT_EQ(Run("vehicle:\n  hexapod:\n    servo: {no_load_speed_deg_s: 0}\n"), kExitBadInput);
  EXPECT_EQ(message_,
            "s.yaml:4: vehicle.hexapod.servo.no_load_speed_deg_s: 0 is out of range, [1, 5000]\n");
}

TEST_F(HexapodInputs, AFlowSensorOutOfItsRange) {
  EXPECT_EQ(Run("vehicle: {hexapod: {}}\n", "{position_m: [0, 0, 6]}"), kExitBadInput);
  EXPECT_EQ(message_,
            "s.yaml:7: sensors.optical_flow.position_m: the sensor is 6.085 m or more above the "
            "ground, beyond range_max_m, 5 m\n");
}

}  // namespace
}  // namespace polnav::testbed
