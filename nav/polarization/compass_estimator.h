// What heading does a sky camera give a vehicle that stands or drives level?
//
// One picture, one answer; nothing is carried over but which of two headings half a turn apart was
// the last, at the start the granted one. Pitch and roll are taken to be zero, with
// CompassOptions::tilt_sigma_deg of doubt. Position means nothing in the estimate.
#pragma once

#include <optional>

#include "nav/api/estimate.h"
#include "nav/api/measurements.h"
#include "nav/polarization/compass.h"
#include "nav/polarization/heading_fusion.h"

namespace polnav::nav {

class CompassEstimator {
 public:
  CompassEstimator(const CompassOptions& options, const PolarizationCameraCalibration& calibration,
                   SunModel sun, const StartPrior& start);

  // An estimate for each picture in which a heading was found. Unusable: a picture that is not
  // newer than all before.
  [[nodiscard]] Report Process(const Measurement& measurement);

 private:
  Compass compass_;
  SunModel sun_;
  double last_rad_;  // heading
  std::optional<TimeNs> newest_;
};

}  // namespace polnav::nav
