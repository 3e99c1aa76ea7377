#include "sky/haze_field.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "sky/haze_constants.h"
#include "sky/sea.h"

namespace polnav::sky {

namespace {

using std::numbers::pi;

constexpr double kLowestSun_rad = pi / 180.0;
constexpr double kHighestSun_rad = 0.5 * pi - 1e-3;  // nearer the zenith there is no azimuth

}  // namespace

HazeField::HazeField(const HazeAir& hazy_air, double sun_elevation_rad)
    : sun_elevation_rad_(std::clamp(sun_elevation_rad, kLowestSun_rad, kHighestSun_rad)) {
  const LitAir air = Light(hazy_air, sun_elevation_rad_);
  const std::vector<GlintRay> glint = SunGlint(sun_elevation_rad_, haze::kSlopeVariance);
  depth_ = air.depth;
  sun_ = air.haze * air.sun / (4.0 * pi);
  for (int m = 0; m < kHazeModes; ++m) sent_[static_cast<std::size_t>(m)] = Scatter(m, air, glint);
}

HazeRay HazeField::Along(double sine) const {
  // Weight of each level's source in what reaches the ground.
  HazeProfile weight = HazeProfile::Zero();
  double through = 1.0;
  for (int j = kHazeLevels - 2; j >= 0; --j) {
    const double x = std::max((depth_[j + 1] - depth_[j]) / sine, 1e-12);
    const double layer = std::exp(-x);
    const double mean = (1.0 - layer) / x;
    weight[j + 1] += through * (1.0 - mean);
    weight[j] += through * (mean - layer);
    through *= layer;
  }
  HazeRay ray{.sun = (weight * sun_).sum()};
  for (std::size_t m = 0; m < kHazeModes; ++m) {
    const HazeBasis basis(static_cast<int>(m), Eigen::ArrayXd::Constant(1, sine));
    const HazeLight& sent = sent_[m];
    const HazeLight light =
        basis.Shown({sent.i * weight.matrix(), sent.q * weight.matrix(), sent.u * weight.matrix()});
    ray.i[m] = light.i(0, 0);
    ray.q[m] = light.q(0, 0);
    ray.u[m] = light.u(0, 0);
  }
  return ray;
}

}  // namespace polnav::sky
