// How high is the ground, and how does it lean?
//
// One smooth analytic surface z = Height(x, y) under the wheels and under the renderer: the plaza
// leans as a whole, the road has a cross fall, hills and bumps are sums of plane waves in random
// directions. Two continuous derivatives. Height at the origin is whatever the seed makes it.
// Fails: no kerbs, no holes. Bumps shorter than 2 m are for feet alone (roughness_m): they are not
// drawn, and a wheel's envelope over them is not modelled.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace polnav::sim {

// YAML keys = field names. An amplitude is that of the one wave with the same mean square; the sum
// of all peaks at about twice that.
struct TerrainOptions {
  double slope_deg = 0.7;            // of the whole plaza
  double slope_towards_deg = 200.0;  // compass azimuth of the steepest descent
  double camber_deg = 0.5;           // cross fall of the road, lower on the loop's outside
  double undulation_m = 0.08;        // amplitude of hills 30 to 55 m long
  double bump_m = 0.007;             // amplitude of bumps 2 to 6 m long
  double roughness_m = 0.0;          // amplitude of stones and ruts 0.15 to 0.6 m long

  bool operator==(const TerrainOptions&) const = default;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("slope_deg", slope_deg, {.min = 0.0, .max = 15.0});
    v("slope_towards_deg", slope_towards_deg, {.min = -360.0, .max = 360.0});
    v("camber_deg", camber_deg, {.min = -10.0, .max = 10.0});
    v("undulation_m", undulation_m, {.min = 0.0, .max = 5.0});
    v("bump_m", bump_m, {.min = 0.0, .max = 0.2});
    v("roughness_m", roughness_m, {.min = 0.0, .max = 0.05});
  }
};

class Track;

// Keeps a reference to the track: it must outlive the terrain.
class Terrain {
 public:
  Terrain(const TerrainOptions& options, const Track& track, std::uint64_t seed);

  struct Surface {
    double height_m = 0.0;
    Eigen::Vector2d gradient = Eigen::Vector2d::Zero();  // dz/dx, dz/dy [-]
  };
  // Both at the price of one.
  [[nodiscard]] Surface At(double x_m, double y_m) const;

  [[nodiscard]] double Height(double x_m, double y_m) const;
  [[nodiscard]] Eigen::Vector3d Normal(double x_m, double y_m) const;  // unit, upwards

 private:
  struct Wave {
    Eigen::Vector2d k_rad_m;
    double phase_rad;
    double amplitude_m;
  };
  void AddCamber(const Eigen::Vector2d& p_m, Surface& surface) const;

  const Track* track_;
  Eigen::Vector2d slope_;  // gradient of the plaza [-]
  double camber_slope_;    // rise towards the loop's inside [-]
  double shoulder_m_;      // width over which the cross fall dies out
  std::vector<Wave> waves_;
};

}  // namespace polnav::sim
