// What carries the sensors?
//
// One of the vehicles below, by which option is present, or one that moves as another did before.
// Each is at time zero when made, and moves on by one physics step at a time.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <variant>

#include "sim/vehicle/car.h"
#include "sim/vehicle/hexapod/hexapod.h"
#include "sim/vehicle/motion.h"
#include "sim/vehicle/turntable.h"

namespace polnav::sim {

// How many of the vehicles the options name.
struct VehicleOptions;
[[nodiscard]] int CountOf(const VehicleOptions& options);

// YAML keys = field names. At most one; none is a car with its defaults.
struct VehicleOptions {
  std::optional<CarOptions> car;
  std::optional<TurntableOptions> turntable;
  std::optional<HexapodOptions> hexapod;

  bool operator==(const VehicleOptions&) const = default;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("car", car);
    v("turntable", turntable);
    v("hexapod", hexapod);
  }
};

class Vehicle {
 public:
  static constexpr nav::TimeNs kStep = Car::kStep;

  // Keeps references to track and terrain.
  Vehicle(const VehicleOptions& options, const Track& track, const Terrain& terrain,
          std::uint64_t seed);
  // Moves as recorded, which the recording must be long enough for.
  explicit Vehicle(std::shared_ptr<const Motion> motion);

  void Step();
  [[nodiscard]] const Truth& truth() const;

 private:
  std::variant<Car, Turntable, Hexapod, Playback> vehicle_;
};

}  // namespace polnav::sim
