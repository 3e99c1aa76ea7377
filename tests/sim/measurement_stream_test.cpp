// What depends on the pictures before it, or on the frame after it, comes out the same whoever
// takes the pictures; and what only looks on changes none of them.
#include "sim/measurement_stream.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <vector>

namespace polnav::sim {
namespace {

struct Streamed {
  std::vector<cv::Mat> left;
  std::vector<FrameTruth> truth;
};

struct Wanted {
  bool auto_exposure = true;
  bool ground_truth = true;
};

// Six frames.
Streamed StreamOf(const Wanted& wanted, int render_threads) {
  SimulatorOptions options;
  options.world.plaza = {
      .tree_count = 3, .lamp_count = 3, .parked_car_count = 2, .furniture_count = 3};
  options.sensors.stereo = StereoCameraOptions{.width_px = 160,
                                               .height_px = 96,
                                               .focal_px = 90.0,
                                               .auto_exposure = wanted.auto_exposure,
                                               .ground_truth = wanted.ground_truth};
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

// CTest runs the suite in one process: it shares this one.
const Streamed& InOneThread() {
  static const Streamed streamed = StreamOf({}, 1);
  return streamed;
}

bool Same(const std::vector<cv::Mat>& a, const std::vector<cv::Mat>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const cv::Mat& x, const cv::Mat& y) {
    return cv::norm(x, y, cv::NORM_INF) == 0.0;
  });
}

TEST(MeasurementStream, TruthComesForEveryFrameButTheLast) {
  const Streamed& streamed = InOneThread();
  ASSERT_EQ(streamed.left.size(), 6U);
  ASSERT_EQ(streamed.truth.size(), 5U);
  for (std::size_t i = 0; i < 5; ++i) {
    EXPECT_EQ(streamed.truth[i].index, i);
    EXPECT_EQ(streamed.truth[i].stamp, static_cast<nav::TimeNs>(i) * 100'000'000);
  }
}

// The exposure of a picture depends on those before it.
TEST(MeasurementStream, ExposureAndTruthAreTheSameWithOneAndTwoRenderThreads) {
  const Streamed& one = InOneThread();
  const Streamed two = StreamOf({}, 2);
  EXPECT_TRUE(Same(one.left, two.left));
  ASSERT_EQ(one.truth.size(), two.truth.size());
  for (std::size_t i = 0; i < one.truth.size(); ++i) {
    EXPECT_EQ(cv::countNonZero(one.truth[i].depth_m != two.truth[i].depth_m), 0) << i;
  }
}

TEST(MeasurementStream, TruthChangesNoPictureAndTheExposureIsItsOwn) {
  const Streamed without = StreamOf({.ground_truth = false}, 1);
  EXPECT_TRUE(without.truth.empty());
  EXPECT_TRUE(Same(InOneThread().left, without.left));
  const Streamed fixed = StreamOf({.auto_exposure = false, .ground_truth = false}, 1);
  EXPECT_FALSE(Same(without.left, fixed.left));
}

}  // namespace
}  // namespace polnav::sim
