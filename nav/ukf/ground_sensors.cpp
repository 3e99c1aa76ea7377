#include "nav/ukf/ground_sensors.h"

#include <algorithm>
#include <cmath>

#include "nav/inertial/options.h"

namespace polnav::nav::ukf {
namespace {

constexpr double kNearest_m = 0.02;   // a sigma point may fall through the ground
constexpr double kFlattest = 0.1;     // sine of the optical axis below the horizon
constexpr double kKnownHeight = 0.3;  // one sigma, as a share of the height

double Square(double x) { return x * x; }

// Sine of the optical axis below the horizon.
double Down(const Eigen::Quaterniond& q_WF) {
  return std::max(-(q_WF * Eigen::Vector3d::UnitZ()).z(), kFlattest);
}

// Of the nominal state moved by an error.
struct Motion {
  Eigen::Vector3d v_F;     // of the IMU's origin relative to the ground
  Eigen::Vector3d rate_F;  // of F
  Eigen::Vector3d turn_F;  // velocity that the rate gives F, beside the IMU's origin
  Eigen::Matrix3d R_FI;
};

Motion MotionOf(const State& state, const GroundSensor& sensor, const FlowInterval& interval,
                const Error& e) {
  Motion m{.R_FI = sensor.T_IF.q.conjugate().toRotationMatrix()};
  const Eigen::Vector3d rate =
      interval.rate_rad_s - state.gyro_bias - e.segment<3>(kGyroBias) -
      interval.rate_rad_s.z() * (state.GyroTurn() + e.segment<3>(kGyroTurn));
  const Eigen::Vector3d v_I =
      state.q_WI.conjugate() * (state.v_WI + e.segment<3>(kVelocity) - interval.gained_m_s);
  // The velocity gained was reckoned with a bias and a level that err: half of the interval's.
  const Eigen::Vector3d missed_I =
      0.5 * interval.duration_s *
      (e.segment<3>(kAccelBias) +
       state.q_WI.conjugate() *
           e.segment<3>(kTheta).cross(Eigen::Vector3d(0.0, 0.0, -kGravity_m_s2)));
  m.v_F = m.R_FI * (v_I + missed_I);
  m.rate_F = m.R_FI * rate;
  m.turn_F = m.R_FI * rate.cross(sensor.T_IF.p);
  return m;
}

Eigen::Vector2d ByVelocity(const Eigen::Vector3d& v_F, double range) {
  return Eigen::Vector2d(-v_F.y(), v_F.x()) / range;
}

Eigen::Vector2d ByTurn(const Motion& m, double range) {
  return m.rate_F.head<2>() + ByVelocity(m.turn_F, range);
}

// 1 + kFlowTurn, as a matrix.
Eigen::Matrix2d TurnSeen(const State& state, const Error& e) {
  const Eigen::Vector4d t =
      state.slow.segment<4>(kFlowTurn - kNavigation) + e.segment<4>(kFlowTurn);
  Eigen::Matrix2d seen;
  seen << 1.0 + t(0), t(1), t(2), 1.0 + t(3);
  return seen;
}

}  // namespace

double RangeOf(const State& state, const GroundSensor& sensor, const Error& error) {
  const Eigen::Quaterniond q_WI = Exp(error.segment<3>(kTheta)) * state.q_WI;
  const double height = state.p_WI.z() + error(kPosition + 2) + (q_WI * sensor.T_IF.p).z() -
                        state.Slow(kTerrain) - error(kTerrain);
  return height / Down(q_WI * sensor.T_IF.q);
}

Eigen::Vector2d FlowOf(const State& state, const GroundSensor& sensor, const FlowInterval& interval,
                       const Error& error) {
  const double range = std::max(RangeOf(state, sensor, error), kNearest_m);
  const Motion m = MotionOf(state, sensor, interval, error);
  const double scale = 1.0 + state.Slow(kFlowScale) + error(kFlowScale);
  const double yaw = state.Slow(kFlowYaw) + error(kFlowYaw);
  return TurnSeen(state, error) * ByTurn(m, range) +
         scale * (Eigen::Rotation2Dd(-yaw) * ByVelocity(m.v_F, range));
}

Expected<1> ExpectRange(const State& state, const GroundSensor& sensor) {
  Eigen::Matrix<double, 1, kSize> H = Eigen::Matrix<double, 1, kSize>::Zero();
  H(kPosition + 2) = 1.0 / Down(state.q_WI * sensor.T_IF.q);
  H(kTerrain) = -H(kPosition + 2);
  const auto h = [&](const Error& e) {
    return Eigen::Matrix<double, 1, 1>(RangeOf(state, sensor, e));
  };
  return Expect<1, 2>(h, H, {{{kTheta}, {kTheta + 1}}}, state.P);
}

Expected<2> ExpectFlow(const State& state, const GroundSensor& sensor,
                       const FlowInterval& interval) {
  const Motion m = MotionOf(state, sensor, interval, Error::Zero());
  const double range = std::max(RangeOf(state, sensor, Error::Zero()), kNearest_m);
  const Eigen::Vector2d walked = ByVelocity(m.v_F, range);
  const Eigen::Vector2d turned = ByTurn(m, range);
  Eigen::Matrix<double, 2, 3> by_v_F;
  by_v_F << 0.0, -1.0 / range, 0.0, 1.0 / range, 0.0, 0.0;
  const Eigen::Matrix<double, 2, 3> by_v_I = by_v_F * m.R_FI;
  Eigen::Matrix3d lever;  // rate x p by the rate
  const Eigen::Vector3d& p = sensor.T_IF.p;
  lever << 0.0, p.z(), -p.y(), -p.z(), 0.0, p.x(), p.y(), -p.x(), 0.0;
  const Eigen::Matrix<double, 2, 3> by_rate =
      TurnSeen(state, Error::Zero()) * (m.R_FI.topRows<2>() + by_v_I * lever);

  Eigen::Matrix<double, 2, kSize> H = Eigen::Matrix<double, 2, kSize>::Zero();
  H.middleCols<3>(kVelocity) = by_v_I * state.q_WI.conjugate().toRotationMatrix();
  H.middleCols<3>(kGyroBias) = -by_rate;
  H.middleCols<3>(kAccelBias) = 0.5 * interval.duration_s * by_v_I;
  H.middleCols<3>(kGyroTurn) = -by_rate * interval.rate_rad_s.z();
  H.middleCols<4>(kFlowTurn) << turned.x(), turned.y(), 0.0, 0.0, 0.0, 0.0, turned.x(), turned.y();
  H.col(kFlowScale) = walked;
  H.col(kFlowYaw) = Eigen::Vector2d(walked.y(), -walked.x());
  const auto h = [&](const Error& e) { return FlowOf(state, sensor, interval, e); };
  return Expect<2, 3>(h, H, {{{kTheta}, {kTheta + 1}, {kPosition + 2, kTerrain, -1.0}}}, state.P);
}

double RangeNoise(const State& state, const GroundSensor& sensor, const UkfOptions& options) {
  const double down = Down(state.q_WI * sensor.T_IF.q);
  const double range = RangeOf(state, sensor, Error::Zero());
  const double aside2 = Square(range) * std::max(0.0, 1.0 - Square(down));
  return Square(sensor.calibration.range_sigma_m) + Square(options.roughness_sigma_m) +
         aside2 * Square(options.slope_sigma);
}

// White noise of the flow; a ground that is not as far as the beam says; an optical axis that is
// not where it is thought to be, about which the robot turns.
double FlowNoise(const State& state, const GroundSensor& sensor, const FlowInterval& interval,
                 double integration_s, const UkfOptions& options) {
  const Motion m = MotionOf(state, sensor, interval, Error::Zero());
  const double range = std::max(RangeOf(state, sensor, Error::Zero()), kNearest_m);
  const double translation2 = (m.v_F + m.turn_F).head<2>().squaredNorm() / Square(range);
  return Square(sensor.calibration.flow_noise_rad_s_sqrt_hz) / integration_s +
         translation2 * Square(options.roughness_sigma_m / range) +
         Square(m.rate_F.z() * sensor.calibration.mount_sigma_rad);
}

bool KnowsHeight(const State& state, const GroundSensor& sensor) {
  const double variance = state.P(kTerrain, kTerrain) + state.P(kPosition + 2, kPosition + 2) -
                          2.0 * state.P(kTerrain, kPosition + 2);
  const double range = RangeOf(state, sensor, Error::Zero());
  return range > kNearest_m && variance < Square(kKnownHeight * range);
}

}  // namespace polnav::nav::ukf
