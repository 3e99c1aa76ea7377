#include "nav/polarization/instrument_errors.h"

#include <Eigen/Dense>
#include <cmath>

#include "sky/mosaic.h"

namespace polnav::nav {
namespace {

Eigen::Matrix3d AxesThrough(const Lens& lens, const Eigen::Vector2d& pixel) {
  const PixelAxes axes = AxesOfPixel(lens, pixel);
  Eigen::Matrix3d columns;
  columns << axes.x_S, axes.y_S, axes.ray_S;
  return columns;
}

}  // namespace

// By central differences: the axes stay at right angles, so all that they do is turn.
Eigen::Matrix3d TurnByLens(const PolarizationCameraCalibration& calibration,
                           const Eigen::Vector2d& pixel) {
  constexpr double kStep = 1e-4;  // of the focal length
  const double focal = calibration.lens.focal_px;
  Eigen::Matrix3d turn_S;
  for (int k = 0; k < 3; ++k) {
    Lens more = calibration.lens;
    Lens less = calibration.lens;
    if (k == 0) {
      more.focal_px *= 1.0 + kStep;
      less.focal_px *= 1.0 - kStep;
    } else {
      more.center_px[k - 1] += kStep * focal;
      less.center_px[k - 1] -= kStep * focal;
    }
    const Eigen::Matrix3d turned = AxesThrough(more, pixel) * AxesThrough(less, pixel).transpose();
    const Eigen::Vector3d twice(turned(2, 1) - turned(1, 2), turned(0, 2) - turned(2, 0),
                                turned(1, 0) - turned(0, 1));
    turn_S.col(k) = 0.5 * twice / (2.0 * kStep * (k == 0 ? 1.0 : focal));
  }
  return calibration.T_BS.q.toRotationMatrix() * turn_S;
}

InstrumentErrors ErrorsOf(const PolarizationCameraCalibration& calibration,
                          const BlockReader& reader, double tilt_sigma_rad) {
  InstrumentErrors errors;
  errors.gain = Eigen::Map<const Eigen::Vector4d>(calibration.gain.data());
  errors.polarizer_rad = Eigen::Map<const Eigen::Vector4d>(calibration.polarizer_rad.data());
  const Eigen::Matrix<double, 4, 3> analyzers =
      sky::AnalyzerMatrix(calibration.polarizer_rad, {1.0, 1.0, 1.0, 1.0});
  errors.inverse = (analyzers.transpose() * analyzers).inverse() * analyzers.transpose();
  errors.covariance = CovarianceOf(calibration);
  for (int k = 12; k < 14; ++k) errors.covariance(k, k) += tilt_sigma_rad * tilt_sigma_rad;
  for (int row = 0; row < reader.rows(); ++row) {
    for (int col = 0; col < reader.cols(); ++col) {
      errors.turn_by_lens.push_back(TurnByLens(calibration, reader.Center(col, row)).cast<float>());
    }
  }
  return errors;
}

InstrumentVector EffectOnAngle(const InstrumentErrors& instrument, const SkyBlocks& sky,
                               const RayleighPattern& pattern,
                               const RayleighPattern::Values& values, const Eigen::ArrayXf& pull,
                               double angle_rad) {
  InstrumentVector effect;
  for (int k = 0; k < 4; ++k) {
    const double twice = 2.0 * instrument.polarizer_rad[k];
    const auto c = static_cast<float>(std::cos(twice));
    const auto s = static_cast<float>(std::sin(twice));
    const Eigen::Vector3f stokes = instrument.inverse.col(k).cast<float>();
    // By light of this channel over the intensity: first of (q, u), then of what is across.
    const Eigen::ArrayXf each = pull * (values.mx * (stokes[2] - stokes[0] * sky.u) -
                                        values.my * (stokes[1] - stokes[0] * sky.q));
    effect[k] = (each * (1.0F + c * sky.q + s * sky.u)).sum();
    effect[4 + k] = (each / sky.intensity).sum() / instrument.gain[k];
    effect[8 + k] = 2.0F * (each * (c * sky.u - s * sky.q)).sum();
  }
  // The picture's pattern turns against the mounting, so the fitted sun does.
  const Array3Xf turn_L = pattern.TurnBySun(angle_rad);
  Eigen::Vector3f mount = Eigen::Vector3f::Zero();
  Eigen::Vector3f lens = Eigen::Vector3f::Zero();
  for (Eigen::Index i = 0; i < sky.size(); ++i) {
    const Eigen::Vector3f turn_B =
        pull[i] * values.along[i] * (sky.R_LB.transpose() * turn_L.row(i).matrix().transpose());
    const auto block = static_cast<std::size_t>(sky.index[static_cast<std::size_t>(i)]);
    mount -= turn_B;
    lens -= instrument.turn_by_lens[block].transpose() * turn_B;
  }
  effect.segment<3>(12) = mount.cast<double>();
  effect.segment<3>(15) = lens.cast<double>();
  return effect;
}

}  // namespace polnav::nav
