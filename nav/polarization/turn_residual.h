// What does one block of a turn's picture say about the camera?
//
// Its two residuals over their sigmas, as turn_solver.h solves them: the opponent pairs'
// disagreement over the intensity, and the part of (q, u) across Rayleigh's direction. Errors as in
// PolarizationCameraCalibration::covariance.
#pragma once

#include <Eigen/Core>
#include <Eigen/Dense>
#include <cmath>

namespace polnav::nav {

//   instrument  gains' errors (4), dark readings (4), polarizers' errors [rad] (4)
//   view        rotation vector of the mounting's error, in B [rad] (3), focal length, relative
//               (1), optical axis [px] (2): all small
//   scattering  of light polarized vertically, by the square of the elevation's cosine, over all
//               light (stokes_fit.h)
//   heading     [rad]
struct TurnResidual {
  Eigen::Vector4d mean;  // of the four channels over full scale
  Eigen::Vector4d polarizer_rad;
  Eigen::Vector4d gain;
  Eigen::Vector4d offset;
  Eigen::Matrix3d axes_B;  // columns: the ray's x and y, and the ray, by the given calibration
  Eigen::Matrix3d turn_by_lens;  // of axes_B: instrument_errors.h
  double sun_azimuth_rad = 0.0;
  double sun_elevation_rad = 0.0;
  double pairs_sigma = 0.001;
  double across_sigma = 0.01;

  template <typename T>
  bool operator()(const T* instrument, const T* view, const T* scattering, const T* heading,
                  T* residual) const {
    using std::cos;
    using std::sin;
    using std::sqrt;
    // A dark reading that all four share turns nothing, but could make residuals look small.
    const T shared = (instrument[4] + instrument[5] + instrument[6] + instrument[7]) / 4.0;
    // Least squares of the four channels through their analyzers.
    Eigen::Matrix<T, 4, 3> analyzers;
    Eigen::Matrix<T, 4, 1> light;
    for (int k = 0; k < 4; ++k) {
      const T twice = 2.0 * (polarizer_rad[k] + instrument[8 + k]);
      const T dark = offset[k] + instrument[4 + k] - shared;
      light[k] = (mean[k] - dark) / (gain[k] * (1.0 + instrument[k]));
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
    // The sun in B, turned back as mounting and lens turn the axes: by small rotation vectors.
    const T angle = heading[0] - sun_azimuth_rad;
    const Eigen::Matrix<T, 3, 1> sun(std::cos(sun_elevation_rad) * cos(angle),
                                     std::cos(sun_elevation_rad) * sin(angle),
                                     T(std::sin(sun_elevation_rad)));
    const Eigen::Matrix<T, 3, 1> turn =
        Eigen::Matrix<T, 3, 1>(view[0], view[1], view[2]) +
        turn_by_lens.template cast<T>() * Eigen::Matrix<T, 3, 1>(view[3], view[4], view[5]);
    const Eigen::Matrix<T, 3, 1> seen =
        axes_B.transpose().template cast<T>() * (sun - turn.cross(sun));
    const T across2 = seen.x() * seen.x() + seen.y() * seen.y() + 1e-9;
    const T mx = (seen.y() * seen.y() - seen.x() * seen.x()) / across2;
    const T my = -2.0 * seen.x() * seen.y() / across2;
    const double vx = axes_B(2, 0);
    const double vy = axes_B(2, 1);
    const T vertical = 2.0 * vx * vy * mx - (vx * vx - vy * vy) * my;
    const T across = (stokes[2] * mx - stokes[1] * my) / stokes[0];
    residual[1] = (across - scattering[0] * vertical) / across_sigma;
    return true;
  }
};

}  // namespace polnav::nav
