#include "nav/polarization/meridian_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "nav/api/geometry.h"

namespace polnav::nav {
namespace {

constexpr Eigen::Index kFewest = 8;
constexpr double kLowest_rad = 0.02;  // a sun at the horizon leans on nothing else

// The unit vector that polarized light is most across of: E-vectors weighted by |p|^2, the second
// moments of e = cos(phi) x + sin(phi) y with the double angles written out.
Eigen::Vector3d MostAcross(const SkyBlocks& sky) {
  const Eigen::ArrayXf p = (sky.q.square() + sky.u.square()).sqrt();
  Eigen::Matrix3d moments = Eigen::Matrix3d::Zero();
  for (Eigen::Index i = 0; i < sky.size(); ++i) {
    const Eigen::Vector3d x = sky.x.row(i).matrix().transpose().cast<double>();
    const Eigen::Vector3d y = sky.y.row(i).matrix().transpose().cast<double>();
    const double half = 0.5 * p[i] * p[i];
    const double q = 0.5 * p[i] * sky.q[i];
    const double u = 0.5 * p[i] * sky.u[i];
    moments += (half + q) * x * x.transpose() + (half - q) * y * y.transpose() +
               u * (x * y.transpose() + y * x.transpose());
  }
  return Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(moments).eigenvectors().col(0);
}

}  // namespace

std::optional<MeridianFit> FitMeridian(const CompassOptions& options, const SkyBlocks& sky,
                                       const Tiles& tiles, const InstrumentErrors& instrument) {
  if (sky.size() < kFewest) return std::nullopt;
  Eigen::Vector3d sun = MostAcross(sky);
  if (sun.z() < 0.0) sun = -sun;
  // One search over elevations with the heading's fit: the likelihood at each is that fit's own.
  MeridianFit result;
  double best = std::numeric_limits<double>::infinity();
  const double middle = std::atan2(sun.z(), sun.head<2>().norm());
  double reach = DegToRad(12.0);
  double center = middle;
  for (int round = 0; round < 4; ++round) {
    for (int k = -3; k <= 3; ++k) {
      if (round > 0 && k % 3 == 0) continue;  // the round before was there
      const double elevation = center + reach * k / 3.0;
      if (elevation < 0.0 || elevation > 0.5 * std::numbers::pi - kLowest_rad) continue;
      const StokesFit fit = FitStokes(options, sky, tiles, elevation, instrument);
      if (fit.cost < best) {
        best = fit.cost;
        result = {.fit = fit, .elevation_rad = elevation};
      }
    }
    center = result.elevation_rad;
    reach /= 3.0;
  }
  if (!std::isfinite(best)) return std::nullopt;
  return result;
}

}  // namespace polnav::nav
