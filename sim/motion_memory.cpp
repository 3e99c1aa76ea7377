#include "sim/motion_memory.h"

#include <algorithm>

namespace polnav::sim {
namespace {

constexpr std::size_t kMostMotions = 8;  // 75 kB a second each

}  // namespace

std::shared_ptr<const Motion> MotionMemory::For(const SimulatorOptions& options,
                                                nav::TimeNs duration) {
  const WorldOptions& world = options.world;
  if (world.seed == 0) return nullptr;
  const Key key{world.seed, world.track, world.terrain, options.vehicle, duration};
  const auto known = std::find_if(known_.begin(), known_.end(),
                                  [&](const Known& entry) { return entry.key == key; });
  if (known != known_.end()) return known->motion;
  if (known_.size() == kMostMotions) known_.erase(known_.begin());
  // The run's own key does not matter: the world's seed stands for it.
  auto motion = std::make_shared<const Motion>(RecordMotion(options, RunKey{}, duration));
  known_.push_back({key, motion});
  return motion;
}

}  // namespace polnav::sim
