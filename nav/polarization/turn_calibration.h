// What do the pictures of one turn say about the camera that took them?
//
// The camera stands level under a clear sky and is turned about the vertical. Errors of the four
// channels stay with the camera while the sky's pattern goes round: gains and dark readings err
// with twice the heading, unequal polarizers with four times. Solved for together (Ceres):
//   gains, dark readings and angles of the four polarizers; the mounting; a heading a picture
// from two residuals a block: the opponent pairs' disagreement, which needs no sky, and the part of
// (q, u) across Rayleigh's direction, which needs the sun. Each value has the calibration's own
// sigma as prior. Without stated headings a turn of the mounting cannot be told from the headings,
// and stays.
// A shift of the optical axis is taken as a tilt of the mounting, which is what it does to
// headings. Blocks of one patch of sky err alike; sigmas count each patch once. Cross-validated:
// fitted without every third picture, and tried on those. Where it fails: clouds (their blocks are
// outliers, few may be), a turn of less than some 180 degrees, a camera that is not level, a lens
// that is not what is stated.
#pragma once

#include <Eigen/Core>
#include <Eigen/Dense>
#include <cmath>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "nav/api/calibration.h"
#include "nav/polarization/compass_options.h"
#include "nav/polarization/stokes_blocks.h"

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

// One block's two residuals over their sigmas: what is solved, apart for tests.
//   instrument  gains' errors (4), dark readings (4), polarizers' errors [rad] (4)
//   mount       rotation vector of the mounting's error, in B [rad]: small
//   heading     [rad]
struct TurnResidual {
  Eigen::Vector4d mean;  // of the four channels over full scale
  Eigen::Vector4d polarizer_rad;
  Eigen::Vector4d gain;
  Eigen::Vector4d offset;
  Eigen::Matrix3d axes_B;  // columns: the ray's x and y, and the ray, by the given calibration
  double sun_azimuth_rad = 0.0;
  double sun_elevation_rad = 0.0;
  double pairs_sigma = 0.001;
  double across_sigma = 0.01;

  template <typename T>
  bool operator()(const T* instrument, const T* mount, const T* heading, T* residual) const {
    using std::cos;
    using std::sin;
    using std::sqrt;
    // Least squares of the four channels through their analyzers.
    Eigen::Matrix<T, 4, 3> analyzers;
    Eigen::Matrix<T, 4, 1> light;
    for (int k = 0; k < 4; ++k) {
      const T twice = 2.0 * (polarizer_rad[k] + instrument[8 + k]);
      light[k] = (mean[k] - offset[k] - instrument[4 + k]) / (gain[k] * (1.0 + instrument[k]));
      analyzers.row(k) << T(1.0), cos(twice), sin(twice);
    }
    const Eigen::Matrix<T, 3, 3> normal = analyzers.transpose() * analyzers;
    const Eigen::Matrix<T, 3, 1> stokes = normal.inverse() * (analyzers.transpose() * light);
    const Eigen::Matrix<T, 4, 1> left = light - analyzers * stokes;
    residual[0] = T(0.0);
    for (int k = 0; k < 4; ++k) {
      residual[0] += (cos(4.0 * polarizer_rad[k]) > 0.0 ? 0.5 : -0.5) * left[k];
    }
    residual[0] /= stokes[0] * pairs_sigma;
    // The sun in B, turned back by the mounting's error: small, so by its rotation vector.
    const T angle = heading[0] - sun_azimuth_rad;
    const Eigen::Matrix<T, 3, 1> sun(std::cos(sun_elevation_rad) * cos(angle),
                                     std::cos(sun_elevation_rad) * sin(angle),
                                     T(std::sin(sun_elevation_rad)));
    const Eigen::Matrix<T, 3, 1> turn(mount[0], mount[1], mount[2]);
    const Eigen::Matrix<T, 3, 1> seen =
        axes_B.transpose().template cast<T>() * (sun - turn.cross(sun));
    const T across2 = seen.x() * seen.x() + seen.y() * seen.y() + 1e-9;
    const T mx = (seen.y() * seen.y() - seen.x() * seen.x()) / across2;
    const T my = -2.0 * seen.x() * seen.y() / across2;
    residual[1] = (stokes[2] * mx - stokes[1] * my) / (stokes[0] * across_sigma);
    return true;
  }
};

}  // namespace polnav::nav
