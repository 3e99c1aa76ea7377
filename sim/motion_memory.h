// Which trials move alike, so that the motion need be computed only once?
//
// Those whose world and vehicle are the same in every option and drawn from a seed of their own
// (world.seed). The newest motion is kept; what comes out is the same with and without it.
#pragma once

#include <memory>
#include <optional>

#include "sim/simulator.h"

namespace polnav::sim {

class MotionMemory {
 public:
  // Null when every trial moves in its own way.
  [[nodiscard]] std::shared_ptr<const Motion> For(const SimulatorOptions& options,
                                                  nav::TimeNs duration);

 private:
  struct Key {
    std::uint64_t seed;
    TrackOptions track;
    TerrainOptions terrain;
    VehicleOptions vehicle;
    nav::TimeNs duration;
    bool operator==(const Key&) const = default;
  };
  std::optional<Key> key_;
  std::shared_ptr<const Motion> motion_;
};

}  // namespace polnav::sim
