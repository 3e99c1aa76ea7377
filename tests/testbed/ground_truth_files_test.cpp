#include "tools/testbed/ground_truth_files.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "tests/testbed/temporary_folder.h"
#include "tools/testbed/result.h"

namespace polnav::testbed {
namespace {

sim::FrameTruth SmallTruth() {
  sim::FrameTruth truth{.stamp = 300000000, .index = 3};
  truth.depth_m =
      (cv::Mat_<float>(1, 4) << 2.3456F, 65.0F, 300.0F, std::numeric_limits<float>::infinity());
  truth.instance = (cv::Mat_<std::uint16_t>(1, 4) << 1, 2, 257, 0);
  truth.flow_px = cv::Mat(1, 4, CV_32FC2);
  truth.flow_px.at<cv::Vec2f>(0, 0) = {1.5F, -2.25F};
  truth.flow_px.at<cv::Vec2f>(0, 1) = {std::nanf(""), std::nanf("")};
  truth.flow_px.at<cv::Vec2f>(0, 2) = {0.0F, 0.0F};
  truth.flow_px.at<cv::Vec2f>(0, 3) = {600.0F, 0.0F};  // beyond what the format holds
  truth.moving = (cv::Mat_<std::uint8_t>(1, 4) << 0, 0, 255, 0);
  return truth;
}

TEST(GroundTruthFiles, HoldMillimetresInstancesAndKittisFlow) {
  const TemporaryFolder temporary;
  const std::filesystem::path folder = temporary.path() / "ground_truth";
  {
    GroundTruthFiles files(folder, {});
    files.Write(SmallTruth());
    EXPECT_FALSE(std::filesystem::exists(folder)) << "nothing half done has its name";
    files.Commit();
  }
  const auto read = [&](const std::string& kind) {
    return cv::imread((folder / kind / "000003.png").string(), cv::IMREAD_UNCHANGED);
  };
  const cv::Mat depth = read("depth");
  ASSERT_EQ(depth.type(), CV_16UC1);
  EXPECT_EQ(depth.at<std::uint16_t>(0, 0), 2346);
  EXPECT_EQ(depth.at<std::uint16_t>(0, 1), 65000);
  EXPECT_EQ(depth.at<std::uint16_t>(0, 2), 65535);
  EXPECT_EQ(depth.at<std::uint16_t>(0, 3), 0);
  EXPECT_EQ(read("instance").at<std::uint16_t>(0, 2), 257);
  EXPECT_EQ(read("moving").at<std::uint8_t>(0, 2), 255);
  const cv::Mat flow = read("flow");
  ASSERT_EQ(flow.type(), CV_16UC3);
  EXPECT_EQ(flow.at<cv::Vec3w>(0, 0), cv::Vec3w(1, 32768 - 144, 32768 + 96));
  EXPECT_EQ(flow.at<cv::Vec3w>(0, 1), cv::Vec3w(0, 0, 0));
  EXPECT_EQ(flow.at<cv::Vec3w>(0, 2), cv::Vec3w(1, 32768, 32768));
  EXPECT_EQ(flow.at<cv::Vec3w>(0, 3), cv::Vec3w(0, 0, 0));
}

TEST(GroundTruthFiles, LeaveNothingBehindWithoutCommit) {
  const TemporaryFolder temporary;
  {
    GroundTruthFiles files(temporary.path() / "ground_truth", {});
    files.Write(SmallTruth());
  }
  EXPECT_TRUE(std::filesystem::is_empty(temporary.path()));
}

}  // namespace
}  // namespace polnav::testbed
