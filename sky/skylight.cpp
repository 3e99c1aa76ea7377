#include "sky/skylight.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

#include "sky/sun.h"

namespace polnav::sky {

namespace {

using std::numbers::pi;

constexpr double kDegree = pi / 180.0;
// Light scattered many times keeps this share of the polarization of the sky about it.
constexpr double kCloudPolarization = 0.4;
// A thin cloud is somewhat brighter than the blue that it veils.
constexpr double kCloudBrightening = 0.8;

// Horizontal unit vector below a direction; north below the zenith.
Eigen::Vector3d Horizontal(const Eigen::Vector3d& direction) {
  const Eigen::Vector3d flat(direction.x(), direction.y(), 0.0);
  const double length = flat.norm();
  return length > 1e-12 ? Eigen::Vector3d(flat / length) : Eigen::Vector3d::UnitY();
}

// The direction turned by an angle towards the zenith, in its vertical plane.
Eigen::Vector3d Raised(const Eigen::Vector3d& direction, double angle) {
  const Eigen::Vector3d along = Horizontal(direction);
  const double elevation = std::atan2(direction.z(), direction.head<2>().norm()) + angle;
  return std::cos(elevation) * along + std::sin(elevation) * Eigen::Vector3d::UnitZ();
}

// CIE standard general sky, type 12 (clear, low turbidity) [CIE S 011, ISO 15469]. Gradation with
// the zenith angle times indicatrix of the angle from the sun.
double Gradation(double cos_zenith) { return 1.0 - std::exp(-0.32 / std::max(cos_zenith, 1e-6)); }
double Indicatrix(double angle) {
  const double cosine = std::cos(angle);
  return 1.0 + 10.0 * (std::exp(-3.0 * angle) - std::exp(-1.5 * pi)) + 0.45 * cosine * cosine;
}
double ClearRadiance(const Eigen::Vector3d& ray, const Eigen::Vector3d& sun) {
  const double from_sun = std::atan2(ray.cross(sun).norm(), ray.dot(sun));
  const double sun_from_zenith = std::acos(std::clamp(sun.z(), -1.0, 1.0));
  return Indicatrix(from_sun) * Gradation(ray.z()) / (Indicatrix(sun_from_zenith) * Gradation(1.0));
}

}  // namespace

WorldSky::WorldSky(const SkyOptions& options, const SunArc& sun, std::uint64_t seed)
    : sun_(sun), max_dop_(options.max_dop) {
  if (std::abs(sun.start_W.squaredNorm() - 1.0) > 1e-6) {
    throw std::logic_error("WorldSky: the sun's direction is no unit vector");
  }
  if (options.model != "rayleigh" && options.model != "berry") {
    throw std::invalid_argument("sky model '" + options.model + "': known are rayleigh, berry");
  }
  if (options.model == "berry") {
    half_split_rad_ = 0.5 * options.neutral_point_separation_deg * kDegree;
  }
  clouds_.cover = options.thin_cloud_cover;
  clouds_.scale_m = options.thin_cloud_scale_m;
  clouds_.altitude_m = options.thin_cloud_altitude_m;
  clouds_.wind_m_s = options.wind_m_s * DirectionEnu(options.wind_to_deg * kDegree, 0.0).head<2>();
  clouds_.seed = seed;
}

Skylight WorldSky::Look(const Eigen::Vector3d& ray_W, const Eigen::Vector3d& observer_W,
                        double t_s) const {
  if (std::abs(ray_W.squaredNorm() - 1.0) > 1e-6) {
    throw std::logic_error("WorldSky::Look: the ray is no unit vector");
  }
  const Eigen::Vector3d along = Horizontal(ray_W);
  const Eigen::Vector3d ray = ray_W.z() >= 0.0 ? ray_W : along;

  Skylight light;
  light.axis1_W = ray.z() * along - ray.head<2>().norm() * Eigen::Vector3d::UnitZ();
  light.axis2_W = Eigen::Vector3d(along.y(), -along.x(), 0.0);

  // [Berry2004] without its stereographic coordinates: the complex w, whose phase is twice the
  // E-vector's angle, is the product of the two neutral points' projections, each turned by a right
  // angle. Its zeros are the points and their antipodes; |w| = sin sin becomes Rayleigh's sin^2
  // when they meet, and |w| / (2 - |w|) Rayleigh's degree of polarization.
  const auto project = [&light](const Eigen::Vector3d& point_W) {
    return std::complex<double>(point_W.dot(light.axis1_W), point_W.dot(light.axis2_W));
  };
  const Eigen::Vector3d sun = sun_W(t_s);
  const Eigen::Vector3d babinet_W = Raised(sun, half_split_rad_);
  const Eigen::Vector3d brewster_W = Raised(sun, -half_split_rad_);
  const std::complex<double> w = -project(babinet_W) * project(brewster_W);
  const std::complex<double> clear = max_dop_ * w / (2.0 - std::abs(w));

  const CloudLight cloud = LookAtClouds(clouds_, ray, observer_W, t_s);
  const std::complex<double> mixed =
      clear *
      ((1.0 - cloud.share) + cloud.share * std::polar(kCloudPolarization, 2.0 * cloud.turn_rad));
  light.q = mixed.real();
  light.u = mixed.imag();
  light.radiance = ClearRadiance(ray, sun) * (1.0 + kCloudBrightening * cloud.share);
  return light;
}

}  // namespace polnav::sky
