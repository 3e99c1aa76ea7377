// How long does an estimator take for what? For reports alone: no answer depends on it.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>

namespace polnav::nav {

enum class Stage {
  kPose,        // match, reject what moves, solve, take in the sky's readings
  kAdjustment,  // bundle adjustment, and what it finds wrong
  kCovariance,  // marginalization and the newest keyframe's covariance
  kLoops,       // places and pose graph
};
inline constexpr std::array kStageNames = {"pose", "bundle_adjustment", "covariance",
                                           "loop_closing"};

// Wall time by stage [s]; 0: not reached.
using StageTimes = std::array<double, kStageNames.size()>;

// Each lap ends where the next begins; the first begins with the watch.
class StageWatch {
 public:
  explicit StageWatch(StageTimes& times) : times_(times) {}

  void Lap(Stage stage) {
    const auto now = std::chrono::steady_clock::now();
    times_[static_cast<std::size_t>(stage)] += std::chrono::duration<double>(now - begin_).count();
    begin_ = now;
  }

 private:
  StageTimes& times_;
  std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
};

}  // namespace polnav::nav
