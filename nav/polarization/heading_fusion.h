// What heading does the sky give between two keyframes?
//
// Each reading is turned into a heading with the pitch and roll that vision had at its stamp; its
// departure from vision's heading is averaged over the readings since the last keyframe. Readings'
// errors have a white part, which averaging removes, and a slow one (sky, instrument, tilt), which
// it does not: the mean's variance is white^2 / n + slow^2 2 tau / dt, so that over times much
// longer than tau the fused heading is as sure as the independent samples allow.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <vector>

#include "nav/api/calibration.h"
#include "nav/api/estimate.h"
#include "nav/api/measurements.h"
#include "nav/graph/window.h"
#include "nav/polarization/options.h"

namespace polnav::nav {

// Unit vector towards the sun in W at a stamp, from place and time; the estimator's own.
using SunModel = std::function<Eigen::Vector3d(TimeNs)>;

class HeadingFusion {
 public:
  HeadingFusion(const PolarizationOptions& options, const PolarimeterCalibration& calibration,
                SunModel sun);

  // Keeps the reading until the attitude at its stamp is known. Unusable: too little polarized, a
  // channel that does not fit the others, older than the newest frame, or the same once more.
  Outcome Add(const PolarizationSample& sample);

  // Attitudes at two frames; uses the readings up to the later one. Returns how many were gated.
  // heading_variance: of vision's heading [rad^2], for the gate.
  [[nodiscard]] int Advance(TimeNs from, const Eigen::Quaterniond& q_from, TimeNs to,
                            const Eigen::Quaterniond& q_to, double heading_variance);

  // The heading of the keyframe at `stamp`, whose vision attitude is q_WB; empties the average.
  [[nodiscard]] std::optional<HeadingEdge> TakeEdge(TimeNs stamp, const Eigen::Quaterniond& q_WB);

  // Forgets the average so far: the attitudes that it was made with have turned out wrong.
  void Forget();

 private:
  struct Reading {
    TimeNs stamp;
    Eigen::Vector3d e_B;
  };

  PolarizationOptions options_;
  PolarimeterCalibration calibration_;
  SunModel sun_;
  std::vector<Reading> waiting_;
  double innovation_sum_rad_ = 0.0;
  int innovations_ = 0;
  std::optional<TimeNs> last_edge_;
  std::optional<TimeNs> advanced_to_;  // the newest frame
};

}  // namespace polnav::nav
