#include "sky/neutral_points.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace polnav::sky {

namespace {

using std::numbers::pi;

// The sun's vertical plane: angles count from the horizon below the sun over the zenith.
struct Plane {
  explicit Plane(const Eigen::Vector3d& sun_W) {
    const double flat = sun_W.head<2>().norm();
    if (flat > 1e-12) level_W = Eigen::Vector3d(sun_W.x() / flat, sun_W.y() / flat, 0.0);
    sun_rad = std::atan2(sun_W.z(), flat);
  }

  [[nodiscard]] Eigen::Vector3d RayAt(double angle_rad) const {
    return std::cos(angle_rad) * level_W + std::sin(angle_rad) * Eigen::Vector3d::UnitZ();
  }

  // Q / I about the plane; the first axis is in it.
  [[nodiscard]] double PolarizationAt(double angle_rad, const ClearSky& sky) const {
    const double from_sun = sun_rad - angle_rad;
    const Eigen::Vector3d sun(std::sin(from_sun), 0.0, std::cos(from_sun));
    const Eigen::Vector3d up(std::cos(angle_rad), 0.0, std::sin(angle_rad));
    return sky.Look<double>(sun, up).q;
  }

  Eigen::Vector3d level_W = Eigen::Vector3d::UnitY();
  double sun_rad;
};

// By their order in the plane: a glint on the sea may lift both points near the sun above it.
std::vector<NeutralPoint> Named(const Plane& plane, const std::vector<double>& angles) {
  std::vector<NeutralPoint> points;
  const auto near_sun = std::count_if(
      angles.begin(), angles.end(), [&](double angle) { return angle < plane.sun_rad + 0.5 * pi; });
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const auto place = static_cast<std::ptrdiff_t>(i);
    const bool first = near_sun > 1 ? place == 0 : angles[i] < plane.sun_rad;
    const char* const by_sun = first ? "Brewster" : "Babinet";
    const char* const opposite = place == near_sun ? "Arago" : "fourth";
    points.push_back({place < near_sun ? by_sun : opposite, plane.RayAt(angles[i])});
  }
  return points;
}

std::vector<NeutralPoint> Found(const ClearSky& sky, const Plane& plane) {
  constexpr int kSteps = 1440;
  std::vector<double> angles;  // from the horizon below the sun over the zenith
  double last = plane.PolarizationAt(0.0, sky);
  for (int i = 1; i <= kSteps; ++i) {
    double low = pi * (i - 1) / kSteps;
    double high = pi * i / kSteps;
    const double here = plane.PolarizationAt(high, sky);
    if ((last < 0.0) != (here < 0.0)) {
      for (int halving = 0; halving < 60; ++halving) {
        const double middle = 0.5 * (low + high);
        const bool as_low = (plane.PolarizationAt(middle, sky) < 0.0) == (last < 0.0);
        (as_low ? low : high) = middle;
      }
      angles.push_back(high);
    }
    last = here;
  }
  return Named(plane, angles);
}

}  // namespace

std::vector<NeutralPoint> NeutralPoints(const ClearSky& sky) {
  const Plane plane(sky.sun_W());
  if (std::holds_alternative<HazySky>(sky.model())) return Found(sky, plane);
  const auto* const berry = std::get_if<BerrySky>(&sky.model());
  const double half = berry != nullptr ? berry->half_separation_rad() : 0.0;
  if (half == 0.0) return {{"sun", sky.sun_W()}, {"antisun", -sky.sun_W()}};
  const Eigen::Vector3d babinet_W = plane.RayAt(plane.sun_rad + half);
  const Eigen::Vector3d brewster_W = plane.RayAt(plane.sun_rad - half);
  return {{"Babinet", babinet_W},
          {"Brewster", brewster_W},
          {"Arago", -brewster_W},
          {"fourth", -babinet_W}};
}

}  // namespace polnav::sky
