// The command line's promises: exit codes, what goes to which stream, which files appear. The
// closed loop is the example's.
#include "tools/polnav/command_line.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <sstream>

#include "tests/testbed/example_run.h"
#include "tests/testbed/temporary_folder.h"
#include "tools/testbed/option_tree.h"

namespace polnav::testbed {
namespace {

class CommandLine : public ::testing::Test {
 protected:
  CommandLine() { std::ofstream(scenario_) << ExampleScenarioYaml(); }

  int Call(const std::vector<std::string>& arguments, const ClosedLoop& loop = ExampleRun) {
    out_.str("");
    err_.str("");
    return RunCommandLine(arguments, {out_, err_, false}, loop);
  }
  int CallRun(std::vector<std::string> more, const ClosedLoop& loop = ExampleRun) {
    more.insert(more.begin(), {"run", scenario_, "--out", Out("")});
    return Call(more, loop);
  }
  [[nodiscard]] std::string Out(const std::string& name) const {
    return (folder_.path() / "out" / name).string();
  }
  [[nodiscard]] Json Result() const { return Json::parse(std::ifstream(Out("result.json"))); }

  TemporaryFolder folder_;
  std::string scenario_ = (folder_.path() / "example.yaml").string();
  std::ostringstream out_;
  std::ostringstream err_;
};

TEST_F(CommandLine, ARunWritesItsFilesAndPrintsItsTable) {
  EXPECT_EQ(CallRun({}), kExitHolds) << err_.str();
  for (const char* name : {"result.json", "truth.tum", "stereo.tum", "stereo_polarization.tum",
                           "junit.xml", "report.html", "scenario.yaml"}) {
    EXPECT_TRUE(std::filesystem::exists(Out(name))) << name;
  }
  EXPECT_NE(out_.str().find("Chu2021: stereo SLAM"), std::string::npos);
  EXPECT_NE(out_.str().find("PASS  the sky helps"), std::string::npos);
  EXPECT_NE(out_.str().find("report.html"), std::string::npos);
  EXPECT_NE(err_.str().find("example: 50 %"), std::string::npos);
  EXPECT_EQ(Result()["seed"], 42);
}

TEST_F(CommandLine, AFailedCriterionIsOne) {
  EXPECT_EQ(CallRun({"--set", "criteria.0.at_most=0.1", "--quiet"}), kExitCriterionFailed);
  EXPECT_EQ(out_.str(), "");
  EXPECT_EQ(err_.str().substr(0, 24), "  FAIL  heading is good:");
  EXPECT_EQ(Result()["criteria"][0]["passed"], false);
}

TEST_F(CommandLine, BadInputIsTwoAndLeavesNothing) {
  EXPECT_EQ(CallRun({"--set", "sky.modle=berry"}), kExitBadInput);
  EXPECT_EQ(err_.str(),
            "polnav: --set sky.modle=berry: sky.modle: unknown key; did you mean 'model'?\n");
  EXPECT_FALSE(std::filesystem::exists(Out("")));
  EXPECT_EQ(Call({"run", "/nowhere.yaml"}), kExitBadInput);
  EXPECT_EQ(err_.str(), "polnav: /nowhere.yaml: no such file\n");
  EXPECT_EQ(CallRun({"--duration", "1.0001"}), kExitBadInput);
  EXPECT_EQ(err_.str().substr(0, 27), "polnav: --duration 1.0001: ");
  EXPECT_EQ(Call({"run", scenario_, "--out", "/proc/polnav"}), kExitBadInput);
}

TEST_F(CommandLine, TheLevelReachesTheLoopAndTheResult) {
  sim::Level level = sim::Level::kImage;
  const ClosedLoop look = [&](const Scenario& scenario, const RunOptions& options,
                              const std::function<void(double)>& progress) {
    level = options.level;
    return ExampleRun(scenario, options, progress);
  };
  EXPECT_EQ(CallRun({"--level", "measurement"}, look), kExitHolds) << err_.str();
  EXPECT_EQ(level, sim::Level::kMeasurement);
  EXPECT_EQ(Result()["level"], "measurement");
  EXPECT_EQ(CallRun({}, look), kExitHolds);
  EXPECT_EQ(level, sim::Level::kImage);
  EXPECT_EQ(Result()["level"], "image");
}

TEST_F(CommandLine, WhatOnlyPicturesHaveIsBadInputAtMeasurementLevel) {
  EXPECT_EQ(CallRun({"--level", "measurement", "--set", "sensors.stereo.ground_truth=true"}),
            kExitBadInput);
  EXPECT_EQ(err_.str(),
            "polnav: --set sensors.stereo.ground_truth=true: sensors.stereo.ground_truth: depth "
            "and flow belong to pictures, and --level measurement draws none\n");
}

TEST_F(CommandLine, WrongUsageIsTwo) {
  EXPECT_EQ(Call({}), kExitBadInput);
  EXPECT_EQ(Call({"fly"}), kExitBadInput);
  EXPECT_EQ(Call({"run"}), kExitBadInput);
  EXPECT_EQ(CallRun({"--sed", "3"}), kExitBadInput);
  EXPECT_EQ(CallRun({"--seed", "-3"}), kExitBadInput);
  EXPECT_EQ(CallRun({"--level", "guess"}), kExitBadInput);
  EXPECT_EQ(CallRun({"--render-threads", "0"}), kExitBadInput);
  EXPECT_EQ(out_.str(), "");
}

TEST_F(CommandLine, ACrashIsThreeAndLeavesNoResult) {
  const ClosedLoop crash = [](const Scenario&, const RunOptions&,
                              const std::function<void(double)>&) -> RunRecord {
    throw std::runtime_error("the wheel came off");
  };
  EXPECT_EQ(CallRun({}, crash), kExitCrash);
  EXPECT_NE(err_.str().find("internal error: the wheel came off"), std::string::npos);
  EXPECT_TRUE(std::filesystem::is_empty(Out("")));
}

TEST_F(CommandLine, JsonIsResultJsonAndNothingElse) {
  EXPECT_EQ(CallRun({"--json", "--quiet", "--seed", "7"}), kExitHolds);
  EXPECT_EQ(err_.str(), "");
  EXPECT_EQ(Json::parse(out_.str()), Result());
  EXPECT_EQ(Result()["seed"], 7);
  EXPECT_EQ(Result()["streams"]["imu"]["count"], 6007);  // the loop was given the seed
}

TEST_F(CommandLine, TheRunIsToldWhereToRecord) {
  std::filesystem::path told = "untouched";
  const ClosedLoop loop = [&](const Scenario& scenario, const RunOptions& options,
                              const std::function<void(double)>& progress) {
    told = options.record_folder;
    return ExampleRun(scenario, options, progress);
  };
  EXPECT_EQ(CallRun({"--record", "/data/laps"}, loop), kExitHolds);
  EXPECT_EQ(told, "/data/laps");
  EXPECT_EQ(CallRun({}, loop), kExitHolds);
  EXPECT_EQ(told, "");
}

TEST_F(CommandLine, EstimatorsCanBeLeftOut) {
  EXPECT_EQ(CallRun({"--estimators", "stereo"}), kExitHolds);
  EXPECT_FALSE(std::filesystem::exists(Out("stereo_polarization.tum")));
  EXPECT_NE(out_.str().find("SKIP  the sky helps"), std::string::npos);
  EXPECT_TRUE(Result()["criteria"][0]["passed"].is_null());
}

TEST_F(CommandLine, OptionsMayStandBeforeTheScenario) {
  EXPECT_EQ(Call({"run", "--set", "seed=3", "--set", "duration_s=5", "--out", Out(""), scenario_}),
            kExitHolds);
  EXPECT_EQ(Result()["seed"], 3);
  EXPECT_EQ(Result()["sim_duration_s"], 5.0);
}

TEST_F(CommandLine, EvaluateComparesTheFilesOfARun) {
  ASSERT_EQ(CallRun({}), kExitHolds);
  ASSERT_EQ(Call({"evaluate", Out("truth.tum"), Out("stereo.tum"), "--json"}), kExitHolds);
  const Json plain = Json::parse(out_.str());
  EXPECT_NEAR(plain["ate_m"]["rmse"].get<double>(), 0.5, 1e-9);
  EXPECT_NEAR(plain["heading_deg"]["mean"].get<double>(), 2.0, 1e-9);
  ASSERT_EQ(Call({"evaluate", Out("truth.tum"), Out("stereo.tum"), "--json", "--align", "se3"}),
            kExitHolds);
  EXPECT_NEAR(Json::parse(out_.str())["ate_m"]["rmse"].get<double>(), 0.0, 1e-9);
  EXPECT_EQ(Call({"evaluate", Out("truth.tum"), Out("stereo.tum")}), kExitHolds);
  EXPECT_NE(out_.str().find("ATE [m]"), std::string::npos);
  EXPECT_EQ(Call({"evaluate", Out("truth.tum"), scenario_}), kExitBadInput);
}

TEST_F(CommandLine, ListsAndDescribesItself) {
  EXPECT_EQ(Call({"list"}), kExitHolds);
  EXPECT_NE(out_.str().find("stereo_polarization"), std::string::npos);
  EXPECT_NE(out_.str().find("estimators.<name>.heading_deg.rmse"), std::string::npos);
  EXPECT_NE(out_.str().find("studies/smoke.yaml\n      Six short drives"), std::string::npos);
  EXPECT_EQ(Call({"list", "--study-schema"}), kExitHolds);
  const Json study = Json::parse(out_.str());
  EXPECT_EQ(study["title"], "Polnav study");
  EXPECT_TRUE(study["properties"]["stop"]["items"]["properties"].contains("half_width"));
  EXPECT_EQ(Call({"list", "--schema"}), kExitHolds);
  EXPECT_EQ(Json::parse(out_.str())["properties"]["sky"]["type"], "object");
  EXPECT_EQ(Call({"--version"}), kExitHolds);
  EXPECT_EQ(out_.str().substr(0, 7), "Polnav ");
  EXPECT_EQ(Call({"--print-options"}), kExitHolds);
  EXPECT_NE(out_.str().find("sky.max_dop"), std::string::npos);
  EXPECT_EQ(Call({"--help"}), kExitHolds);
}

}  // namespace
}  // namespace polnav::testbed
