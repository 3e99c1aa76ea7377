#include "nav/ukf/predict.h"

#include <algorithm>
#include <array>

#include "nav/inertial/options.h"
#include "nav/ukf/sigma_points.h"

namespace polnav::nav::ukf {
namespace {

constexpr double kFlicker_s = 30.0;
constexpr int kCurved = 6;           // attitude and rate
constexpr Eigen::Index kMoved = 9;   // theta, u, p: what an interval changes by more than a factor
constexpr Eigen::Index kLinear = 6;  // of these, what the curved directions leave: u, p
constexpr Eigen::Index kStill = kSize - kMoved;

using Moved = Eigen::Matrix<double, kMoved, 1>;

const Eigen::Vector3d kGravity_W(0.0, 0.0, -kGravity_m_s2);

double Square(double x) { return x * x; }

struct Interval {
  Eigen::Vector3d rate;   // without bias
  Eigen::Vector3d force;  // likewise
  Eigen::Vector3d swing;  // of the force, beside gravity of a level robot
  double gyro_z = 0.0;    // as read
  double h = 0.0;
  Eigen::Quaterniond q;  // before
  Eigen::Vector3d v;
  Eigen::Quaterniond q_next;  // after
  Eigen::Vector3d v_next;
};

// What the accelerometers read too much.
Eigen::Vector3d MisreadForce(const Interval& i, const Error& e) {
  Eigen::Vector3d misread = e.segment<3>(kAccelBias);
  for (Eigen::Index k = 0; k < 3; ++k) misread(k) += e.segment<3>(kAccelSwing + 3 * k).dot(i.swing);
  return misread;
}

// Where a sigma point goes, relative to where the nominal state goes.
Moved Carry(const Interval& i, const Error& e) {
  const Eigen::Vector3d rate =
      i.rate - e.segment<3>(kGyroBias) - i.gyro_z * e.segment<3>(kGyroTurn);
  const Eigen::Quaterniond half_turn = Exp(0.5 * i.h * rate);
  const Eigen::Quaterniond start = Exp(e.segment<3>(kTheta));
  const Eigen::Quaterniond half = start * (i.q * half_turn);
  const Eigen::Vector3d v = start * (i.v + e.segment<3>(kVelocity));
  const Eigen::Vector3d v_next = v + i.h * (half * (i.force - MisreadForce(i, e)) + kGravity_W);
  const Eigen::Vector3d theta = Log(half * half_turn * i.q_next.conjugate());
  Moved moved;
  moved << theta, Exp(-theta) * v_next - i.v_next,
      e.segment<3>(kPosition) + 0.5 * i.h * (v + v_next - i.v - i.v_next);
  return moved;
}

using Rows = Eigen::Matrix<double, kLinear, kSize>;

// What the curved directions leave moves linearly: u' = u - h R df, p' = p + h u - h^2/2 R df with
// the misread force df. Its rows of u and p; theta has no rest, the others stay.
Rows CarryRest(const Columns<kCurved>& columns, const Eigen::Matrix3d& R_half, double h,
               const Eigen::Vector3d& swing, const Covariance& P) {
  const Eigen::Matrix3d by_accel = h * R_half;
  Rows rest = P.middleRows<kLinear>(kVelocity);
  rest.noalias() -= columns.middleRows<kLinear>(kVelocity) * columns.transpose();
  Eigen::Matrix<double, 3, kSize> misread = P.middleRows<3>(kAccelBias);
  Eigen::Matrix<double, 3, kCurved> taken = columns.middleRows<3>(kAccelBias);
  for (Eigen::Index k = 0; k < 3; ++k) {
    misread.row(k).noalias() += swing.transpose() * P.middleRows<3>(kAccelSwing + 3 * k);
    taken.row(k).noalias() += swing.transpose() * columns.middleRows<3>(kAccelSwing + 3 * k);
  }
  misread.noalias() -= taken * columns.transpose();
  const Eigen::Matrix<double, 3, kSize> gained = by_accel * misread;
  rest.bottomRows<3>() += h * rest.topRows<3>() - 0.5 * h * gained;
  rest.topRows<3>() -= gained;
  // The same from the other side.
  Eigen::Matrix<double, kLinear, 3> across = rest.middleCols<3>(kAccelBias);
  for (Eigen::Index k = 0; k < 3; ++k) {
    across.col(k).noalias() += rest.middleCols<3>(kAccelSwing + 3 * k) * swing;
  }
  const Eigen::Matrix<double, kLinear, 3> aside = across * by_accel.transpose();
  rest.middleCols<3>(kPosition) += h * rest.middleCols<3>(kVelocity) - 0.5 * h * aside;
  rest.middleCols<3>(kVelocity) -= aside;
  return rest;
}

void AddNoise(const Interval& i, const ProcessNoise& n, Covariance& P) {
  auto diagonal = P.diagonal();
  diagonal.segment<3>(kTheta).array() += i.h * n.gyro_rad2_s;
  for (Eigen::Index k = 0; k < 3; ++k) {
    P(kVelocity + k, kVelocity + k) += i.h * n.accel_m2_s3;
    P(kPosition + k, kPosition + k) += 0.25 * i.h * i.h * i.h * n.accel_m2_s3;
    P(kPosition + k, kVelocity + k) += 0.5 * i.h * i.h * n.accel_m2_s3;
    P(kVelocity + k, kPosition + k) += 0.5 * i.h * i.h * n.accel_m2_s3;
  }
  diagonal.segment<3>(kGyroBias).array() += i.h * n.gyro_bias_rad2_s3;
  diagonal.segment<3>(kAccelBias).array() += i.h * n.accel_bias_m2_s5;
  diagonal(kTerrain) += n.terrain_m2_m * i.h * i.v.head<2>().norm();
}

// Gauss-Markov of variance 1 [-]: forgets, and keeps its variance.
void Forget(double keep, Index at, State& state) {
  state.slow(at - kNavigation) *= keep;
  state.P.row(at) *= keep;
  state.P.col(at) *= keep;
  state.P(at, at) += 1.0 - keep * keep;
}

// The curved directions: attitude, then rate.
Columns<kCurved> TakeCurved(double gyro_z, const Covariance& P) {
  return TakeColumns<kCurved>({{{kTheta},
                                {kTheta + 1},
                                {kTheta + 2},
                                {kGyroBias, kGyroTurn, gyro_z},
                                {kGyroBias + 1, kGyroTurn + 1, gyro_z},
                                {kGyroBias + 2, kGyroTurn + 2, gyro_z}}},
                              P);
}

// Puts together what the curved directions' points and the rest make of P; returns the mean's
// shift. What an interval does not move keeps its covariance.
Moved Gather(const Interval& i, const Columns<kCurved>& columns, const Rows& rest, Covariance& P) {
  const double spread = std::sqrt(static_cast<double>(kCurved));
  Eigen::Matrix<double, kMoved, kCurved> odd;
  Eigen::Matrix<double, kMoved, kCurved> even;
  for (int k = 0; k < kCurved; ++k) {
    const Error point = spread * columns.col(k);
    const Moved plus = Carry(i, point);
    const Moved minus = Carry(i, -point);
    odd.col(k) = 0.5 / spread * (plus - minus);
    even.col(k) = 0.5 * (plus + minus);
  }
  const Moved mean = even.rowwise().mean();
  const Eigen::Matrix<double, kMoved, kCurved> off = (even.colwise() - mean) / spread;
  Eigen::Matrix<double, kMoved, kMoved> moved = odd * odd.transpose();
  moved.noalias() += off * off.transpose();
  moved.bottomRightCorner<kLinear, kLinear>() += rest.middleCols<kLinear>(kVelocity);
  Eigen::Matrix<double, kMoved, kStill> across = odd * columns.bottomRows<kStill>().transpose();
  across.bottomRows<kLinear>() += rest.rightCols<kStill>();
  P.topLeftCorner<kMoved, kMoved>() = 0.5 * (moved + moved.transpose());
  P.topRightCorner<kMoved, kStill>() = across;
  P.bottomLeftCorner<kStill, kMoved>() = across.transpose();
  return mean;
}

}  // namespace

ProcessNoise NoiseOf(const ImuCalibration& imu, const UkfOptions& options, double sky_time_s) {
  return {.gyro_rad2_s = Square(imu.gyro_noise_rad_s_sqrt_hz),
          .accel_m2_s3 = Square(imu.accel_noise_m_s2_sqrt_hz),
          .gyro_bias_rad2_s3 = Square(imu.gyro_bias_walk_rad_s_sqrt_s) +
                               Square(imu.gyro_bias_instability_rad_s) / kFlicker_s,
          .accel_bias_m2_s5 = Square(imu.accel_bias_walk_m_s2_sqrt_s) +
                              Square(imu.accel_bias_instability_m_s2) / kFlicker_s,
          .terrain_m2_m = Square(options.terrain_sigma_m_sqrt_m),
          .sky_time_s = std::max(sky_time_s, 1e-3)};
}

void Predict(const Eigen::Vector3d& gyro_rad_s, const Eigen::Vector3d& accel_m_s2, double h_s,
             TimeNs stamp, const ProcessNoise& noise, State& state) {
  Interval i{.force = accel_m_s2 - state.accel_bias,
             .gyro_z = gyro_rad_s.z(),
             .h = h_s,
             .q = state.q_WI,
             .v = state.v_WI};
  i.swing = i.force - Eigen::Vector3d(0.0, 0.0, kGravity_m_s2);
  i.rate = gyro_rad_s - state.gyro_bias - gyro_rad_s.z() * state.GyroTurn();
  const Eigen::Quaterniond half_turn = Exp(0.5 * h_s * i.rate);
  const Eigen::Quaterniond half = i.q * half_turn;
  const Eigen::Vector3d acceleration = half * i.force + kGravity_W;
  i.q_next = half * half_turn;
  i.v_next = i.v + h_s * acceleration;

  const Columns<kCurved> columns = TakeCurved(i.gyro_z, state.P);
  const Rows rest = CarryRest(columns, half.toRotationMatrix(), h_s, i.swing, state.P);
  Error shift = Error::Zero();
  shift.head<kMoved>() = Gather(i, columns, rest, state.P);
  AddNoise(i, noise, state.P);

  state.stamp = stamp;
  state.q_WI = i.q_next;
  state.p_WI += 0.5 * h_s * (i.v + i.v_next);
  state.v_WI = i.v_next;
  state.turned_rad += h_s * gyro_rad_s;
  state.gained_m += h_s * (state.gained_m_s + 0.5 * h_s * acceleration);
  state.gained_m_s += h_s * acceleration;
  Move(shift, state);
  const double keep = std::exp(-h_s / noise.sky_time_s);
  Forget(keep, kSkySlow, state);
  Forget(keep, kSkyForeign, state);
}

}  // namespace polnav::nav::ukf
