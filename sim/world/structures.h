// What is built over and beside the road?
//
//   bridge      crosses the road on piers
//   tunnel      walls and a roof close in the road, lamps inside, dim
//   canopy      rows of trees whose crowns meet over the road, with gaps
//   plain_wall  smooth walls at both edges hide what is behind, the asphalt is bare: few features
// Every structure leaves the whole width of the road free, up to its clear height.
// Light under a roof is a share of daylight, put into the vertices: it depends on the distance from
// the open alone, and what moves through is not dimmed by it.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "sim/world/scene_builder.h"
#include "sim/world/street_frame.h"

namespace polnav::sim {

// YAML keys = field names.
struct StructureOptions {
  std::string kind = "bridge";
  double start_m = 0.0;  // arc length along the centre line; negative: so far before the start
  double length_m = 10.0;
  std::optional<double> height_m;  // clear height, or the walls': bridge 5, tunnel and canopy 5.2,
                                   // plain_wall 8
  double density = 0.85;           // canopy: share of the places along both kerbs that have a tree
  double interior_light = 0.2;     // tunnel: light deep inside as a share of daylight

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("kind", kind, {"bridge", "tunnel", "canopy", "plain_wall"});
    v("start_m", start_m, {.min = -5000.0, .max = 5000.0});
    v("length_m", length_m, {.min = 2.0, .max = 5000.0});
    v("height_m", height_m, {.min = 4.5, .max = 20.0});
    v("density", density, {.min = 0.0, .max = 1.0});
    v("interior_light", interior_light, {.min = 0.0, .max = 1.0});
  }
};

// Why these structures cannot stand on a loop of this length: index of the first that cannot, the
// key of it that is to blame, and what is wrong. Nothing when they can. A tunnel or a wall must
// keep off the start, where the cameras set their exposure; only a canopy may overlap others.
struct StructureFault {
  std::size_t index;
  std::string key;
  std::string message;
};
[[nodiscard]] std::optional<StructureFault> FindFault(
    const std::vector<StructureOptions>& structures, double track_length_m);

// Between a tunnel's lamps.
inline constexpr double kLampSpacing_m = 8.0;

// Distance from s to the nearer end of the structure, inside it; negative outside [m].
[[nodiscard]] double DepthIn(const StructureOptions& structure, double s_m, double track_length_m);

// Share of daylight that reaches the ground, 1 in the open.
[[nodiscard]] double DaylightAt(const std::vector<StructureOptions>& structures, double s_m,
                                const StreetFrame& street);

// True: between plain walls.
[[nodiscard]] bool IsBare(const std::vector<StructureOptions>& structures, double s_m,
                          const StreetFrame& street);

void AddStructures(const std::vector<StructureOptions>& structures, const StreetFrame& street,
                   std::uint64_t seed, SceneBuilder& scene);

}  // namespace polnav::sim
