// Which trials move alike, so that the motion need be computed only once?
//
// Those whose world and vehicle are the same in every option and drawn from a seed of their own
// (world.seed). A few motions are kept; what comes out is the same with and without them.
#pragma once

#include <memory>
#include <vector>

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
  struct Known {
    Key key;
    std::shared_ptr<const Motion> motion;
  };
  std::vector<Known> known_;  // the oldest first
};

}  // namespace polnav::sim
