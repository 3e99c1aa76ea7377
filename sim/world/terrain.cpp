#include "sim/world/terrain.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "nav/api/geometry.h"
#include "sim/random.h"
#include "sim/world/track.h"

namespace polnav::sim {
namespace {

// How far beyond the road's edge its cross fall has died out, unless the loop is too tight.
constexpr double kShoulder_m = 8.0;

struct Band {
  double shortest_m, longest_m;
  int waves;
};
constexpr Band kHills{30.0, 55.0, 6};
constexpr Band kBumps{2.0, 6.0, 10};
constexpr Band kStones{0.15, 0.6, 12};

// 1 for t <= 0, 0 for t >= 1, with two derivatives that are zero at both ends.
struct Fade {
  double value, slope;
};
Fade SmoothFade(double t) {
  if (t <= 0.0) return {1.0, 0.0};
  if (t >= 1.0) return {0.0, 0.0};
  const double u = 1.0 - t;
  return {1.0 - t * t * t * (t * (6.0 * t - 15.0) + 10.0), -30.0 * t * t * u * u};
}

}  // namespace

Terrain::Terrain(const TerrainOptions& options, const Track& track, std::uint64_t seed)
    : track_(&track),
      camber_slope_(std::tan(nav::DegToRad(options.camber_deg))),
      // Offsets are smooth only up to the radius of curvature, which is above half the mean radius.
      shoulder_m_(std::min(kShoulder_m, 0.5 * (track.mean_radius_m() - track.road_width_m()))) {
  const double downhill = nav::DegToRad(options.slope_towards_deg);
  slope_ = -std::tan(nav::DegToRad(options.slope_deg)) *
           Eigen::Vector2d(std::sin(downhill), std::cos(downhill));

  const RandomStream stream(seed, 0, "world/terrain");
  const auto add_band = [&](const Band& band, double amplitude_m) {
    for (int i = 0; i < band.waves; ++i) {
      auto sample = stream.At(waves_.size());
      // Wavelengths spread evenly on a logarithmic scale, so that no two waves share one.
      const double fraction = (i + sample.Uniform()) / band.waves;
      const double length_m =
          band.shortest_m * std::pow(band.longest_m / band.shortest_m, fraction);
      const double direction = 2.0 * std::numbers::pi * sample.Uniform();
      const double phase = 2.0 * std::numbers::pi * sample.Uniform();
      const Eigen::Vector2d k = 2.0 * std::numbers::pi / length_m *
                                Eigen::Vector2d(std::cos(direction), std::sin(direction));
      waves_.push_back({k, phase, amplitude_m / std::sqrt(double(band.waves))});
    }
  };
  add_band(kHills, options.undulation_m);
  add_band(kBumps, options.bump_m);
  if (options.roughness_m > 0.0) add_band(kStones, options.roughness_m);
}

void Terrain::AddCamber(const Eigen::Vector2d& p_m, Surface& surface) const {
  const double half_width = 0.5 * track_->road_width_m();
  // RadialDistance is at most 1.2 times the offset, so beyond this the fall has died out.
  if (track_->RadialDistance(p_m) > 1.2 * (half_width + shoulder_m_)) return;
  const Track::Projection on_road = track_->Project(p_m);
  const double offset = on_road.offset_m;
  const Fade fade = SmoothFade((std::abs(offset) - half_width) / shoulder_m_);
  surface.height_m += camber_slope_ * offset * fade.value;
  // d offset / d p is the unit vector to the left of the nearest point's tangent.
  const Eigen::Vector2d left(-on_road.tangent.y(), on_road.tangent.x());
  surface.gradient +=
      camber_slope_ * (fade.value + std::abs(offset) * fade.slope / shoulder_m_) * left;
}

Terrain::Surface Terrain::At(double x_m, double y_m) const {
  const Eigen::Vector2d p(x_m, y_m);
  Surface surface{slope_.dot(p), slope_};
  for (const Wave& wave : waves_) {
    const double phase = wave.k_rad_m.dot(p) + wave.phase_rad;
    surface.height_m += wave.amplitude_m * std::sin(phase);
    surface.gradient += wave.amplitude_m * std::cos(phase) * wave.k_rad_m;
  }
  AddCamber(p, surface);
  return surface;
}

double Terrain::Height(double x_m, double y_m) const { return At(x_m, y_m).height_m; }

Eigen::Vector3d Terrain::Normal(double x_m, double y_m) const {
  const Surface surface = At(x_m, y_m);
  return Eigen::Vector3d(-surface.gradient.x(), -surface.gradient.y(), 1.0).normalized();
}

}  // namespace polnav::sim
