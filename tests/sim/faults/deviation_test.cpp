// Bias, drift and noise move what they are told to move, by what they are told, and nothing else.
#include "sim/faults/deviation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

#include "sim/random.h"

namespace polnav::sim {
namespace {

double One() { return 1.0; }

TEST(Deviation, OfAnImuIsInItsOwnUnits) {
  nav::Measurement m = nav::ImuSample{.stamp = 5, .accel_m_s2 = {0.0, 0.0, 9.8}};
  Deviate({.gyro_deg_s = {180.0, 0.0, -90.0}, .accel_mg = {0.0, 1000.0, 0.0}}, {}, One, m);
  const auto& imu = std::get<nav::ImuSample>(m);
  EXPECT_NEAR(imu.gyro_rad_s.x(), M_PI, 1e-12);
  EXPECT_NEAR(imu.gyro_rad_s.z(), -M_PI / 2.0, 1e-12);
  EXPECT_NEAR(imu.accel_m_s2.y(), 9.80665, 1e-12);  // standard gravity
  EXPECT_EQ(imu.accel_m_s2.z(), 9.8);
  EXPECT_EQ(imu.stamp, 5);
}

TEST(Deviation, OfAPictureChangesACopyOfTheSideNamed) {
  const cv::Mat grey(8, 10, CV_8UC1, cv::Scalar(250));
  nav::Measurement m = nav::StereoImages{.left = grey, .right = grey};
  Deviate({.level = 0.1, .side = "left"}, {}, One, m);
  const auto& pair = std::get<nav::StereoImages>(m);
  EXPECT_EQ(pair.left.at<std::uint8_t>(3, 3), 255);  // 250 + 25.5 stops at white
  EXPECT_EQ(pair.right.at<std::uint8_t>(3, 3), 250);
  EXPECT_EQ(grey.at<std::uint8_t>(3, 3), 250);
}

TEST(Deviation, OfOneChannelLeavesTheOthers) {
  nav::Measurement m = nav::PolarizationSample{.channel = {0.3, 0.3, 0.3, 0.3, 0.3, 0.95}};
  Deviate({.level = 0.1, .channel = 5}, {}, One, m);
  Deviate({.level = 0.1, .channel = 2}, {}, One, m);
  const auto& channel = std::get<nav::PolarizationSample>(m).channel;
  EXPECT_NEAR(channel[2], 0.4, 1e-15);
  EXPECT_EQ(channel[5], 1.0);  // full scale
  EXPECT_EQ(channel[0], 0.3);
}

TEST(Deviation, OfAMosaicFollowsItsCells) {
  nav::Rig rig;
  rig.polarization_camera.emplace();
  rig.polarization_camera->bits = 12;
  nav::Measurement m = nav::PolarizationImage{.mosaic = cv::Mat(4, 4, CV_16UC1, cv::Scalar(1000))};
  Deviate({.level = 0.5, .channel = 2}, rig, One, m);
  const cv::Mat& mosaic = std::get<nav::PolarizationImage>(m).mosaic;
  EXPECT_EQ(mosaic.at<std::uint16_t>(1, 0), 3048);  // 1000 + 4095 / 2, rounded
  EXPECT_EQ(mosaic.at<std::uint16_t>(3, 2), 3048);
  EXPECT_EQ(cv::countNonZero(mosaic == 1000), 12);
}

TEST(Deviation, OfAHeadingTurnsClockwise) {
  nav::Measurement m = nav::ReferencePose{.T_WB = {.q = nav::LevelAttitude(0.2)}};
  Deviate({.position_m = {1.0, 2.0, 3.0}, .heading_deg = 10.0}, {}, One, m);
  const auto& pose = std::get<nav::ReferencePose>(m);
  EXPECT_NEAR(nav::CompassHeading(pose.T_WB.q), 0.2 + nav::DegToRad(10.0), 1e-12);
  EXPECT_EQ(pose.T_WB.p, Eigen::Vector3d(1.0, 2.0, 3.0));
}

TEST(Deviation, OfFlowGrowsWithTheInterval) {
  nav::Measurement m =
      nav::OpticalFlowSample{.integration = nav::kNsPerSecond / 10, .range_m = 2.0};
  Deviate({.gyro_deg_s = {0, 0, 20.0}, .flow_x_deg_s = 10.0, .range_m = -3.0}, {}, One, m);
  const auto& flow = std::get<nav::OpticalFlowSample>(m);
  EXPECT_NEAR(flow.flow_rad.x(), nav::DegToRad(1.0), 1e-12);
  EXPECT_EQ(flow.flow_rad.y(), 0.0);
  EXPECT_NEAR(flow.gyro_rad.z(), nav::DegToRad(2.0), 1e-12);
  EXPECT_EQ(*flow.range_m, 0.0);  // no distance is negative
}

TEST(Deviation, OfAFeatureMovesBothViews) {
  nav::StereoFeatures features;
  features.features = {{.id = 1, .uv_left_px = {10.0, 20.0}, .u_right_px = 8.0}, {.id = 2}};
  nav::Measurement m = features;
  Deviate({.feature_px = {1.0, 2.0, 3.0}}, {}, One, m);
  const auto& moved = std::get<nav::StereoFeatures>(m).features;
  EXPECT_EQ(moved[0].uv_left_px, Eigen::Vector2d(11.0, 22.0));
  EXPECT_EQ(*moved[0].u_right_px, 11.0);
  EXPECT_FALSE(moved[1].u_right_px.has_value());
}

// The variance ratio of n normal draws has a relative sigma of sqrt(2 / n).
TEST(MultiplyNoise, OfAnImuMakesTheSumSoManyTimesAsLarge) {
  nav::Rig rig;
  rig.imu = nav::ImuCalibration{
      .rate_hz = 100.0, .gyro_noise_rad_s_sqrt_hz = 1e-3, .accel_noise_m_s2_sqrt_hz = 2e-3};
  const RandomStream own(1, 0, "own");
  const RandomStream added(1, 0, "added");
  constexpr int kSamples = 20000;
  double gyro = 0.0;
  double accel = 0.0;
  for (int i = 0; i < kSamples; ++i) {
    RandomStream::Sample sensor = own.At(static_cast<std::uint64_t>(i));
    RandomStream::Sample fault = added.At(static_cast<std::uint64_t>(i));
    nav::ImuSample sample;
    for (double& v : sample.gyro_rad_s) v = 1e-2 * sensor.Gaussian();  // 1e-3 sqrt(100)
    for (double& v : sample.accel_m_s2) v = 2e-2 * sensor.Gaussian();
    nav::Measurement m = sample;
    MultiplyNoise(
        3.0, rig, [&] { return fault.Gaussian(); }, m);
    gyro += std::get<nav::ImuSample>(m).gyro_rad_s.squaredNorm();
    accel += std::get<nav::ImuSample>(m).accel_m_s2.squaredNorm();
  }
  const double tolerance = 4.0 * std::sqrt(2.0 / (3.0 * kSamples));
  EXPECT_NEAR(gyro / (3.0 * kSamples) / 1e-4, 9.0, 9.0 * tolerance);
  EXPECT_NEAR(accel / (3.0 * kSamples) / 4e-4, 9.0, 9.0 * tolerance);
}

TEST(MultiplyNoise, OfAMosaicFollowsTheLight) {
  nav::Rig rig;
  rig.polarization_camera.emplace();
  rig.polarization_camera->bits = 12;
  rig.polarization_camera->full_well_e = 10500.0;
  rig.polarization_camera->read_noise_e = 2.5;
  const cv::Mat flat(200, 200, CV_16UC1, cv::Scalar(1000));
  nav::Measurement m = nav::PolarizationImage{.mosaic = flat};
  RandomStream::Sample draw = RandomStream(1, 0, "pixels").At(0);
  MultiplyNoise(
      2.0, rig, [&] { return draw.Gaussian(); }, m);
  cv::Scalar mean;
  cv::Scalar sigma;
  cv::meanStdDev(std::get<nav::PolarizationImage>(m).mosaic, mean, sigma);
  const double electrons = 10500.0 / 4095.0;
  const double own = std::sqrt(1000.0 * electrons + 6.25) / electrons;
  // 40000 pixels; rounding adds a twelfth of a count to a variance of some 1200.
  EXPECT_NEAR(sigma[0] / (std::sqrt(3.0) * own), 1.0, 4.0 / std::sqrt(2.0 * 40000.0) + 1e-4);
  EXPECT_NEAR(mean[0], 1000.0, 4.0 * sigma[0] / 200.0);
}

}  // namespace
}  // namespace polnav::sim
