// Does the ground truth come out of a run, beside unchanged pictures?
#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <vector>

#include "sim/measurement_stream.h"

namespace polnav::sim {
namespace {

struct Streamed {
  std::vector<cv::Mat> left;
  std::vector<FrameTruth> truth;
};

Streamed StreamOf(bool ground_truth, int render_threads) {
  SimulatorOptions options;
  options.world.plaza = {
      .tree_count = 3, .lamp_count = 3, .parked_car_count = 2, .furniture_count = 3};
  options.sensors.stereo = StereoCameraOptions{
      .width_px = 160, .height_px = 96, .focal_px = 90.0, .ground_truth = ground_truth};
  Streamed streamed;
  MeasurementStream stream(options, {1, 0}, nav::FromSeconds(0.5), render_threads);
  while (const auto item = stream.Next()) {
    if (const auto* truth = std::get_if<FrameTruth>(&*item)) streamed.truth.push_back(*truth);
    const auto* measurement = std::get_if<nav::Measurement>(&*item);
    if (measurement == nullptr) continue;
    if (const auto* pair = std::get_if<nav::StereoImages>(measurement)) {
      streamed.left.push_back(pair->left);
    }
  }
  return streamed;
}

TEST(FrameTruth, ComesForEveryFrameButTheLastAndChangesNoPicture) {
  const Streamed without = StreamOf(false, 1);
  const Streamed one = StreamOf(true, 1);
  const Streamed two = StreamOf(true, 2);
  ASSERT_EQ(without.left.size(), 6U);
  EXPECT_TRUE(without.truth.empty());
  ASSERT_EQ(one.left.size(), 6U);
  ASSERT_EQ(one.truth.size(), 5U);
  ASSERT_EQ(two.truth.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(cv::norm(without.left[i], one.left[i], cv::NORM_INF), 0.0);
    EXPECT_EQ(one.truth[i].index, i);
    EXPECT_EQ(one.truth[i].stamp, static_cast<nav::TimeNs>(i) * 100'000'000);
    EXPECT_EQ(cv::countNonZero(one.truth[i].depth_m != two.truth[i].depth_m), 0);
  }
}

}  // namespace
}  // namespace polnav::sim
