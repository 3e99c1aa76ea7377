// How did a vehicle move, so that another may move alike without any physics?
//
// A vehicle's true motion is the same in every trial that shares world, vehicle and their seed; it
// is then worth computing once. Playing it back gives the very same truths, byte by byte.
#pragma once

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include "sim/truth.h"

namespace polnav::sim {

// At every physics step, from time zero.
using Motion = std::vector<Truth>;

class Playback {
 public:
  // Throws std::logic_error when there is nothing to play.
  explicit Playback(std::shared_ptr<const Motion> motion);

  void Step();  // throws std::logic_error beyond the end
  [[nodiscard]] const Truth& truth() const { return (*motion_)[at_]; }

 private:
  std::shared_ptr<const Motion> motion_;
  std::size_t at_ = 0;
};

}  // namespace polnav::sim
