// What `polnav compass` promises: a row an image, numbers only where there are some, exit codes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "sim/sensors/polarization_camera.h"
#include "sky/sun.h"
#include "tests/testbed/temporary_folder.h"
#include "tools/polnav/command_line.h"
#include "tools/testbed/camera_file.h"

namespace polnav::testbed {
namespace {

constexpr double kSunAzimuth_deg = 140.0;
constexpr double kSunElevation_deg = 30.0;

class CompassCommand : public ::testing::Test {
 protected:
  CompassCommand() {
    camera_.width_px = 320;
    camera_.height_px = 256;
    camera_.focal_px = 115.0;
    camera_.lens = "equidistant";
    camera_.bits = 8;
  }

  // Returns the file's name.
  std::string Picture(const std::string& name, double heading_deg) {
    sky::SkyOptions options;
    options.clouds = "clear";
    const sky::WorldSky sky(
        options,
        sky::DirectionEnu(nav::DegToRad(kSunAzimuth_deg), nav::DegToRad(kSunElevation_deg)), 1);
    sim::Truth truth;
    truth.T_WB.q = nav::LevelAttitude(nav::DegToRad(heading_deg));
    return Write(name, sim::PolarizationCamera(camera_, sky, 1, 0).Take(truth, 0).mosaic);
  }
  std::string Write(const std::string& name, const cv::Mat& image) {
    const std::string file = Path(name);
    cv::imwrite(file, image);
    return file;
  }
  [[nodiscard]] std::string Path(const std::string& name) const {
    return (folder_.path() / name).string();
  }

  int Call(std::vector<std::string> arguments) {
    out_.str("");
    err_.str("");
    arguments.insert(arguments.begin(), "compass");
    const ClosedLoop none = [](const Scenario&, const RunOptions&,
                               const std::function<void(double)>&) -> RunRecord { return {}; };
    return RunCommandLine(arguments, {out_, err_, false}, none);
  }
  int CallWithSun(std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), {"--lens", "equidistant", "--focal-px", "115",
                                       "--sun-elevation-deg", "30", "--sun-azimuth-deg", "140"});
    return Call(arguments);
  }

  TemporaryFolder folder_;
  sim::PolarizationCameraOptions camera_;
  std::ostringstream out_;
  std::ostringstream err_;
};

TEST_F(CompassCommand, PrintsARowAnImage) {
  const std::string a = Picture("a.tiff", 75.0);
  const std::string b = Picture("b.png", 290.0);
  ASSERT_EQ(CallWithSun({a, b, "--json"}), kExitHolds) << err_.str();
  const Json rows = Json::parse(out_.str());
  ASSERT_EQ(rows.size(), 2U);
  EXPECT_EQ(rows[0]["status"], "ok");
  // An instrument as it comes: gains of 0.2 per cent and a mounting of 0.05 degrees, three sigma.
  EXPECT_NEAR(rows[0]["heading_deg"].get<double>(), 75.0, 1.0);
  EXPECT_NEAR(rows[1]["heading_deg"].get<double>(), 290.0, 1.0);
  EXPECT_NEAR(rows[1]["axis_deg"].get<double>(), 290.0 - 140.0, 1.0);
  ASSERT_EQ(CallWithSun({a}), kExitHolds);
  EXPECT_EQ(out_.str().substr(0, out_.str().find('\n')),
            "file,status,heading_deg,sigma_deg,axis_deg,dop,used_fraction,ms");
}

// The papers' equations give a heading and its opposite [Fan2020, eq. 19].
TEST_F(CompassCommand, ThePapersMethodsGiveTheHeadingUpToHalfATurn) {
  const std::string a = Picture("a.tiff", 290.0);
  ASSERT_EQ(CallWithSun({a, "--method", "lsq", "--json"}), kExitHolds);
  const Json rows = Json::parse(out_.str());
  EXPECT_EQ(rows[0]["status"], "half turn unknown");
  EXPECT_NEAR(rows[0]["heading_deg"].get<double>(), 290.0 - 180.0, 1.0);
}

TEST_F(CompassCommand, WithoutASunGivesAnAxisAndNoHeading) {
  const std::string a = Picture("a.tiff", 75.0);
  ASSERT_EQ(Call({a, "--lens", "equidistant", "--focal-px", "115", "--json"}), kExitHolds);
  const Json rows = Json::parse(out_.str());
  EXPECT_EQ(rows[0]["status"], "axis");
  EXPECT_TRUE(rows[0]["heading_deg"].is_null());
  EXPECT_NEAR(rows[0]["axis_deg"].get<double>(), 75.0 - 140.0 + 180.0, 1.0);
}

TEST_F(CompassCommand, OneBadImageDoesNotLoseTheOthers) {
  const std::string good = Picture("good.tiff", 10.0);
  const std::string colour = Write("colour.png", cv::Mat(256, 320, CV_8UC3, cv::Scalar(9, 9, 9)));
  const std::string size = Write("size.png", cv::Mat(128, 320, CV_8UC1, cv::Scalar(9)));
  const std::string depth = Write("depth.png", cv::Mat(256, 320, CV_16UC1, cv::Scalar(9)));
  std::ofstream(Path("text.png")) << "no image";
  EXPECT_EQ(CallWithSun({good, colour, size, depth, Path("text.png"), Path("absent.png"), "--csv",
                         Path("rows.csv"), "--json"}),
            kExitBadInput);
  const Json rows = Json::parse(out_.str());
  ASSERT_EQ(rows.size(), 6U);
  EXPECT_EQ(rows[0]["status"], "ok");
  for (std::size_t k = 1; k < 6; ++k) {
    EXPECT_EQ(rows[k]["status"].get<std::string>().substr(0, 9), "bad input") << rows[k].dump();
    EXPECT_TRUE(rows[k]["heading_deg"].is_null());
    EXPECT_TRUE(rows[k]["axis_deg"].is_null());
  }
  std::ifstream csv(Path("rows.csv"));
  std::string line;
  int lines = 0;
  while (std::getline(csv, line)) {
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), 7) << line;
    ++lines;
  }
  EXPECT_EQ(lines, 7);
}

TEST_F(CompassCommand, APictureOfNothingHasNoHeading) {
  const std::string white = Write("white.png", cv::Mat(256, 320, CV_8UC1, cv::Scalar(255)));
  const std::string black = Write("black.png", cv::Mat(256, 320, CV_8UC1, cv::Scalar(0)));
  ASSERT_EQ(CallWithSun({white, black, "--json"}), kExitHolds);
  const Json rows = Json::parse(out_.str());
  EXPECT_EQ(rows[0]["status"], "no heading: saturated");
  EXPECT_EQ(rows[1]["status"], "no heading: too dark");
  EXPECT_TRUE(rows[0]["heading_deg"].is_null() && rows[0]["axis_deg"].is_null());
}

TEST_F(CompassCommand, BadArgumentsAreTwo) {
  const std::string a = Picture("a.tiff", 75.0);
  EXPECT_EQ(Call({}), kExitBadInput);
  EXPECT_EQ(Call({a, "--layout", "0,45,90,135"}), kExitBadInput);
  EXPECT_EQ(Call({a, "--method", "guess"}), kExitBadInput);
  EXPECT_EQ(Call({a, "--lat", "10", "--lon", "20"}), kExitBadInput);
  EXPECT_EQ(Call({a, "--sun-azimuth-deg", "20"}), kExitBadInput);
  EXPECT_EQ(Call({a, "--sun-azimuth-deg", "20", "--sun-elevation-deg", "-5"}), kExitBadInput);
  EXPECT_NE(err_.str().find("below the horizon"), std::string::npos);
  EXPECT_EQ(Call({a, "--lat", "10", "--lon", "20", "--utc", "noon"}), kExitBadInput);
  EXPECT_EQ(Call({a, "--lat", "38", "--lon", "121", "--utc", "2020-11-11T17:00:00Z"}),
            kExitBadInput);  // night
  EXPECT_EQ(Call({a, "--calibration", Path("absent.json")}), kExitBadInput);
  EXPECT_EQ(out_.str(), "");
}

TEST_F(CompassCommand, CalibratesFromATurnAndReadsItsFile) {
  camera_.gain_sigma = 0.01;
  std::vector<std::string> call;
  std::string headings;
  for (int k = 0; k < 9; ++k) {
    call.push_back(Picture("turn" + std::to_string(k) + ".tiff", 40.0 * k));
    headings += (k > 0 ? "," : "") + std::to_string(40 * k);
  }
  const std::string file = Path("camera.json");
  const std::string picture = call[5];
  call.insert(call.end(), {"--calibrate", file, "--headings-deg", headings});
  ASSERT_EQ(CallWithSun(call), kExitHolds) << err_.str();
  EXPECT_NE(out_.str().find("held out"), std::string::npos);
  ASSERT_EQ(CallWithSun({picture, "--json"}), kExitHolds);
  const double before = Json::parse(out_.str())[0]["heading_deg"].get<double>() - 200.0;
  ASSERT_EQ(CallWithSun({picture, "--json", "--calibration", file, "--png", Path("seen.png")}),
            kExitHolds);
  const double after = Json::parse(out_.str())[0]["heading_deg"].get<double>() - 200.0;
  EXPECT_LT(std::abs(after), 0.1);
  EXPECT_LT(std::abs(after), std::abs(before));
  EXPECT_FALSE(cv::imread(Path("seen.png")).empty());
  std::ofstream(file) << "{}";
  EXPECT_EQ(CallWithSun({picture, "--calibration", file}), kExitBadInput);
}

TEST_F(CompassCommand, CalibrationFilesComeBackAsTheyWere) {
  const nav::PolarizationCameraCalibration camera = sim::NominalPolarizationCamera(camera_);
  WriteCameraFile(Path("camera.json"), camera);
  const nav::PolarizationCameraCalibration back = ReadCameraFile(Path("camera.json"));
  EXPECT_EQ(ToJson(back).dump(), ToJson(camera).dump());
}

}  // namespace
}  // namespace polnav::testbed
