#include "sim/world/traffic.h"

#include <algorithm>
#include <cmath>

#include "sim/world/actor_path.h"

namespace polnav::sim {
namespace {

using Eigen::Vector2d;
using Sample = RandomStream::Sample;

// How much of a lane a vehicle takes up, its distance to the next included.
constexpr double kCarSlot_m = 7.0;
constexpr double kBusSlot_m = 15.0;

// A bus is a chord of the bend: its ends swing out by up to 0.4 m. On the outer lane they overhang
// the parking bay, on the inner one its middle overhangs the kerb, each by some 0.2 m.
constexpr double kBusOutwards_m = 0.13;
constexpr double kBusInwards_m = 0.21;

struct Lane {
  double offset_m;
  double speed_m_s;
  std::vector<bool> is_bus;  // in their order along the road
};

// Buses and cars of a lane, spread over the loop with what room there is left at random.
void FillLane(const Lane& lane, const StreetFrame& street, const RandomStream& stream, double end_s,
              const ActorTextures& textures, std::vector<Actor>& actors) {
  double needed = 0.0;
  for (const bool is_bus : lane.is_bus) needed += is_bus ? kBusSlot_m : kCarSlot_m;
  const auto count = static_cast<double>(lane.is_bus.size());
  const double spare = std::max(0.0, street.length_m() - needed) / std::max(1.0, count);
  const double bus_shift = lane.offset_m > 0.0 ? kBusInwards_m : kBusOutwards_m;
  double s = 0.0;
  for (const bool is_bus : lane.is_bus) {
    Sample random = stream.At(actors.size());
    const double slot = is_bus ? kBusSlot_m : kCarSlot_m;
    const RoadRun run{.s_m = s + 0.5 * slot + spare * random.Uniform(),
                      .offset_m = lane.offset_m + (is_bus ? bus_shift : 0.0),
                      .speed_m_s = lane.speed_m_s,
                      .end_s = end_s};
    std::string name = (is_bus ? "bus " : "car ") + std::to_string(actors.size());
    actors.push_back(is_bus ? MakeBus(std::move(name), AlongRoad(street, run), textures)
                            : MakeCar(std::move(name), AlongRoad(street, run), textures, random));
    s += slot + spare;
  }
}

void AddVehicles(const TrafficOptions& options, const StreetFrame& street,
                 const RandomStream& stream, double end_s, const ActorTextures& textures,
                 std::vector<Actor>& actors) {
  Lane along{-kLaneOffset_m, options.speed_m_s, {}};
  Lane against{kLaneOffset_m, -options.speed_m_s, {}};
  const int total = options.cars + options.buses;
  Sample random = stream.At(1'000'000);
  int buses = options.buses;
  for (int i = 0; i < total; ++i) {
    // Any of those left is equally likely to be next; lanes fill in proportion.
    const bool is_bus = random.Uniform() * (total - i) < buses;
    buses -= is_bus ? 1 : 0;
    const double share = options.oncoming_share;
    const bool oncoming = std::floor((i + 1) * share + 1e-9) > std::floor(i * share + 1e-9);
    (oncoming ? against : along).is_bus.push_back(is_bus);
  }
  FillLane(along, street, stream, end_s, textures, actors);
  FillLane(against, street, stream, end_s, textures, actors);
}

// Round the plaza on one of the pavements, or to and fro across the park.
std::vector<ActorKey> Walk(int i, double walking_m_s, const StreetFrame& street, double end_s,
                           Sample& random) {
  const double s = street.length_m() * random.Uniform();
  const double speed = walking_m_s * std::clamp(1.0 + 0.2 * random.Gaussian(), 0.5, 1.6);
  const bool backwards = random.Uniform() < 0.5;
  const double inner = street.half_road_m() + kKerbWidth_m + 0.5;
  if (i % 4 == 3) {
    const double depth = std::min(30.0, 0.6 * street.radius_m());
    const double turn_m = 8.0 * random.Gaussian();
    std::vector<Vector2d> points = {street.At(s, inner + 0.8).head<2>(),
                                    street.At(s + turn_m, depth).head<2>()};
    if (backwards) std::swap(points[0], points[1]);
    return AlongPolyline(street, {.points_m = points,
                                  .speed_m_s = speed,
                                  .end_s = end_s,
                                  .loop = true,
                                  .lift_m = kKerbHeight_m - 0.06});
  }
  // Between the lamps at the kerb and benches and trees further off; inside, on the path.
  const double outer = -street.half_road_m() - kBayWidth_m - 1.3;
  const double offset = i % 4 == 1 ? inner + 0.6 + (kInnerPath_m - 1.8) * random.Uniform()
                                   : outer - 0.7 * random.Uniform();
  return AlongRoad(street, {.s_m = s,
                            .offset_m = offset,
                            .speed_m_s = backwards ? -speed : speed,
                            .end_s = end_s,
                            .lift_m = kKerbHeight_m - 0.03,
                            .stance = Stance::kUpright});
}

Stance StanceOf(const std::string& kind) {
  return kind == "pedestrian" ? Stance::kUpright : Stance::kOnWheels;
}

Actor MakeActor(const std::string& kind, std::string name, std::vector<ActorKey> path,
                const ActorTextures& textures, Sample& random) {
  if (kind == "pedestrian")
    return MakePedestrian(std::move(name), std::move(path), textures, random);
  if (kind == "bus") return MakeBus(std::move(name), std::move(path), textures);
  return MakeCar(std::move(name), std::move(path), textures, random);
}

// Above the terrain: pavements lie higher than road and parking bay.
double PavementLift(const StreetFrame& street, double offset_m) {
  const bool on_road = offset_m < street.half_road_m() + kKerbWidth_m &&
                       offset_m > -street.half_road_m() - kBayWidth_m;
  return on_road ? 0.0 : kKerbHeight_m - 0.03;
}

}  // namespace

std::vector<Actor> MakeTraffic(const TrafficOptions& options, const StreetFrame& street,
                               std::uint64_t seed, double end_s, const ActorTextures& textures) {
  std::vector<Actor> actors;
  const RandomStream vehicles(seed, 0, "world/traffic/vehicles");
  AddVehicles(options, street, vehicles, end_s, textures, actors);
  const RandomStream people(seed, 0, "world/traffic/people");
  for (int i = 0; i < options.pedestrians; ++i) {
    Sample random = people.At(static_cast<std::uint64_t>(i));
    std::vector<ActorKey> path = Walk(i, options.walking_m_s, street, end_s, random);
    actors.push_back(
        MakePedestrian("pedestrian " + std::to_string(i), std::move(path), textures, random));
  }
  return actors;
}

std::vector<Actor> MakeActors(const std::vector<ActorOptions>& options, const StreetFrame& street,
                              std::uint64_t seed, double end_s, const ActorTextures& textures) {
  const RandomStream stream(seed, 0, "world/actors");
  std::vector<Actor> actors;
  for (std::size_t i = 0; i < options.size(); ++i) {
    const ActorOptions& actor = options[i];
    Sample random = stream.At(i);
    std::vector<ActorKey> path = AlongPolyline(street, {.points_m = actor.path_m,
                                                        .speed_m_s = actor.speed_m_s,
                                                        .begin_s = actor.start_s,
                                                        .end_s = end_s,
                                                        .loop = actor.loop,
                                                        .stance = StanceOf(actor.kind)});
    actors.push_back(MakeActor(actor.kind, actor.kind + " of world.actors." + std::to_string(i),
                               std::move(path), textures, random));
  }
  return actors;
}

std::vector<Actor> MakePassers(const std::vector<Passer>& passers, const StreetFrame& street,
                               std::uint64_t seed, const ActorTextures& textures) {
  const RandomStream stream(seed, 0, "world/passers");
  std::vector<Actor> actors;
  for (std::size_t i = 0; i < passers.size(); ++i) {
    const Passer& passer = passers[i];
    Sample random = stream.At(i);
    std::vector<ActorKey> path = AlongRoad(street, {.s_m = passer.s_m,
                                                    .at_s = passer.at_s,
                                                    .offset_m = passer.offset_m,
                                                    .speed_m_s = passer.speed_m_s,
                                                    .begin_s = passer.begin_s,
                                                    .end_s = passer.end_s,
                                                    .lift_m = PavementLift(street, passer.offset_m),
                                                    .stance = StanceOf(passer.kind)});
    actors.push_back(MakeActor(passer.kind, passer.kind + " that passes " + std::to_string(i),
                               std::move(path), textures, random));
  }
  return actors;
}

}  // namespace polnav::sim
