// What carries the sensors?
//
// One of the vehicles below, by which option is present. Each is at time zero when made, and moves
// on by one physics step at a time; a further vehicle is a further alternative.
#pragma once

#include <cstdint>
#include <optional>
#include <variant>

#include "sim/vehicle/car.h"
#include "sim/vehicle/turntable.h"

namespace polnav::sim {

// YAML keys = field names. At most one; none is a car with its defaults.
struct VehicleOptions {
  std::optional<CarOptions> car;
  std::optional<TurntableOptions> turntable;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("car", car);
    v("turntable", turntable);
  }
};

class Vehicle {
 public:
  static constexpr nav::TimeNs kStep = Car::kStep;

  // Keeps references to track and terrain.
  Vehicle(const VehicleOptions& options, const Track& track, const Terrain& terrain,
          std::uint64_t seed);

  void Step();
  [[nodiscard]] const Truth& truth() const;

 private:
  std::variant<Car, Turntable> vehicle_;
};

}  // namespace polnav::sim
