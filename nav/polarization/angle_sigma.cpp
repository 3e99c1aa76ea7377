#include "nav/polarization/angle_sigma.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "nav/polarization/mirror_patches.h"

namespace polnav::nav {
namespace {

constexpr double kPatternPatch_rad = 0.175;  // the pattern's own features are hardly smaller

// Pull: what a residual of each block does to the angle.
double FromPattern(const SkyBlocks& sky, const AngleFit& fit, const Eigen::ArrayXf& pull,
                   double angle_rad) {
  struct Patch {
    double pull = 0.0;  // with the sign of the side
    double weight = 0.0;
    double residual = 0.0;  // times weight
    double noise = 0.0;     // variance of that by pixels' noise
  };
  const MirrorPatches patches(kPatternPatch_rad);
  std::vector<Patch> sums(patches.count());
  for (Eigen::Index i = 0; i < sky.size(); ++i) {
    const MirrorPatch at = patches.Of(sky.z.row(i).matrix().transpose().cast<double>(), angle_rad);
    Patch& sum = sums[at.index];
    const double weight = std::abs(pull[i]);
    sum.pull += at.side * pull[i];
    sum.weight += weight;
    sum.residual += weight * at.side * fit.values().across[i];
    sum.noise += weight * weight * sky.variance[i];
  }
  double pulls2 = 0.0;
  double residuals2 = 0.0;
  double weights2 = 0.0;
  for (const Patch& sum : sums) {
    pulls2 += sum.pull * sum.pull;
    residuals2 += sum.residual * sum.residual - sum.noise;
    weights2 += sum.weight * sum.weight;
  }
  return weights2 > 0.0 ? std::max(0.0, residuals2 / weights2) * pulls2 : 0.0;
}

double FromClouds(const CompassOptions& options, const SkyBlocks& sky, const Tiles& tiles,
                  const AngleFit& fit, const Eigen::ArrayXf& pull) {
  Eigen::VectorXd pulls = Eigen::VectorXd::Zero(tiles.likeness.rows());
  Eigen::VectorXd left = pulls;  // what residuals pull by
  for (Eigen::Index i = 0; i < sky.size(); ++i) {
    const int t = sky.tile[static_cast<std::size_t>(i)];
    pulls[t] += pull[i];
    left[t] += pull[i] * fit.values().across[i];
  }
  const double hidden2 =
      std::pow(1.0 - fit.Clear() / static_cast<double>(std::max(sky.in_view, 1)), 2);
  return hidden2 * (std::pow(options.gap_light_dop, 2) * pulls.dot(tiles.likeness * pulls) +
                    left.squaredNorm());
}

}  // namespace

AngleVariance VarianceOf(const CompassOptions& options, const SkyBlocks& sky, const Tiles& tiles,
                         const AngleFit& fit, double angle_rad,
                         const InstrumentErrors& instrument) {
  const AngleFit::Equations equations = fit.Linearize();
  const Eigen::Matrix2d inverse = equations.information.inverse();
  if (!(inverse(0, 0) > 0.0)) return {.sky = std::numeric_limits<double>::infinity()};
  const Eigen::ArrayXf pull = equations.parts.col(0) * static_cast<float>(inverse(0, 0)) +
                              equations.parts.col(1) * static_cast<float>(inverse(0, 1));
  const double noise = (pull.square() * sky.variance).sum();
  const InstrumentVector effect =
      EffectOnAngle(instrument, sky, fit.pattern(), fit.values(), pull, angle_rad);
  return {.sky = noise + FromPattern(sky, fit, pull, angle_rad) +
                 FromClouds(options, sky, tiles, fit, pull),
          .instrument = effect.dot(instrument.covariance * effect)};
}

}  // namespace polnav::nav
