// What do the pictures of one turn say about the camera that took them?
//
// The camera stands level under a clear sky and is turned about the vertical. Errors of the four
// channels stay with the camera while the sky's pattern goes round: gains and dark readings err
// with twice the heading, unequal polarizers with four times. Solved for together (Ceres):
//   gains, dark readings and angles of the four polarizers; the mounting; the optical axis; light
//   scattered many times; a heading a picture
// from two residuals a block: the opponent pairs' disagreement, which needs no sky, and the part of
// (q, u) across Rayleigh's direction, which needs the sun. Each value has the calibration's own
// sigma as prior. Without stated headings a turn of the mounting cannot be told from the headings,
// and stays.
// The calibration comes with a covariance (turn_solver.h). The focal length is left as given: what
// the sky has beside the pattern looks like its error. Cross-validated:
// fitted without every third picture, and tried on those. Where it fails: clouds (their blocks are
// outliers, few may be), a turn of less than some 180 degrees, a camera that is not level, a lens
// that is not what is stated.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "nav/api/calibration.h"
#include "nav/polarization/compass_options.h"

namespace polnav::nav {

struct TurnPicture {
  cv::Mat mosaic;
  Eigen::Vector3d sun_W = Eigen::Vector3d::UnitZ();
  std::optional<double> heading_rad;  // stated, of B's x axis
};

// RMS over held-out pictures; headings only when they are stated.
struct HeldOut {
  double pairs = 0.0;   // opponent pairs' disagreement over intensity [-]
  double across = 0.0;  // of (q, u) across Rayleigh's direction [-], at the heading found
  std::optional<double> heading_rad;
};

struct TurnCalibration {
  PolarizationCameraCalibration calibration;  // from all pictures
  HeldOut before;                             // with the calibration that was given
  HeldOut after;                              // with one fitted to the other pictures
  int pictures = 0;
  int held_out = 0;
};

// Throws std::invalid_argument when fewer than six pictures have a heading.
[[nodiscard]] TurnCalibration CalibrateFromTurn(const CompassOptions& options,
                                                const PolarizationCameraCalibration& given,
                                                const std::vector<TurnPicture>& pictures);

}  // namespace polnav::nav
