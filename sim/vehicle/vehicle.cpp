#include "sim/vehicle/vehicle.h"

#include <stdexcept>
#include <utility>

namespace polnav::sim {
namespace {

using AnyVehicle = std::variant<Car, Turntable, Hexapod, Playback>;

AnyVehicle Make(const VehicleOptions& options, const Track& track, const Terrain& terrain,
                std::uint64_t seed) {
  if (CountOf(options) > 1) throw std::logic_error("Vehicle: several at once");
  if (options.turntable) return Turntable(*options.turntable, terrain, seed);
  if (options.hexapod) {
    return AnyVehicle(std::in_place_type<Hexapod>, *options.hexapod, terrain, seed);
  }
  return AnyVehicle(std::in_place_type<Car>, options.car.value_or(CarOptions{}), track, terrain,
                    seed);
}

}  // namespace

int CountOf(const VehicleOptions& options) {
  return int{options.car.has_value()} + int{options.turntable.has_value()} +
         int{options.hexapod.has_value()};
}

Vehicle::Vehicle(const VehicleOptions& options, const Track& track, const Terrain& terrain,
                 std::uint64_t seed)
    : vehicle_(Make(options, track, terrain, seed)) {}

Vehicle::Vehicle(std::shared_ptr<const Motion> motion) : vehicle_(Playback(std::move(motion))) {}

void Vehicle::Step() {
  if (auto* turntable = std::get_if<Turntable>(&vehicle_)) {
    turntable->Step(kStep);
  } else if (auto* car = std::get_if<Car>(&vehicle_)) {
    car->Step();
  } else if (auto* hexapod = std::get_if<Hexapod>(&vehicle_)) {
    hexapod->Step();
  } else {
    std::get<Playback>(vehicle_).Step();
  }
}

const Truth& Vehicle::truth() const {
  return std::visit([](const auto& vehicle) -> const Truth& { return vehicle.truth(); }, vehicle_);
}

}  // namespace polnav::sim
