#include "nav/inertial/inertial_edge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "nav/stereo/reprojection.h"

namespace polnav::nav {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;
using Vector9d = Eigen::Matrix<double, 9, 1>;

constexpr double kStep = 1e-6;
constexpr double kRate_hz = 100.0;

ImuNoise TestNoise() {
  return {.gyro_rad_s_sqrt_hz = 1e-4,
          .accel_m_s2_sqrt_hz = 1e-3,
          .share_of_rate = 0.0,
          .gyro_bias_rad_s = 1e-2,
          .accel_bias_m_s2 = 0.1,
          .gyro_walk_rad_s_sqrt_s = 1e-5,
          .accel_walk_m_s2_sqrt_s = 1e-4};
}

// A vehicle that turns, climbs and speeds up: analytic, so that means over an interval are exact
// differences.
struct Drive {
  static Eigen::Vector3d Position(double t) {
    return {20.0 * std::sin(0.3 * t), 20.0 - 20.0 * std::cos(0.3 * t), 0.4 * std::sin(0.9 * t)};
  }
  static Eigen::Vector3d Velocity(double t) {
    return {6.0 * std::cos(0.3 * t), 6.0 * std::sin(0.3 * t), 0.36 * std::cos(0.9 * t)};
  }
  static Eigen::Quaterniond Attitude(double t) {
    return ExpRotation({0.0, 0.0, 0.3 * t}) * ExpRotation({0.05 * std::sin(2.0 * t), 0.0, 0.0}) *
           ExpRotation({0.0, 0.03 * std::cos(1.5 * t), 0.0});
  }
};

// What an IMU at T_BI says over the interval that ends at t.
ImuSample SampleAt(double t, const Pose& T_BI, const Motion& bias) {
  const double h = 1.0 / kRate_hz;
  const auto attitude = [&](double s) { return Drive::Attitude(s) * T_BI.q; };
  const auto velocity = [&](double s) {
    // The lever arm's share by a central difference, exact to 1e-10 m/s.
    const Eigen::Vector3d arm_rate =
        (Drive::Attitude(s + 1e-4) * T_BI.p - Drive::Attitude(s - 1e-4) * T_BI.p) / 2e-4;
    return Eigen::Vector3d(Drive::Velocity(s) + arm_rate);
  };
  ImuSample sample{.stamp = FromSeconds(t)};
  const Eigen::Vector3d turn = LogRotation(attitude(t - h).conjugate() * attitude(t));
  sample.gyro_rad_s = turn / h + bias.gyro_bias;
  const Eigen::Quaterniond half_way = attitude(t - h) * ExpRotation(0.5 * turn);
  const Eigen::Vector3d a = (velocity(t) - velocity(t - h)) / h;
  sample.accel_m_s2 =
      half_way.conjugate() * (a + Eigen::Vector3d(0.0, 0.0, kGravity_m_s2)) + bias.accel_bias;
  return sample;
}

Preintegration SumOver(double from, double to, const Pose& T_BI, const Motion& bias,
                       const Motion& believed) {
  Preintegration sum{.gyro_bias = believed.gyro_bias, .accel_bias = believed.accel_bias};
  const int steps = static_cast<int>(std::lround((to - from) * kRate_hz));
  for (int i = 1; i <= steps; ++i) {
    const ImuSample s = SampleAt(from + i / kRate_hz, T_BI, bias);
    sum.Add(s.gyro_rad_s, s.accel_m_s2, 1.0 / kRate_hz, TestNoise());
  }
  return sum;
}

Pose PoseAt(double t) { return {Drive::Attitude(t), Drive::Position(t)}; }

Motion MotionAt(double t, const Pose& T_BI, const Motion& bias) {
  Motion m = bias;
  m.v_WI = Drive::Velocity(t) +
           (Drive::Attitude(t + 1e-4) * T_BI.p - Drive::Attitude(t - 1e-4) * T_BI.p) / 2e-4;
  return m;
}

Motion Perturbed(Motion motion, const Vector9d& d) {
  motion.v_WI += d.head<3>();
  motion.gyro_bias += d.segment<3>(3);
  motion.accel_bias += d.tail<3>();
  return motion;
}

class InertialEdgeTest : public ::testing::Test {
 protected:
  Pose T_BI_{ExpRotation({0.1, -0.2, 0.3}), {0.4, -0.1, 0.6}};
  Motion bias_{.gyro_bias = {0.004, -0.003, 0.002}, .accel_bias = {0.05, -0.02, 0.03}};
  Pose pose_i_ = PoseAt(1.0);
  Pose pose_j_ = PoseAt(1.5);
  Motion motion_i_ = MotionAt(1.0, T_BI_, bias_);
  Motion motion_j_ = MotionAt(1.5, T_BI_, bias_);
};

TEST_F(InertialEdgeTest, IsZeroOnTheTrueDrive) {
  const Preintegration sum = SumOver(1.0, 1.5, T_BI_, bias_, bias_);
  InertialEdge edge = MakeInertialEdge(sum, {1e-5, 1e-4}, T_BI_);
  edge.weight.setIdentity();
  const Vector15d r = EvaluateInertial(edge, pose_i_, motion_i_, pose_j_, motion_j_).residual;
  EXPECT_LT(r.head<3>().norm(), 1e-9);
  EXPECT_LT(r.segment<3>(3).norm(), 1e-6);
  // The trapezoid rule: h^2/12 times the change of acceleration, some 0.3 m/s^2.
  EXPECT_LT(r.segment<3>(6).norm(), 1e-5);
}

// Biases 0.1 deg/s and 2 mg off where the sums are linearized: second order is 1e-6.
TEST_F(InertialEdgeTest, ABetterBiasNeedsNoNewSum) {
  Motion believed = bias_;
  believed.gyro_bias += Eigen::Vector3d(0.0017, -0.001, 0.0012);
  believed.accel_bias += Eigen::Vector3d(-0.02, 0.015, 0.02);
  InertialEdge edge =
      MakeInertialEdge(SumOver(1.0, 1.5, T_BI_, bias_, believed), {1e-5, 1e-4}, T_BI_);
  edge.weight.setIdentity();
  const Vector15d r = EvaluateInertial(edge, pose_i_, motion_i_, pose_j_, motion_j_).residual;
  EXPECT_LT(r.head<9>().norm(), 2e-5);
}

TEST_F(InertialEdgeTest, JacobiansAgreeWithFiniteDifferences) {
  Motion believed = bias_;
  believed.gyro_bias += Eigen::Vector3d(0.0017, -0.001, 0.0012);
  InertialEdge edge =
      MakeInertialEdge(SumOver(1.0, 1.5, T_BI_, bias_, believed), {1e-3, 1e-2}, T_BI_);
  edge.weight = Matrix9d(Vector9d::LinSpaced(1.0, 3.0).asDiagonal());
  edge.weight(4, 1) = 0.5;
  // Off the true drive, so that no residual is near zero.
  pose_j_ = Perturb(pose_j_, (Vector6d() << 0.3, -0.2, 0.1, 0.05, -0.04, 0.1).finished());
  motion_j_.v_WI += Eigen::Vector3d(0.2, 0.1, -0.3);
  const auto residual = [&](const Vector6d& pi, const Vector9d& mi, const Vector6d& pj,
                            const Vector9d& mj) {
    return EvaluateInertial(edge, Perturb(pose_i_, pi), Perturbed(motion_i_, mi),
                            Perturb(pose_j_, pj), Perturbed(motion_j_, mj))
        .residual;
  };
  const InertialResidual e = EvaluateInertial(edge, pose_i_, motion_i_, pose_j_, motion_j_);
  const Vector6d p0 = Vector6d::Zero();
  const Vector9d m0 = Vector9d::Zero();
  for (int k = 0; k < 6; ++k) {
    const Vector6d d = kStep * Vector6d::Unit(k);
    const Vector15d by_i = (residual(d, m0, p0, m0) - residual(-d, m0, p0, m0)) / (2.0 * kStep);
    const Vector15d by_j = (residual(p0, m0, d, m0) - residual(p0, m0, -d, m0)) / (2.0 * kStep);
    EXPECT_LT((by_i - e.by_pose_i.col(k)).norm(), 1e-6) << k;
    EXPECT_LT((by_j - e.by_pose_j.col(k)).norm(), 1e-6) << k;
  }
  for (int k = 0; k < 9; ++k) {
    const Vector9d d = kStep * Vector9d::Unit(k);
    const Vector15d by_i = (residual(p0, d, p0, m0) - residual(p0, -d, p0, m0)) / (2.0 * kStep);
    const Vector15d by_j = (residual(p0, m0, p0, d) - residual(p0, m0, p0, -d)) / (2.0 * kStep);
    EXPECT_LT((by_i - e.by_motion_i.col(k)).norm(), 1e-6) << k;
    EXPECT_LT((by_j - e.by_motion_j.col(k)).norm(), 1e-6) << k;
  }
}

TEST_F(InertialEdgeTest, PredictsTheNextFrame) {
  const Preintegration sum = SumOver(1.0, 1.5, T_BI_, bias_, bias_);
  const InertialPrediction p = Predict(sum, T_BI_, pose_i_, motion_i_, Matrix15d::Identity());
  EXPECT_LT((p.T_WB.p - pose_j_.p).norm(), 1e-5);
  EXPECT_LT(p.T_WB.q.angularDistance(pose_j_.q), 1e-8);
  EXPECT_LT((p.v_WI - motion_j_.v_WI).norm(), 1e-6);
}

// Against 20 000 draws of white noise: the sample variance of each of the nine is then within 4 %
// (four sigmas, sqrt(2 / 20000) each) of the true one.
TEST_F(InertialEdgeTest, CovarianceIsThatOfTheNoise) {
  const Preintegration exact = SumOver(1.0, 1.2, T_BI_, bias_, bias_);
  const ImuNoise noise = TestNoise();
  std::mt19937 random(3);
  std::normal_distribution<double> gauss;
  const auto white = [&](double density) {
    const double sigma = density * std::sqrt(kRate_hz);
    return Eigen::Vector3d(sigma * gauss(random), sigma * gauss(random), sigma * gauss(random));
  };
  std::vector<ImuSample> samples;
  for (int i = 1; i <= 20; ++i) samples.push_back(SampleAt(1.0 + i / kRate_hz, T_BI_, bias_));
  constexpr int kDraws = 20000;
  Vector9d variance = Vector9d::Zero();
  for (int d = 0; d < kDraws; ++d) {
    Preintegration sum{.gyro_bias = bias_.gyro_bias, .accel_bias = bias_.accel_bias};
    for (const ImuSample& s : samples) {
      sum.Add(s.gyro_rad_s + white(noise.gyro_rad_s_sqrt_hz),
              s.accel_m_s2 + white(noise.accel_m_s2_sqrt_hz), 1.0 / kRate_hz, noise);
    }
    Vector9d error;
    error << LogRotation(exact.dq.conjugate() * sum.dq), sum.dv - exact.dv, sum.dp - exact.dp;
    variance += error.cwiseAbs2() / kDraws;
  }
  const Vector9d claimed = exact.covariance.diagonal();
  for (int k = 0; k < 6; ++k) EXPECT_NEAR(variance(k) / claimed(k), 1.0, 0.04) << k;
  // Position: a mean over an interval does not say when in it the force came; the claim is for
  // continuous noise, 1 + 1 / (4 n^2) of what n means give.
  for (int k = 6; k < 9; ++k) EXPECT_NEAR(variance(k) / claimed(k), 1.0, 0.04) << k;
}

}  // namespace
}  // namespace polnav::nav
