#include "nav/polarization/six_channel.h"

#include <cmath>
#include <numbers>

namespace polnav::nav {

std::optional<PolarizedLight> DecodeSixChannels(const PolarizationSample& sample) {
  std::array<double, 3> p{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double a = sample.channel[2 * k];
    const double b = sample.channel[2 * k + 1];
    if (!(a + b > 0.0)) return std::nullopt;
    p[k] = (a - b) / (a + b);
  }
  const double squares = p[0] * p[0] + p[1] * p[1] + p[2] * p[2];
  const double products = p[0] * p[1] + p[1] * p[2] + p[0] * p[2];
  return PolarizedLight{
      .dop = 2.0 / 3.0 * std::sqrt(std::max(0.0, squares - products)),
      .axis_rad = 0.5 * std::atan2(std::numbers::sqrt3 * (p[1] - p[2]), 2.0 * p[0] - p[1] - p[2]),
      .pair_sum = p[0] + p[1] + p[2]};
}

std::optional<PolarizedLight> UsableLight(const PolarizationSample& sample,
                                          const PolarizationOptions& options) {
  const auto light = DecodeSixChannels(sample);
  if (!light || light->dop < options.min_dop || std::abs(light->pair_sum) > options.max_pair_sum) {
    return std::nullopt;
  }
  return light;
}

Eigen::Vector3d EVectorOf(const PolarizedLight& light, const PolarimeterCalibration& calibration) {
  return calibration.T_BS.q *
         Eigen::Vector3d(std::cos(light.axis_rad), std::sin(light.axis_rad), 0.0);
}

}  // namespace polnav::nav
