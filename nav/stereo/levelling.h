// Which way is up?
//
// An accelerometer feels the support against gravity plus the vehicle's own acceleration. Vision
// knows the latter: over an interval of seconds it is the change of velocity along the visual
// trajectory, standing still included. What is left points up,
//   up = mean(R f) - (v_end - v_begin) / T,
// free of heading. Errors: vision's velocity at both ends over g T, and the accelerometer's bias
// (1.5 mg is 0.09 degrees), which no averaging removes; it counts once at the start and later as a
// slow error that is independent anew after kBiasTime.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "nav/api/measurements.h"
#include "nav/graph/window.h"

namespace polnav::nav {

struct LevellingOptions {
  double first_interval_s = 1.0;     // of the first answer: the vehicle is expected to stand
  double interval_s = 3.0;           // of the later ones; longer: vision's velocity matters less
  double bias_sigma_deg = 0.15;      // tilt that the accelerometer's bias and misalignment fake
  double velocity_sigma_m_s = 0.05;  // of vision's velocity

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("first_interval_s", first_interval_s, {.min = 0.2, .max = 60.0});
    v("interval_s", interval_s, {.min = 0.2, .max = 60.0});
    v("bias_sigma_deg", bias_sigma_deg, {.min = 0.001, .max = 10.0});
    v("velocity_sigma_m_s", velocity_sigma_m_s, {.min = 1e-4, .max = 10.0});
  }
};

class Levelling {
 public:
  explicit Levelling(const LevellingOptions& options) : options_(options) {}

  void Add(const ImuSample& sample);

  // Vision's motion T_BpB from the frame before to the one at `stamp`.
  void AddMotion(TimeNs stamp, const Pose& motion);

  // Vision has lost the thread: the next interval begins here.
  void Interrupt();

  // True until the first answer was taken: a keyframe should be made for it.
  [[nodiscard]] bool FirstIsDue() const;

  // "Up" at the newest frame, when an interval is complete; the next one then begins.
  [[nodiscard]] std::optional<LevelEdge> TakeEdge();

 private:
  struct Frame {
    TimeNs stamp;
    Pose pose;                // in a frame of vision's own that begins with the interval
    Eigen::Vector3d force_B;  // mean specific force since the frame before, in B half way
  };

  [[nodiscard]] double SpanSeconds() const;
  [[nodiscard]] Eigen::Vector3d VelocityAt(std::size_t frame) const;

  LevellingOptions options_;
  std::vector<Frame> frames_;
  Eigen::Vector3d force_sum_ = Eigen::Vector3d::Zero();
  int force_count_ = 0;
  bool first_taken_ = false;
};

}  // namespace polnav::nav
