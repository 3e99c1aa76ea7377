// Who else is on the move?
//
// Seeded traffic on the ring road, people on the pavements and in the park, and actors whose paths
// the scenario gives. The ego vehicle drives in the middle of the road: nobody of the traffic comes
// nearer to the centre line than 1.18 m. Whoever shares a lane shares its
// speed, so that nobody runs into anybody; the traffic itself sees nobody and never brakes.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "sim/world/actor_models.h"
#include "sim/world/street_frame.h"

namespace polnav::sim {

inline constexpr double kLaneOffset_m = 2.65;  // of a lane's middle

// YAML keys = field names.
struct TrafficOptions {
  int cars = 0;
  int buses = 0;
  int pedestrians = 0;          // on both pavements, and every fourth across the park
  double speed_m_s = 8.0;       // of cars and buses
  double oncoming_share = 0.5;  // of cars and buses: they come against the ego on its left
  double walking_m_s = 1.3;     // mean of the pedestrians

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("cars", cars, {.min = 0, .max = 60});
    v("buses", buses, {.min = 0, .max = 20});
    v("pedestrians", pedestrians, {.min = 0, .max = 200});
    v("speed_m_s", speed_m_s, {.min = 0.5, .max = 30.0});
    v("oncoming_share", oncoming_share, {.min = 0.0, .max = 1.0});
    v("walking_m_s", walking_m_s, {.min = 0.2, .max = 3.0});
  }
};

// An actor with a path of its own. YAML keys = field names.
struct ActorOptions {
  std::string kind = "car";
  std::vector<Eigen::Vector2d> path_m;  // east, north; two points or more, joined by a curve
  double speed_m_s = 5.0;
  double start_s = 0.0;  // it is not there before
  bool loop = false;     // round and round, or to and fro between two; else it vanishes at the end

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("kind", kind, {"car", "bus", "pedestrian"});
    v("path_m", path_m, {.min = -1e4, .max = 1e4});
    v("speed_m_s", speed_m_s, {.min = 0.05, .max = 50.0});
    v("start_s", start_s, {.min = 0.0, .max = 86400.0});
    v("loop", loop);
  }
};

// Somebody who comes along the road for a time: at the instant at_s at arc length s_m.
struct Passer {
  std::string kind = "car";  // of ActorOptions
  double s_m = 0.0;
  double at_s = 0.0;
  double offset_m = 0.0;   // to the left of the centre line
  double speed_m_s = 8.0;  // along the road; negative: against the driving direction
  double begin_s = 0.0;
  double end_s = 60.0;
};

// Moves until end_s. The builder's scene has the actors' textures already.
[[nodiscard]] std::vector<Actor> MakeTraffic(const TrafficOptions& options,
                                             const StreetFrame& street, std::uint64_t seed,
                                             double end_s, const ActorTextures& textures);
[[nodiscard]] std::vector<Actor> MakeActors(const std::vector<ActorOptions>& options,
                                            const StreetFrame& street, std::uint64_t seed,
                                            double end_s, const ActorTextures& textures);
[[nodiscard]] std::vector<Actor> MakePassers(const std::vector<Passer>& passers,
                                             const StreetFrame& street, std::uint64_t seed,
                                             const ActorTextures& textures);

}  // namespace polnav::sim
