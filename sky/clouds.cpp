#include "sky/clouds.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace polnav::sky {

namespace {

constexpr double kEarthRadius_m = 6.371e6;

// Depth.
constexpr double kLogVeilSigma = 0.45;  // spread of the veil's depth, in powers of e
constexpr double kThinnest = 1e-9;      // optical depth; less is no cloud
constexpr double kLowestThreshold = -4.0;

// Light.
constexpr double kAsymmetry = 0.85;       // g of water droplets
constexpr double kThinBrightness = 5.0;   // of an opaque thin cloud over the clear zenith
constexpr double kForwardShare = 0.06;    // of sunlight scattered once, in units of the above
constexpr double kForwardDepth = 3.0;     // optical depth that it survives
constexpr double kOvercastHorizon = 2.0;  // zenith over horizon is 1 + this under thick cloud
constexpr double kOvercastDepth = 10.0;   // about which that sets in

// Polarization.
constexpr double kThinKeeps = 0.40;
constexpr double kThickKeeps = 0.13;
constexpr double kThinTurnSigma_rad = 0.125;  // cloud is lit by a patchy sky from all sides
constexpr double kThickTurnSigma_rad = 0.22;
constexpr double kThickDepth = 3.0;       // where turns are half way from thin to thick
constexpr double kTurnedThreshold = 1.5;  // of its channel: one patch of twenty lies beyond 1.64
constexpr double kTurnedRamp = 0.3;       // from upright to turned
constexpr double kTurnedStrength = 0.5;   // of a turned patch over an upright one

// A passing cloud; the edge in parts of its radius.
constexpr double kHalfBreadth_m = 500.0;  // across the wind
constexpr double kEdge = 0.3;             // over which its depth rises
constexpr double kRaggedness = 0.1;       // of the edge, a sigma of the field

// Air between clouds.
constexpr double kAirLight = 0.5;         // deep among clouds, over the clear sky's own radiance
constexpr double kAirPolarization = 0.1;  // of that light, seen across its way

// What comes down through a cloud that is lit from above [Bohren1987].
double DiffuseTransmittance(double depth) { return 1.0 / (1.0 + 0.5 * (1.0 - kAsymmetry) * depth); }

// Scattered by the angle from straight on, over what an even scatterer would give [Henyey1941].
double ForwardScattering(double cosine) {
  constexpr double g = kAsymmetry;
  const double spread = 1.0 + g * g - 2.0 * g * cosine;
  return (1.0 - g * g) / (spread * std::sqrt(spread));
}

// From 0 to 1 over a unit, with continuous slope.
double Step(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

double GaussianAbove(double x) { return 0.5 * std::erfc(x / std::numbers::sqrt2); }

// The value that this share of the field exceeds, by bisection: once a layer.
double ThresholdOf(double share) {
  double low = kLowestThreshold;
  double high = -kLowestThreshold;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (GaussianAbove(middle) > share ? low : high) = middle;
  }
  return low;
}

// Mean of n - threshold where it is positive.
double MeanExcess(double threshold) {
  const double density = std::exp(-0.5 * threshold * threshold) / std::sqrt(2.0 * std::numbers::pi);
  return density / GaussianAbove(threshold) - threshold;
}

// Share of the thin cloud's polarization, its angle, and the side that a patch is on.
std::complex<double> Kept(double depth, double turn, double patch) {
  const double share = kThickKeeps + (kThinKeeps - kThickKeeps) / (1.0 + depth);
  const double upright =
      1.0 - (1.0 + kTurnedStrength) * Step((patch - kTurnedThreshold) / kTurnedRamp);
  const double thick = depth / (depth + kThickDepth);
  const double sigma = kThinTurnSigma_rad + (kThickTurnSigma_rad - kThinTurnSigma_rad) * thick;
  // A turn by atan(sigma n), which is doubled in (Q, U), without trigonometry.
  const double tangent = sigma * turn;
  const std::complex<double> half(1.0, tangent);
  return share * upright / (1.0 + tangent * tangent) * half * half;
}

void RequireShare(double value, double top, const char* what) {
  if (!(value >= 0.0 && value <= top)) {
    throw std::logic_error(std::string("CloudLayer: ") + what + " is out of its range");
  }
}

}  // namespace

CloudWeather WeatherOf(const std::string& preset) {
  if (preset == "clear") return {};
  if (preset == "thin_cloud") return {.veil = 0.15};
  if (preset == "few_clouds") {
    return {.cover = 1.5 / 8.0, .optical_depth = 3.0, .scale_m = 600.0, .altitude_m = 1500.0};
  }
  if (preset == "many_clouds") {
    return {.cover = 6.0 / 8.0, .optical_depth = 10.0, .scale_m = 1000.0, .altitude_m = 1500.0};
  }
  if (preset == "overcast") {
    return {.cover = 1.0, .optical_depth = 25.0, .scale_m = 1500.0, .altitude_m = 1000.0};
  }
  throw std::invalid_argument(
      "clouds '" + preset + "': known are clear, thin_cloud, few_clouds, many_clouds and overcast");
}

CloudLayer::CloudLayer(const CloudWeather& weather, const Eigen::Vector2d& wind_m_s,
                       std::uint64_t seed, const std::vector<CloudPassage>& passages)
    : altitude_m_(weather.altitude_m),
      scale_m_(weather.scale_m),
      wind_m_s_(wind_m_s),
      field_(seed) {
  RequireShare(weather.cover, 1.0, "the cover");
  RequireShare(weather.veil, 0.99, "the veil");
  if (!(weather.scale_m > 0.0 && weather.altitude_m > 0.0 && weather.optical_depth >= 0.0)) {
    throw std::logic_error("CloudLayer: no such size, altitude or depth");
  }
  // Of the light, the share s comes from cloud: s / (1 - s) = (e^tau - 1) brightness.
  veil_depth_ = std::log1p(weather.veil / (1.0 - weather.veil) / kThinBrightness);
  if (weather.cover > 0.0) {
    threshold_ = ThresholdOf(weather.cover);
    thick_depth_ = weather.optical_depth / MeanExcess(threshold_);
  }
  const double wind = wind_m_s.norm();
  if (!passages.empty() && !(wind > 0.0)) {
    throw std::logic_error("CloudLayer: no cloud passes without wind");
  }
  for (const CloudPassage& passage : passages) {
    const double along_m = 0.5 * wind * passage.duration_s;
    passing_.push_back({passage.over_m - wind_m_s * passage.middle_s,
                        {along_m, std::max(along_m, kHalfBreadth_m)},
                        passage.optical_depth});
  }
}

CloudColumn CloudLayer::Look(const Eigen::Vector3d& ray_W, const Eigen::Vector3d& observer_W,
                             double t_s) const {
  CloudColumn column;
  if (empty()) return column;
  const double rise = kEarthRadius_m * ray_W.z();
  const double to_normal =  // the ray's way along the normal, at the layer, times its radius
      std::sqrt(rise * rise + altitude_m_ * (2.0 * kEarthRadius_m + altitude_m_));
  const double distance_m = to_normal - rise;
  const Eigen::Vector2d place_m =
      observer_W.head<2>() + distance_m * ray_W.head<2>() - wind_m_s_ * t_s;
  const NoiseChannels field = field_.At(place_m / scale_m_);
  const double n = field[0];

  double depth = 0.0;
  if (veil_depth_ > 0.0) depth += veil_depth_ * std::exp(kLogVeilSigma * n);
  if (thick_depth_ > 0.0) {
    const double excess = n - threshold_;
    depth += thick_depth_ * std::max(0.0, excess);
    column.air_light = kAirLight * (0.5 + excess / (1.0 + 2.0 * std::abs(excess)));
    const Eigen::Vector2d from(field[1], field[2]);
    column.air_lit_from = from / std::max(1.0, from.norm());  // no more polarized than at all
  }
  for (const Passing& cloud : passing_) {
    const Eigen::Vector2d wind = wind_m_s_.normalized();
    const Eigen::Vector2d from_center = place_m - cloud.center_m;
    const Eigen::Vector2d parts(from_center.dot(wind),
                                wind.x() * from_center.y() - wind.y() * from_center.x());
    const double inside = 1.0 - parts.cwiseQuotient(cloud.radius_m).norm();
    depth += cloud.depth * Step((inside + kRaggedness * n) / kEdge);
  }
  if (depth > kThinnest) {
    column.optical_depth = depth;
    column.transmittance = std::exp(-depth * (kEarthRadius_m + altitude_m_) / to_normal);
    column.kept = Kept(depth, field[1], field[3]);
  }
  return column;
}

double CloudRadiance(double optical_depth, double cos_sun, double up) {
  const double forward =
      kForwardShare * ForwardScattering(cos_sun) * std::exp(-optical_depth / kForwardDepth);
  // The CIE's overcast sky [CIE2003]: three times as bright at the zenith as at the horizon.
  const double overcast = optical_depth / (optical_depth + kOvercastDepth);
  const double gradation = (1.0 + kOvercastHorizon * up) / (1.0 + kOvercastHorizon);
  const double diffuse = DiffuseTransmittance(optical_depth) * (1.0 + overcast * (gradation - 1.0));
  return kThinBrightness * (diffuse + forward);
}

// Rayleigh's sin^2 across the way from the clouds that light the air.
std::complex<double> AirPolarization(std::complex<double> towards) {
  return -kAirPolarization * towards * towards;
}

}  // namespace polnav::sky
