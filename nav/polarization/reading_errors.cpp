#include "nav/polarization/reading_errors.h"

#include <algorithm>
#include <cmath>

#include "nav/polarization/sky_heading.h"

namespace polnav::nav {
namespace {

constexpr double kReferenceDop = 0.5;  // at which options' white part is stated
// A clear sky is at least this much of the Rayleigh pattern of clear_dop: haze and cirrus vary.
constexpr double kLeastClear = 0.8;

}  // namespace

double SlowSigma(const PolarizationOptions& options) {
  // Four harmonics, of which sine and cosine take turns.
  return DegToRad(std::hypot(options.correlated_sigma_deg, options.mount_sigma_deg,
                             std::sqrt(2.0) * options.harmonic_sigma_deg));
}

ReadingErrors ErrorsOf(const PolarizedLight& light, const Eigen::Vector3d& look_W,
                       const Eigen::Vector3d& sun_W, const PolarizationOptions& options) {
  const double clear = kLeastClear * RayleighDop(look_W, sun_W, options.clear_dop);
  return {.white_rad = DegToRad(options.reading_sigma_deg) * kReferenceDop / light.dop,
          .foreign_share = std::max(0.0, clear / light.dop - 1.0)};
}

}  // namespace polnav::nav
