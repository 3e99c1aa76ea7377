// `polnav replay`: exit codes, what goes to which stream, which files appear.
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "tests/testbed/dataset/dataset_files.h"
#include "tests/testbed/temporary_folder.h"
#include "tools/polnav/command_line.h"
#include "tools/testbed/option_tree.h"

namespace polnav::testbed {
namespace {

namespace fs = std::filesystem;

class ReplayCommand : public ::testing::Test {
 protected:
  int Call(std::vector<std::string> more) {
    out_.str("");
    err_.str("");
    more.insert(more.begin(), {"replay", root_.string(), "--out", Out("")});
    return RunCommandLine(more, {out_, err_, false}, {});
  }
  [[nodiscard]] std::string Out(const std::string& name) const {
    return (folder_.path() / "out" / name).string();
  }
  [[nodiscard]] Json Result() const { return Json::parse(std::ifstream(Out("result.json"))); }

  TemporaryFolder folder_;
  fs::path root_ = folder_.path() / "06";
  std::ostringstream out_;
  std::ostringstream err_;
};

TEST_F(ReplayCommand, WritesWhatARunWrites) {
  WriteKitti(root_, 6, true);
  ASSERT_EQ(Call({}), kExitHolds) << err_.str();
  for (const char* name :
       {"result.json", "truth.tum", "stereo.tum", "junit.xml", "report.html", "scenario.yaml"}) {
    EXPECT_TRUE(fs::exists(Out(name))) << name;
  }
  EXPECT_NE(out_.str().find("s replayed in"), std::string::npos);
  const Json result = Result();
  EXPECT_EQ(result["level"], "replay");
  EXPECT_EQ(result["scenario"], "06");
  EXPECT_EQ(result["streams"]["stereo"]["count"], 6);
  // It stands still, and so within the granted start's centimetre it should be found.
  EXPECT_LT(result["estimators"]["stereo"]["position_m"]["max"].get<double>(), 0.1);
  EXPECT_EQ(result["estimators"]["stereo"]["tracked_fraction"], 1.0);
}

// All true poses in one place determine no alignment: then there is none, and none is claimed.
TEST_F(ReplayCommand, TheAlignmentIsSaid) {
  WriteKitti(root_, 6, true);
  ASSERT_EQ(Call({}), kExitHolds);
  EXPECT_NE(out_.str().find("06, seed 1, errors without alignment"), std::string::npos);
  std::string poses;  // on a parabola in the camera's x and z
  for (const char* xz : {"0 0", "0.1 1", "0.4 2", "0.9 3", "1.6 4", "2.5 5"}) {
    const std::string text = xz;
    const std::size_t gap = text.find(' ');
    poses += "1 0 0 " + text.substr(0, gap) + " 0 1 0 0 0 0 1" + text.substr(gap) + "\n";
  }
  WriteText(root_ / "poses.txt", poses);
  ASSERT_EQ(Call({}), kExitHolds);
  EXPECT_NE(out_.str().find("errors after alignment to the truth (se3)"), std::string::npos);
  EXPECT_EQ(Result()["estimators"]["stereo"]["alignment"], "se3");
  EXPECT_TRUE(Result()["estimators"]["stereo"]["nees"].is_null());
  ASSERT_EQ(Call({"--align", "none", "--json"}), kExitHolds);
  EXPECT_FALSE(Result()["estimators"]["stereo"].contains("alignment"));
  EXPECT_TRUE(Result()["estimators"]["stereo"]["nees"].is_object());
  EXPECT_EQ(Json::parse(out_.str()), Result());
  EXPECT_EQ(Call({"--align", "sideways"}), kExitBadInput);
}

TEST_F(ReplayCommand, WithoutTruthThereAreTrajectoriesButNoScores) {
  WriteKitti(root_, 6, false);
  ASSERT_EQ(Call({}), kExitHolds) << err_.str();
  EXPECT_FALSE(fs::exists(Out("truth.tum")));
  EXPECT_TRUE(fs::exists(Out("report.html")));
  const std::string tum = ReadText(Out("stereo.tum"));
  EXPECT_EQ(std::count(tum.begin(), tum.end(), '\n'), 7);  // the header, six poses
  EXPECT_FALSE(Result()["estimators"]["stereo"].contains("position_m"));
  EXPECT_NE(err_.str().find("no truth in the dataset"), std::string::npos);
}

TEST_F(ReplayCommand, ABadFrameIsAWarningAndTheReplayGoesOn) {
  WriteKitti(root_, 6, true);
  fs::remove(root_ / "image_1" / "000003.png");
  ASSERT_EQ(Call({"--quiet"}), kExitHolds);
  EXPECT_EQ(err_.str(), "warning: " + (root_ / "image_1/000003.png").string() +
                            ": no such file; the frame is skipped\n"
                            "warning: 1 frames are skipped\n");
  EXPECT_EQ(Result()["streams"]["stereo"]["count"], 5);
}

TEST_F(ReplayCommand, NoUsableFrameAtAllIsBadInput) {
  WriteKitti(root_, 30, true);
  fs::remove_all(root_ / "image_1");
  EXPECT_EQ(Call({"--quiet"}), kExitBadInput);
  EXPECT_NE(err_.str().find("and 20 frames more"), std::string::npos);
  EXPECT_NE(err_.str().find("not one frame could be used"), std::string::npos);
}

TEST_F(ReplayCommand, WhatCameBeforeABrokenLineIsWritten) {
  WriteKitti(root_, 6, true);
  Replace(root_ / "times.txt", "4.000000e-01", "four tenths");
  EXPECT_EQ(Call({"--quiet"}), kExitBadInput);
  EXPECT_EQ(err_.str(), "polnav: " + (root_ / "times.txt").string() +
                            ":5: expected a time in seconds, got 'four'\n");
  EXPECT_EQ(Result()["streams"]["stereo"]["count"], 4);
}

TEST_F(ReplayCommand, BadInputIsTwoAndLeavesNothing) {
  EXPECT_EQ(Call({}), kExitBadInput);  // no such folder
  WriteKitti(root_, 3, true);
  EXPECT_EQ(Call({"--rig", "/nowhere.yaml"}), kExitBadInput);
  EXPECT_EQ(Call({"--set", "sky.model=berry"}), kExitBadInput);
  EXPECT_EQ(Call({"--estimators", "sterio"}), kExitBadInput);
  EXPECT_NE(err_.str().find("did you mean 'stereo'?"), std::string::npos);
  EXPECT_EQ(Call({"--estimators", "stereo_polarization"}), kExitBadInput);
  EXPECT_EQ(Call({"--seed", "-3"}), kExitBadInput);
  EXPECT_FALSE(fs::exists(Out("")));
}

// The picture at 0.2 s does not arrive.
TEST_F(ReplayCommand, FaultsCanBeLaidOverADataset) {
  WriteKitti(root_, 6, true);
  ASSERT_EQ(Call({"--set", "faults=[{sensor: stereo, start_s: 0.15, duration_s: 0.1, off: {}}]"}),
            kExitHolds)
      << err_.str();
  EXPECT_EQ(Result()["streams"]["stereo"]["count"], 5);
}

}  // namespace
}  // namespace polnav::testbed
