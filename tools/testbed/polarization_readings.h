// How bad is a single reading of the polarization sensor?
//
// Each sample alone through the plain zenith formula [Chu2021, eq. 8], taken as if the sensor
// looked straight up: tilt, sky and instrument are all in the error, as in the paper's "better than
// 2 degrees outdoors". Only the score sees this; it needs the truth.
#pragma once

#include <optional>
#include <vector>

#include "nav/api/calibration.h"
#include "nav/polarization/heading_fusion.h"
#include "sim/truth.h"
#include "tools/testbed/run_record.h"

namespace polnav::testbed {

class PolarizationReadings {
 public:
  PolarizationReadings(const std::optional<nav::PolarimeterCalibration>& calibration,
                       nav::SunModel sun);

  void Add(const nav::PolarizationSample& sample);

  // Errors of all readings within the truth's time, which is interpolated.
  [[nodiscard]] std::vector<HeadingReading> ErrorsAgainst(
      const std::vector<sim::Truth>& truth) const;

 private:
  struct Reading {
    nav::TimeNs stamp;
    Eigen::Vector3d e_B;
  };
  std::optional<nav::PolarimeterCalibration> calibration_;
  nav::SunModel sun_;
  std::vector<Reading> readings_;
};

}  // namespace polnav::testbed
