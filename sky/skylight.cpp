#include "sky/skylight.h"

#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

#include "sky/ray_axes.h"
#include "sky/sun.h"

namespace polnav::sky {

namespace {

// A ray below the horizon, raised to it.
Eigen::Vector3d AboveHorizon(const Eigen::Vector3d& ray_W) {
  if (std::abs(ray_W.squaredNorm() - 1.0) > 1e-6) {
    throw std::logic_error("WorldSky: the ray is no unit vector");
  }
  if (ray_W.z() >= 0.0) return ray_W;
  const double flat = ray_W.head<2>().norm();
  if (flat < 1e-12) return Eigen::Vector3d::UnitY();
  return {ray_W.x() / flat, ray_W.y() / flat, 0.0};
}

Eigen::Vector2d WindOf(const SkyOptions& options) {
  const double to_rad = options.wind_to_deg * std::numbers::pi / 180.0;
  return options.wind_m_s * DirectionEnu(to_rad, 0.0).head<2>();
}

}  // namespace

CloudWeather WeatherOf(const SkyOptions& options) {
  CloudWeather weather = WeatherOf(options.clouds);
  weather.cover = options.cloud_cover.value_or(weather.cover);
  weather.optical_depth = options.cloud_optical_depth.value_or(weather.optical_depth);
  weather.scale_m = options.cloud_scale_m.value_or(weather.scale_m);
  weather.altitude_m = options.cloud_altitude_m.value_or(weather.altitude_m);
  weather.veil = options.thin_cloud_cover.value_or(weather.veil);
  return weather;
}

WorldSky::WorldSky(const SkyOptions& options, const SunArc& sun, std::uint64_t seed,
                   const std::vector<CloudPassage>& passages)
    : sun_(sun),
      clear_(options.clear),
      clouds_(WeatherOf(options), WindOf(options), seed, passages) {
  static_cast<void>(ClearSky(clear_, sun.start_W));  // complains of a bad model or sun at once
}

Skylight SkyInstant::Look(const Eigen::Vector3d& ray_W, const Eigen::Vector3d& observer_W) const {
  const RayAxes axes = AxesOf(AboveHorizon(ray_W));
  const SkyStokes<double> clear = clear_.Look(axes);
  Skylight light{.radiance = clear.radiance,
                 .q = clear.q,
                 .u = clear.u,
                 .axis1_W = axes.axis1_W,
                 .axis2_W = axes.axis2_W};
  if (clouds_->empty()) return light;

  const CloudColumn column = clouds_->Look(axes.ray_W, observer_W, t_s_);
  const double air = column.transmittance * clear.radiance * column.air_light;
  const double cloud =
      (1.0 - column.transmittance) *
      CloudRadiance(column.optical_depth, axes.ray_W.dot(clear_.sun_W()), axes.ray_W.z());
  light.radiance = column.transmittance * clear.radiance + air + cloud;
  // As shares of the radiance, so that where neither is the clear sky's numbers stay as they are.
  const double air_share = air / light.radiance;
  const double cloud_share = cloud / light.radiance;
  const Eigen::Vector3d lit_from(column.air_lit_from.x(), column.air_lit_from.y(), 0.0);
  const std::complex<double> towards(lit_from.dot(axes.axis1_W), lit_from.dot(axes.axis2_W));
  const std::complex<double> p(clear.q, clear.u);
  const std::complex<double> mixed = p * (1.0 - air_share - cloud_share) +
                                     air_share * AirPolarization(towards) +
                                     cloud_share * column.kept * p;
  light.q = mixed.real();
  light.u = mixed.imag();
  return light;
}

double SkyInstant::Transmittance(const Eigen::Vector3d& ray_W,
                                 const Eigen::Vector3d& observer_W) const {
  return clouds_->Look(AboveHorizon(ray_W), observer_W, t_s_).transmittance;
}

double WorldSky::Transmittance(const Eigen::Vector3d& ray_W, const Eigen::Vector3d& observer_W,
                               double t_s) const {
  return clouds_.Look(AboveHorizon(ray_W), observer_W, t_s).transmittance;
}

}  // namespace polnav::sky
