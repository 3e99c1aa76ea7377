// How does a sensor's bias wander while it runs?
//
// Flicker (1/f) noise, what data sheets call bias instability: its Allan deviation neither falls
// nor grows with the averaging time. Made of first-order Gauss-Markov processes, one a decade of
// correlation time from 0.1 to 1e5 s. Each has the variance floor^2 ln(10) / (2 ln 2), which makes
// the spectrum's density floor^2 / (2 ln 2 f) and so the Allan deviation `floor` [IEEE1997, annex
// C], to within 2.5 percent for averaging times from 1 s to 3e4 s. Below and above it falls: there
// white noise and the random walk are larger in every sensor that we know.
#pragma once

#include <Eigen/Core>
#include <array>

#include "sim/random.h"

namespace polnav::sim {

// Three axes, independent of each other.
class FlickerNoise {
 public:
  static constexpr std::array<double, 7> kCorrelationTimes_s = {0.1, 1.0, 1e1, 1e2, 1e3, 1e4, 1e5};

  // Of each of the processes, for a floor of one.
  [[nodiscard]] static double Sigma();

  // Draws where the processes stand: they have been wandering for ever. floor 0 draws nothing.
  FlickerNoise(double floor, double step_s, RandomStream::Sample draw);

  void Step(RandomStream::Sample& draw);

  // Since the start: zero when made. Where the bias was at turn-on is not flicker's to say.
  [[nodiscard]] const Eigen::Vector3d& value() const { return value_; }

 private:
  double sigma_;
  std::array<double, kCorrelationTimes_s.size()> kept_{};
  std::array<Eigen::Vector3d, kCorrelationTimes_s.size()> states_;
  Eigen::Vector3d start_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d value_ = Eigen::Vector3d::Zero();
};

}  // namespace polnav::sim
