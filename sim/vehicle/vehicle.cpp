#include "sim/vehicle/vehicle.h"

#include <stdexcept>

namespace polnav::sim {
namespace {

std::variant<Car, Turntable> Make(const VehicleOptions& options, const Track& track,
                                  const Terrain& terrain, std::uint64_t seed) {
  if (options.car && options.turntable) {
    throw std::logic_error("Vehicle: a car and a turntable at once");
  }
  using Either = std::variant<Car, Turntable>;
  if (options.turntable) return Either(Turntable(*options.turntable, terrain, seed));
  return Either(std::in_place_type<Car>, options.car.value_or(CarOptions{}), track, terrain, seed);
}

}  // namespace

Vehicle::Vehicle(const VehicleOptions& options, const Track& track, const Terrain& terrain,
                 std::uint64_t seed)
    : vehicle_(Make(options, track, terrain, seed)) {}

void Vehicle::Step() {
  if (auto* car = std::get_if<Car>(&vehicle_)) {
    car->Step();
  } else {
    std::get<Turntable>(vehicle_).Step(kStep);
  }
}

const Truth& Vehicle::truth() const {
  return std::visit([](const auto& vehicle) -> const Truth& { return vehicle.truth(); }, vehicle_);
}

}  // namespace polnav::sim
