// What may be wrong with a calibrated instrument, and what does it do to a heading?
//
// An error is what the instrument has, less what its calibration says, in the order of
// PolarizationCameraCalibration::covariance: gains, dark readings, polarizers, mounting, lens. Each
// moves the angle of a fit by a number of its own, and errors that a calibration could not tell
// apart may move it against each other: so the variance is effect^T covariance effect, not a sum of
// squares.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "nav/api/calibration.h"
#include "nav/polarization/rayleigh_pattern.h"
#include "nav/polarization/sky_blocks.h"
#include "nav/polarization/stokes_blocks.h"

namespace polnav::nav {

using InstrumentVector = Eigen::Matrix<double, kInstrumentErrors, 1>;

struct InstrumentErrors {
  InstrumentCovariance covariance = InstrumentCovariance::Zero();
  Eigen::Matrix<double, 3, 4> inverse = Eigen::Matrix<double, 3, 4>::Zero();  // to (I, Q, U)
  Eigen::Vector4d gain = Eigen::Vector4d::Ones();
  Eigen::Vector4d polarizer_rad = Eigen::Vector4d::Zero();
  // Of a block of the picture, by the errors of the lens: how its ray and axes turn. Columns: focal
  // length, optical axis along x and y; rotation vectors in B.
  std::vector<Eigen::Matrix3f> turn_by_lens;
};

// tilt_sigma_rad: of the roll and pitch that are handed in; they turn the vertical as a mounting
// does.
[[nodiscard]] InstrumentErrors ErrorsOf(const PolarizationCameraCalibration& calibration,
                                        const BlockReader& reader, double tilt_sigma_rad);

// Of a ray and its axes, in B, by the errors of the lens.
[[nodiscard]] Eigen::Matrix3d TurnByLens(const PolarizationCameraCalibration& calibration,
                                         const Eigen::Vector2d& pixel);

// Angle by unit of each error. pull: what each block's residual does to the angle.
[[nodiscard]] InstrumentVector EffectOnAngle(const InstrumentErrors& instrument,
                                             const SkyBlocks& sky, const RayleighPattern& pattern,
                                             const RayleighPattern::Values& values,
                                             const Eigen::ArrayXf& pull, double angle_rad);

}  // namespace polnav::nav
