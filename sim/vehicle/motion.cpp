#include "sim/vehicle/motion.h"

#include <stdexcept>

namespace polnav::sim {

Playback::Playback(std::shared_ptr<const Motion> motion) : motion_(std::move(motion)) {
  if (!motion_ || motion_->empty()) throw std::logic_error("Playback: nothing is recorded");
}

void Playback::Step() {
  if (at_ + 1 >= motion_->size()) throw std::logic_error("Playback: beyond the recording's end");
  ++at_;
}

}  // namespace polnav::sim
