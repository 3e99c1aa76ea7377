#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/world/structures.h"

namespace polnav::sim {
namespace {

using std::numbers::pi;

constexpr double kLongestBridge_m = 30.0;

// Arc length from the structure's start, within a lap [m].
double FromStart(const StructureOptions& structure, double s_m, double lap_m) {
  const double from_start = std::fmod(s_m - structure.start_m, lap_m);
  return from_start < 0.0 ? from_start + lap_m : from_start;
}

// Under one structure alone. Falls off within some metres of the open, as the share of the sky that
// one sees does.
double Daylight(const StructureOptions& structure, double s_m, double lap_m) {
  const double depth = DepthIn(structure, s_m, lap_m);
  if (depth < 0.0) return 1.0;
  if (structure.kind == "bridge") return 0.45 + 0.55 * std::exp(-depth / 2.5);
  if (structure.kind == "canopy") return 0.75 + 0.25 * std::exp(-depth / 4.0);
  if (structure.kind == "plain_wall") return 1.0;
  const double lamps =
      1.0 + 0.35 * std::cos(2.0 * pi * FromStart(structure, s_m, lap_m) / kLampSpacing_m);
  const double inside = structure.interior_light;
  return inside * lamps + (1.0 - inside * lamps) * std::exp(-depth / 5.0);
}

bool Overlaps(const StructureOptions& a, const StructureOptions& b, double lap_m) {
  double gap = std::fmod(b.start_m - a.start_m, lap_m);
  if (gap < 0.0) gap += lap_m;
  return gap < a.length_m || lap_m - gap < b.length_m;
}

}  // namespace

double DepthIn(const StructureOptions& structure, double s_m, double lap_m) {
  const double from_start = FromStart(structure, s_m, lap_m);
  return from_start > structure.length_m ? -1.0
                                         : std::min(from_start, structure.length_m - from_start);
}

std::optional<StructureFault> FindFault(const std::vector<StructureOptions>& structures,
                                        double lap_m) {
  for (std::size_t i = 0; i < structures.size(); ++i) {
    const StructureOptions& structure = structures[i];
    const std::string lap = std::to_string(static_cast<int>(std::lround(lap_m))) + " m";
    const double end = structure.start_m + structure.length_m;
    if (structure.start_m < -lap_m || structure.start_m >= lap_m) {
      return StructureFault{i, "start_m", "lies outside the track of " + lap};
    }
    if (structure.length_m > lap_m || end > lap_m) {
      return StructureFault{i, "length_m", "reaches beyond the end of the track of " + lap};
    }
    if (structure.kind == "bridge" && structure.length_m > kLongestBridge_m) {
      return StructureFault{i, "length_m", "a bridge takes up at most 30 m of the road"};
    }
    const bool blinds = structure.kind == "tunnel" || structure.kind == "plain_wall";
    constexpr double kClear_m = 5.0;
    if (blinds && (structure.start_m < kClear_m ? end > -kClear_m : end > lap_m - kClear_m)) {
      return StructureFault{i, "start_m",
                            "a " + structure.kind +
                                " must keep 5 m off the start, where the cameras set their "
                                "exposure"};
    }
    for (std::size_t k = 0; k < i; ++k) {
      if (structure.kind == "canopy" || structures[k].kind == "canopy") continue;
      if (!Overlaps(structures[k], structure, lap_m)) continue;
      const auto from_m = static_cast<int>(std::lround(structures[k].start_m));
      return StructureFault{
          i, "start_m",
          "overlaps the " + structures[k].kind + " from " + std::to_string(from_m) + " m on"};
    }
  }
  return std::nullopt;
}

double DaylightAt(const std::vector<StructureOptions>& structures, double s_m,
                  const StreetFrame& street) {
  double share = 1.0;
  for (const StructureOptions& structure : structures) {
    share *= Daylight(structure, s_m, street.length_m());
  }
  return share;
}

bool IsBare(const std::vector<StructureOptions>& structures, double s_m,
            const StreetFrame& street) {
  return std::any_of(structures.begin(), structures.end(), [&](const StructureOptions& structure) {
    return structure.kind == "plain_wall" && DepthIn(structure, s_m, street.length_m()) >= 0.0;
  });
}

}  // namespace polnav::sim
