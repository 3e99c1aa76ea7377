// What `polnav sky` promises: its columns, its pictures, and what it says of bad input.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <opencv2/imgcodecs.hpp>
#include <sstream>

#include "tests/testbed/example_run.h"
#include "tests/testbed/temporary_folder.h"
#include "tools/polnav/command_line.h"

namespace polnav::testbed {
namespace {

class SkyCommand : public ::testing::Test {
 protected:
  int Call(std::vector<std::string> arguments) {
    out_.str("");
    err_.str("");
    arguments.insert(arguments.begin(), "sky");
    return RunCommandLine(arguments, {out_, err_, false}, ExampleRun);
  }
  int CallAtSun(double elevation_deg, std::vector<std::string> more) {
    more.insert(more.begin(),
                {"--sun-elevation-deg", std::to_string(elevation_deg), "--sun-azimuth-deg", "40"});
    return Call(more);
  }
  std::string File(const std::string& name, const std::string& text = "") const {
    const std::string path = (folder_.path() / name).string();
    if (!text.empty()) std::ofstream(path) << text;
    return path;
  }

  TemporaryFolder folder_;
  std::ostringstream out_;
  std::ostringstream err_;
};

// NREL's example [Reda2008], whose azimuth lacks 1e-4 degrees of diurnal aberration.
TEST_F(SkyCommand, FindsTheSun) {
  EXPECT_EQ(Call({"--lat", "39.742476", "--lon", "-105.1786", "--utc", "2003-10-17T19:30:30Z"}),
            kExitHolds)
      << err_.str();
  EXPECT_NE(out_.str().find("azimuth 194.340"), std::string::npos) << out_.str();
  EXPECT_NE(out_.str().find("39.872"), std::string::npos);
  EXPECT_NE(out_.str().find("Babinet"), std::string::npos);
}

// Rayleigh 90 degrees across from a sun of 30, seen 60 high: DoP 0.684211, angle -66.1021 from the
// map's axis, that is 23.8979 - 40 from the vertical plane at azimuth 130.
TEST_F(SkyCommand, AnswersAlongDirections) {
  const std::string file = File("d.csv", "azimuth_deg,elevation_deg\n# a comment\n40,90\n130,60\n");
  EXPECT_EQ(CallAtSun(30.0, {"--model", "rayleigh", "--max-dop", "1", "--directions", file}),
            kExitHolds)
      << err_.str();
  std::istringstream lines(out_.str());
  std::string header, zenith, side;
  std::getline(lines, header);
  std::getline(lines, zenith);
  std::getline(lines, side);
  EXPECT_EQ(header, "azimuth_deg,elevation_deg,I,Q,U,dop,aop_deg");
  double azimuth, elevation, i, q, u, dop, aop;
  char comma;
  std::istringstream(side) >> azimuth >> comma >> elevation >> comma >> i >> comma >> q >> comma >>
      u >> comma >> dop >> comma >> aop;
  EXPECT_NEAR(dop, 0.684211, 1e-6);
  EXPECT_NEAR(std::hypot(q, u) / i, dop, 1e-7);
  EXPECT_NEAR(aop, -16.1021, 1e-4);
  std::istringstream(zenith) >> azimuth >> comma >> elevation >> comma >> i >> comma >> q;
  EXPECT_NEAR(i, 1.0, 1e-6);
  EXPECT_NEAR(q, -0.6, 1e-6);  // across the sun's vertical plane
}

TEST_F(SkyCommand, WritesATableAndAPicture) {
  const std::string csv = File("sky.csv");
  const std::string png = File("sky.png");
  EXPECT_EQ(CallAtSun(20.0, {"--csv", csv, "--png", png, "--aot", "0.2"}), kExitHolds)
      << err_.str();
  std::ifstream stream(csv);
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 36 * 72 + 1);
  const cv::Mat image = cv::imread(png);
  ASSERT_FALSE(image.empty());
  EXPECT_GT(image.cols, 1000);
  cv::Scalar mean, deviation;
  cv::meanStdDev(image, mean, deviation);
  EXPECT_GT(deviation[0], 20.0);  // something is drawn
}

TEST_F(SkyCommand, BadInputIsTwoAndSaysWhat) {
  const auto expect = [&](int code, const std::string& said) {
    EXPECT_EQ(code, kExitBadInput);
    EXPECT_NE(err_.str().find(said), std::string::npos) << err_.str() << " lacks " << said;
    EXPECT_EQ(out_.str(), "");
  };
  expect(Call({}), "where is the sun?");
  expect(Call({"--lat", "38", "--lon", "121"}), "--utc is missing");
  expect(Call({"--lat", "38", "--lon", "121", "--utc", "yesterday"}), "'yesterday' is no time");
  expect(Call({"--lat", "98", "--lon", "121", "--utc", "2020-11-11T07:00:00Z"}), "--lat: 98");
  expect(Call({"--lat", "38", "--lon", "121", "--utc", "2020-11-11T16:00:00Z"}),
         "the sun is below the horizon");
  expect(CallAtSun(-1.0, {}), "the sun is below the horizon");
  expect(CallAtSun(30.0, {"--aot", "7"}), "--aot: 7");
  expect(CallAtSun(30.0, {"--wavelength-nm", "nan"}), "--wavelength-nm");
  expect(CallAtSun(30.0, {"--lat", "38"}), "not both");
  expect(CallAtSun(30.0, {"--model", "perez"}), "perez");
  expect(CallAtSun(30.0, {"--directions", File("none.csv")}), "cannot be read");
  expect(CallAtSun(30.0, {"--directions", File("x.csv", "azimuth_deg,elevation_deg\n1,2\n3;4\n")}),
         "x.csv:3");
  expect(CallAtSun(30.0, {"--directions", File("y.csv", "1,-2\n")}), "y.csv:1");
  expect(CallAtSun(30.0, {"--directions", File("z.csv", "# nothing\n")}), "no direction");
  expect(CallAtSun(30.0, {"--csv", folder_.path().string()}), "is a folder");
}

// A number that is out of range in the last line leaves no file behind.
TEST_F(SkyCommand, LeavesNothingHalfWritten) {
  const std::string csv = File("out.csv");
  EXPECT_EQ(CallAtSun(30.0, {"--csv", csv, "--directions", File("d.csv", "1,2\n3,99\n")}),
            kExitBadInput);
  EXPECT_FALSE(std::filesystem::exists(csv));
}

TEST_F(SkyCommand, SaysWhatAModelDoesNotHear) {
  EXPECT_EQ(CallAtSun(30.0, {"--model", "hazy", "--max-dop", "0.5"}), kExitHolds);
  EXPECT_NE(err_.str().find("--max-dop says nothing to hazy"), std::string::npos);
}

}  // namespace
}  // namespace polnav::testbed
