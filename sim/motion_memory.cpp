#include "sim/motion_memory.h"

namespace polnav::sim {

std::shared_ptr<const Motion> MotionMemory::For(const SimulatorOptions& options,
                                                nav::TimeNs duration) {
  const WorldOptions& world = options.world;
  if (world.seed == 0) return nullptr;
  const Key key{world.seed, world.track, world.terrain, options.vehicle, duration};
  if (key_ != key) {
    // The run's own key does not matter: the world's seed stands for it.
    motion_ = std::make_shared<const Motion>(RecordMotion(options, RunKey{}, duration));
    key_ = key;
  }
  return motion_;
}

}  // namespace polnav::sim
