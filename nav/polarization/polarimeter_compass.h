// What heading does a point polarimeter alone give a vehicle that stands or drives level?
//
// One reading, one answer, through the zenith formula [Chu2021, eq. 8]; nothing is carried over but
// which of two headings half a turn apart was the last, at the start the granted one. Pitch and
// roll are taken to be zero. Position means nothing in the estimate.
#pragma once

#include <optional>

#include "nav/api/calibration.h"
#include "nav/api/estimate.h"
#include "nav/api/measurements.h"
#include "nav/polarization/heading_fusion.h"

namespace polnav::nav {

class PolarimeterCompass {
 public:
  PolarimeterCompass(const PolarizationOptions& options, const PolarimeterCalibration& calibration,
                     SunModel sun, const StartPrior& start);

  // An estimate for each usable reading that is newer than all before.
  [[nodiscard]] Report Process(const Measurement& measurement);

 private:
  PolarizationOptions options_;
  PolarimeterCalibration calibration_;
  SunModel sun_;
  double last_rad_;  // heading
  std::optional<TimeNs> newest_;
};

}  // namespace polnav::nav
