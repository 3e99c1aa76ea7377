// What heading does the sky give between two keyframes?
//
// Each reading is turned into a heading with the pitch and roll that the estimate had at its stamp;
// its departure from the estimate's heading is averaged over the readings since the last keyframe,
// weighted by their variance, with the way in which it depends on pitch and roll, so that the graph
// can use the reading for these too. Readings' errors have a white part, which grows as the degree
// of polarization falls and which averaging removes, and a slow one (sky, instrument), which it
// does not: the mean's variance is white^2 / n + slow^2 2 tau / dt, so that over times much longer
// than tau the fused heading is as sure as the independent samples allow. Where the light is less
// polarized than a clear sky's, some of it comes from elsewhere, and the slow part grows with its
// share.
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
#include "nav/polarization/six_channel.h"

namespace polnav::nav {

// Unit vector towards the sun in W at a stamp, from place and time; the estimator's own.
using SunModel = std::function<Eigen::Vector3d(TimeNs)>;

class HeadingFusion {
 public:
  HeadingFusion(const PolarizationOptions& options, const PolarimeterCalibration& calibration,
                SunModel sun);

  // Of the instrument's errors that are estimated, one sigma; see window.h [rad].
  [[nodiscard]] SkyErrors ErrorSigmas() const;

  // Keeps the reading until the attitude at its stamp is known. Unusable: too little polarized, a
  // channel that does not fit the others, older than the newest frame, the same once more, or the
  // last one to the last bit, which noise forbids: a frozen driver.
  Outcome Add(const PolarizationSample& sample);

  // Attitudes at two frames; uses the readings up to the later one. Returns how many were gated.
  // covariance: of the attitude's dtheta in W [rad^2], for the gate.
  [[nodiscard]] int Advance(TimeNs from, const Eigen::Quaterniond& q_from, TimeNs to,
                            const Eigen::Quaterniond& q_to, const Eigen::Matrix3d& covariance);

  // Of every reading that the last Advance used or gated.
  [[nodiscard]] const std::vector<SkyResidual>& residuals() const { return residuals_; }

  // The heading of the keyframe at `stamp`, whose attitude is q_WB; empties the average. Nothing
  // when there are too few readings, or their mean is too far from an attitude of this covariance.
  [[nodiscard]] std::optional<HeadingEdge> TakeEdge(TimeNs stamp, const Eigen::Quaterniond& q_WB,
                                                    const Eigen::Matrix3d& covariance);

 private:
  struct Reading {
    TimeNs stamp;
    PolarizedLight light;
  };
  // Of the readings since the last keyframe, weighted by one over their white variance.
  struct Sums {
    int readings = 0;
    double weight = 0.0;
    double innovation_rad = 0.0;
    double slow2_rad2 = 0.0;
    Eigen::Vector2d by_tilt = Eigen::Vector2d::Zero();
    SkyErrors by_errors = SkyErrors::Zero();
  };

  [[nodiscard]] bool Take(const Reading& reading, const Eigen::Quaterniond& q_WB,
                          const Eigen::Matrix3d& covariance);

  PolarizationOptions options_;
  PolarimeterCalibration calibration_;
  SunModel sun_;
  std::vector<Reading> waiting_;
  std::vector<SkyResidual> residuals_;
  std::optional<PolarizationSample> newest_;
  Sums sums_;
  std::optional<TimeNs> last_edge_;
  std::optional<TimeNs> advanced_to_;  // the newest frame
};

}  // namespace polnav::nav
