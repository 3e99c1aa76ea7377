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
constexpr double kHighestSun_rad = 0.5 * pi - 1e-3;  // nearer the zenith, modes are zero over zero

}  // namespace

HazeField::HazeField(const HazeAir& hazy_air, double sun_elevation_rad) {
  const double elevation_rad = std::clamp(sun_elevation_rad, kLowestSun_rad, kHighestSun_rad);
  const LitAir air = Light(hazy_air, elevation_rad);
  const std::vector<GlintRay> glint = SunGlint(elevation_rad, haze::kSlopeVariance);
  sine_ = air.sine;
  cosine2_ = air.cosine * air.cosine;
  depth_ = air.depth;
  KeepOnce(air, glint);

  const auto tensor = [&air](const ScatteredMode& mode, int part) -> HazeProfile {
    return TensorByAir() * air.molecules * (mode.first.tensor[part] + mode.orders.tensor[part]);
  };
  const auto polarized = [&air](const ScatteredMode& mode, int part) -> HazeProfile {
    return TensorByHaze() * air.haze * mode.orders.polarized[part];
  };
  const auto light = [&air](const ScatteredMode& mode, int m, int l) -> HazeProfile {
    return LightByHaze(m, l) * air.haze * mode.orders.light[l];
  };
  const ScatteredMode flat = Scatter(0, air, glint);
  const HazeProfile even =
      EvenByAir() * air.molecules * (flat.first.light[0] + flat.orders.light[0]);
  i0_ << tensor(flat, 0), tensor(flat, 1), light(flat, 0, 0) + even, light(flat, 0, 1),
      light(flat, 0, 2);
  tensor_.col(0) = tensor(flat, 1) + polarized(flat, 1) - tensor(flat, 0) - polarized(flat, 0);

  const ScatteredMode once_round = Scatter(1, air, glint);
  i1_ << light(once_round, 1, 2) - 2.0 * tensor(once_round, 0), light(once_round, 1, 1);
  tensor_.col(1) = tensor(once_round, 0) + polarized(once_round, 0);
  i1_ /= air.cosine;
  tensor_.col(1) /= air.cosine;

  const ScatteredMode twice_round = Scatter(2, air, glint);
  i2_ = (light(twice_round, 2, 2) - tensor(twice_round, 0)) / cosine2_;
  tensor_.col(2) = (tensor(twice_round, 0) + polarized(twice_round, 0)) / cosine2_;
}

void HazeField::KeepOnce(const LitAir& air, const std::vector<GlintRay>& glint) {
  once_ << air.sun, HazeProfile::Zero();
  glint_from_.setZero();
  double across = 0.0;
  for (const GlintRay& ray : glint) {
    const HazeProfile light = ray.intensity() * GlintAt(ray, air);
    const double at_ground = light[kHazeLevels - 1];
    once_.col(1) += light;
    glint_from_ += at_ground * ray.from;
    across += at_ground * (2.0 * ray.tensor(1, 1) / ray.intensity() - 1.0);
  }
  glint_dop_ = across / once_(kHazeLevels - 1, 1);
  glint_from_.y() = 0.0;  // the facets across the sun come in pairs
  glint_from_.normalize();
  once_ = once_.colwise() * air.haze / (4.0 * pi * (1.0 - haze::kForward));
}

HazeRay HazeField::Along(double sine) const {
  // Weight of each level's source in what reaches the ground.
  HazeProfile weight = HazeProfile::Zero();
  double through = 1.0;
  for (int j = kHazeLevels - 2; j >= 0; --j) {
    const double x = (depth_[j + 1] - depth_[j]) / sine;
    const double layer = std::exp(-x);
    const double mean = (1.0 - layer) / x;
    weight[j + 1] += through * (1.0 - mean);
    weight[j] += through * (mean - layer);
    through *= layer;
  }
  const auto sum = [&weight](const auto& sources) -> Eigen::RowVectorXd {
    return weight.matrix().transpose() * sources.matrix();
  };
  const Eigen::RowVectorXd i0 = sum(i0_);
  const Eigen::RowVectorXd i1 = sum(i1_);
  const Eigen::RowVectorXd t = sum(tensor_);
  const Eigen::RowVectorXd once = sum(once_);
  const double mu2 = sine * sine;
  return {.i0 = i0[0] * (1.0 + mu2) + i0[1] * (1.0 - mu2) + i0[2] + i0[3] * sine +
                i0[4] * (1.5 * mu2 - 0.5),
          .i1 = i1[0] * sine + i1[1],
          .i2 = sum(i2_)[0],
          .a = 2.0 * t[2],
          .b = t[1] - 2.0 * sine_ * t[2],
          .c = t[0] + (cosine2_ + 2.0 * sine_ * sine_) * t[2] - 2.0 * sine_ * t[1],
          .sun = once[0],
          .glint = once[1]};
}

}  // namespace polnav::sky
