// Without errors the flow is nav/api's formula; with them they are as large as the options say.
#include "sim/sensors/optical_flow.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/sensors/optical_flow_model.h"
#include "tests/sim/sensors/flow_scene.h"

namespace polnav::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

const LevelGround& Ground() {
  static const LevelGround ground;
  return ground;
}

std::vector<nav::OpticalFlowSample> Readings(const OpticalFlowOptions& options,
                                             const GlideMotion& motion, int count,
                                             std::uint64_t trial = 0) {
  OpticalFlow flow(options, Ground().terrain, nullptr, 1, trial);
  OpticalFlowModel model(options, 0.1, 1, trial);
  std::vector<nav::OpticalFlowSample> readings;
  for (const FlowInterval& interval : Intervals(flow, motion, count)) {
    readings.push_back(model.Take(interval));
  }
  return readings;
}

nav::OpticalFlowSample FirstReading(const OpticalFlowOptions& options, const GlideMotion& motion) {
  return Readings(options, motion, 1).front();
}

nav::Pose Above(double height_m, const Vector3d& turn = Vector3d::Zero()) {
  const double angle = turn.norm();
  const Vector3d axis = angle > 0.0 ? Vector3d(turn / angle) : Vector3d::UnitX();
  return {Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis)), {3.0, 40.0, height_m}};
}

// F has x as B, y and z against B's. Over 20 ms the formula holds to the second order of the way.
TEST(OpticalFlow, ForwardsAndSidewaysOverLevelGround) {
  for (const double d : {0.3, 0.4, 1.0, 3.0}) {
    const auto forward = FirstReading(PerfectFlow(), {Above(d), {0.2, 0.0, 0.0}});
    EXPECT_NEAR(forward.flow_rad.x(), 0.0, 1e-6);
    EXPECT_NEAR(forward.flow_rad.y(), 0.2 / d * 0.02, 1e-6);
    const auto left = FirstReading(PerfectFlow(), {Above(d), {0.0, 0.2, 0.0}});  // v_F,y = -0.2
    EXPECT_NEAR(left.flow_rad.x(), 0.2 / d * 0.02, 1e-6);
    EXPECT_NEAR(left.flow_rad.y(), 0.0, 1e-6);
    EXPECT_EQ(left.integration, 20'000'000);
    EXPECT_EQ(left.stamp, 20'000'000);
    EXPECT_EQ(left.quality, 1.0);
  }
}

TEST(OpticalFlow, ATurnReadsItsAngleAndTheGyroscopesTheSame) {
  const auto roll = FirstReading(PerfectFlow(), {Above(0.4), {0, 0, 0}, {0.5, 0.0, 0.0}});
  EXPECT_NEAR(roll.flow_rad.x(), 0.01, 1e-5);
  EXPECT_NEAR(roll.flow_rad.y(), 0.0, 1e-5);
  EXPECT_LT((roll.gyro_rad - Vector3d(0.01, 0.0, 0.0)).norm(), 1e-9);
  const auto pitch = FirstReading(PerfectFlow(), {Above(0.4), {0, 0, 0}, {0.0, 0.5, 0.0}});
  EXPECT_NEAR(pitch.flow_rad.y(), -0.01, 1e-5);  // F's y is to the right
  EXPECT_LT((pitch.gyro_rad - Vector3d(0.0, -0.01, 0.0)).norm(), 1e-9);
  const auto yaw = FirstReading(PerfectFlow(), {Above(0.4), {0, 0, 0}, {0.0, 0.0, 0.5}});
  EXPECT_LT(yaw.flow_rad.norm(), 1e-6);
  EXPECT_LT((yaw.gyro_rad - Vector3d(0.0, 0.0, -0.01)).norm(), 1e-9);
}

// What is left of the flow without the turn is the ground's way over its distance.
TEST(OpticalFlow, LessTheGyroscopesItIsVelocityOverRangeHoweverTilted) {
  const Vector3d v_W(0.15, -0.1, 0.02);
  for (const Vector3d& tilt : {Vector3d(0.1, 0.0, 0.0), Vector3d(-0.05, 0.2, 0.7)}) {
    GlideMotion motion{Above(0.5, tilt), v_W, {0.3, -0.4, 0.2}};
    const auto reading = FirstReading(PerfectFlow(), motion);
    const Truth middle = motion.At(10'000'000);
    const Eigen::Quaterniond q_WF = middle.T_WB.q * NominalOpticalFlow(PerfectFlow()).T_BF.q;
    const Vector3d v_F = q_WF.conjugate() * v_W;
    const double d = middle.T_WB.p.z() / -(q_WF * Vector3d::UnitZ()).z();
    const Vector2d rest = reading.flow_rad - reading.gyro_rad.head<2>();
    EXPECT_NEAR(rest.x(), -v_F.y() / d * 0.02, 2e-6);
    EXPECT_NEAR(rest.y(), v_F.x() / d * 0.02, 2e-6);
  }
}

TEST(OpticalFlow, ALongerLensThanBelievedReadsMore) {
  OpticalFlowOptions options = PerfectFlow();
  options.focal_sigma = 0.05;
  const double scale = DrawTrueFlowCamera(options, 1, 0).focal_px / options.focal_px;
  EXPECT_GT(std::abs(scale - 1.0), 1e-3);
  const auto reading = FirstReading(options, {Above(0.4), {0.2, 0.0, 0.0}});
  EXPECT_NEAR(reading.flow_rad.y(), scale * 0.01, 1e-6);
}

TEST(OpticalFlow, RangeIsAlongTheOpticalAxis) {
  for (const double tilt : {0.0, 0.1, 0.4}) {
    const auto reading = FirstReading(PerfectFlow(), {Above(0.8, {tilt, 0.0, 0.0})});
    ASSERT_TRUE(reading.range_m.has_value());
    EXPECT_NEAR(*reading.range_m, 0.8 / std::cos(tilt), 1e-9);
  }
  EXPECT_FALSE(FirstReading(PerfectFlow(), {Above(0.25)}).range_m.has_value());
  EXPECT_FALSE(FirstReading(PerfectFlow(), {Above(5.5)}).range_m.has_value());
  const auto upwards = FirstReading(PerfectFlow(), {Above(0.8, {M_PI, 0.0, 0.0})});
  EXPECT_FALSE(upwards.range_m.has_value());
  EXPECT_EQ(upwards.quality, 0.0);
  EXPECT_TRUE(upwards.flow_rad.isZero());
  EXPECT_EQ(upwards.integration, 20'000'000);
}

// A binomial of 5000 at 0.1 has a sigma of 0.0042; a variance of 4500 one of 2.1 percent.
TEST(OpticalFlow, EchoesAreLostAndNoisyAsOftenAndAsMuchAsStated) {
  OpticalFlowOptions options = PerfectFlow();
  options.range_dropout_probability = 0.1;
  options.range_sigma_m = 0.01;
  int echoes = 0;
  double squares = 0.0;
  for (const auto& reading : Readings(options, {Above(1.0)}, 5000)) {
    if (!reading.range_m) continue;
    ++echoes;
    squares += (*reading.range_m - 1.0) * (*reading.range_m - 1.0);
  }
  EXPECT_NEAR(echoes / 5000.0, 0.9, 4 * 0.0042);
  EXPECT_NEAR(squares / echoes, 1e-4, 4 * 0.021 * 1e-4);
}

// Bias times time, white noise times its root.
TEST(OpticalFlow, GyroscopesHaveBiasAndNoise) {
  OpticalFlowOptions options = PerfectFlow();
  options.gyro_noise_deg_s_sqrt_hz = 0.05;
  double squares = 0.0;
  const auto readings = Readings(options, {Above(1.0)}, 3000);
  for (const auto& reading : readings) squares += reading.gyro_rad.squaredNorm();
  const double sigma = nav::DegToRad(0.05) * std::sqrt(0.02);
  EXPECT_NEAR(squares / 9000.0, sigma * sigma, 4 * 0.015 * sigma * sigma);
  options = PerfectFlow();
  options.gyro_bias_sigma_deg_s = 1.0;
  const auto biased = Readings(options, {Above(1.0)}, 2);
  EXPECT_GT(biased[0].gyro_rad.norm(), nav::DegToRad(0.1) * 0.02);
  EXPECT_LT((biased[0].gyro_rad - biased[1].gyro_rad).norm(), 1e-12);
}

TEST(OpticalFlow, TooFastIsNotFollowed) {
  // 4.5 px a picture at 250 Hz and 667 px of focal length.
  const double limit_rad_s = 4.5 * 250.0 / PerfectFlow().focal_px;
  EXPECT_EQ(FirstReading(PerfectFlow(), {Above(1.0), {0.98 * limit_rad_s, 0, 0}}).quality, 1.0);
  EXPECT_EQ(FirstReading(PerfectFlow(), {Above(1.0), {1.02 * limit_rad_s, 0, 0}}).quality, 0.0);
}

TEST(OpticalFlow, EstimatorsHearTheDataSheetNotTheUnit) {
  const OpticalFlowOptions options;
  const nav::OpticalFlowCalibration told = NominalOpticalFlow(options);
  EXPECT_EQ(told.T_BF.p, options.position_m);
  EXPECT_LT((told.T_BF.q * Vector3d::UnitZ() + Vector3d::UnitZ()).norm(), 1e-12);
  EXPECT_LT((told.T_BF.q * Vector3d::UnitX() - Vector3d::UnitX()).norm(), 1e-12);
  const TrueFlowCamera one = DrawTrueFlowCamera(options, 1, 0);
  const TrueFlowCamera other = DrawTrueFlowCamera(options, 1, 1);
  EXPECT_GT(one.T_BF.q.angularDistance(told.T_BF.q), 1e-4);
  EXPECT_NE(one.focal_px, other.focal_px);
}

}  // namespace
}  // namespace polnav::sim
