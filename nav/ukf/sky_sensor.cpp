#include "nav/ukf/sky_sensor.h"

#include <cmath>

#include "nav/polarization/reading_errors.h"

namespace polnav::nav::ukf {

SkyReading WeighReading(const PolarizedLight& light, const Eigen::Vector3d& sun_W,
                        const Eigen::Quaterniond& q_WS, const PolarizationOptions& options) {
  const Eigen::Vector3d look_W = q_WS * Eigen::Vector3d::UnitZ();
  const auto [white_rad, foreign_share] = ErrorsOf(light, look_W, sun_W, options);
  return {.light = light,
          .sun_W = sun_W,
          .white_rad = white_rad,
          .slow_rad = SlowSigma(options),
          .foreign_rad = DegToRad(options.foreign_sigma_deg) * foreign_share};
}

double AxisOf(const State& state, const Eigen::Quaterniond& q_IS, const Eigen::Vector3d& sun_W,
              const Error& error) {
  const Eigen::Quaterniond q_WS = Exp(error.segment<3>(kTheta)) * (state.q_WI * q_IS);
  const Eigen::Vector3d s_S = q_WS.conjugate() * sun_W;
  return std::atan2(s_S.x(), -s_S.y());
}

Expected<1> ExpectSky(const State& state, const Eigen::Quaterniond& q_IS,
                      const SkyReading& reading) {
  Eigen::Matrix<double, 1, kSize> H = Eigen::Matrix<double, 1, kSize>::Zero();
  H(kSkySlow) = reading.slow_rad;
  H(kSkyForeign) = reading.foreign_rad;
  H(kSkyOffset) = 1.0;
  const double nominal = AxisOf(state, q_IS, reading.sun_W, Error::Zero());
  const double known = H.tail<kSlow>().dot(state.slow);
  // Points follow the E-vector all the way round, so that a heading of two right angles' doubt
  // still has a mean; the measured axis alone knows no ends.
  const auto h = [&](const Error& e) {
    const double axis = AxisOf(state, q_IS, reading.sun_W, e);
    return Eigen::Matrix<double, 1, 1>(WrapPi(axis - nominal) + known + H.dot(e));
  };
  return Expect<1, 3>(h, H, {{{kTheta}, {kTheta + 1}, {kTheta + 2}}}, state.P);
}

}  // namespace polnav::nav::ukf
