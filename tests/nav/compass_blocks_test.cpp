// Blocks of a mosaic, and the residuals that a heading is solved from.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "nav/polarization/stokes_blocks.h"
#include "nav/polarization/stokes_fit.h"
#include "nav/polarization/turn_residual.h"
#include "sky/mosaic.h"

namespace polnav::nav {
namespace {

PolarizationCameraCalibration Camera() {
  PolarizationCameraCalibration camera;
  camera.width_px = 64;
  camera.height_px = 48;
  camera.bits = 16;
  camera.lens = {.model = LensModel::kEquidistant, .focal_px = 30.0, .center_px = {31.5, 23.5}};
  camera.polarizer_rad = sky::ParseLayout("0,45/135,90");
  camera.gain = {1.0, 1.02, 0.97, 1.01};
  camera.offset = {0.001, 0.002, 0.0, -0.001};
  return camera;
}

// light(x, y): intensity at a pixel; q, u the same everywhere.
template <typename Light>
cv::Mat Mosaic(const PolarizationCameraCalibration& camera, double q, double u, Light light) {
  const auto analyzers = sky::AnalyzerMatrix(camera.polarizer_rad, camera.gain);
  cv::Mat mosaic(camera.height_px, camera.width_px, CV_16UC1);
  for (int row = 0; row < mosaic.rows; ++row) {
    for (int col = 0; col < mosaic.cols; ++col) {
      const int k = 2 * (row % 2) + col % 2;
      const double value = light(col, row) * analyzers.row(k).dot(Eigen::Vector3d(1.0, q, u)) +
                           camera.offset[static_cast<std::size_t>(k)];
      mosaic.at<std::uint16_t>(row, col) =
          static_cast<std::uint16_t>(std::lround(std::clamp(value, 0.0, 1.0) * 65535.0));
    }
  }
  return mosaic;
}

// Rounding to a 65535th, over 16 cells, is 1e-6.
TEST(StokesBlocks, InvertTheAnalyzersExactly) {
  const PolarizationCameraCalibration camera = Camera();
  const BlockReader reader(camera, 8, 0.97);
  for (const StokesBlock& block :
       reader.Read(Mosaic(camera, 0.3, -0.2, [](int, int) { return 0.4; }))) {
    EXPECT_NEAR(block.intensity, 0.4, 1e-5);
    EXPECT_NEAR(block.q, 0.3, 3e-5);
    EXPECT_NEAR(block.u, -0.2, 3e-5);
    EXPECT_NEAR(block.mismatch, 0.0, 3e-5);
    EXPECT_EQ(block.usable, 1.0F);
  }
}

// A slope of one per cent a pixel would read as half a per cent of polarization.
TEST(StokesBlocks, ASlopeOfTheLightIsNoPolarization) {
  const PolarizationCameraCalibration camera = Camera();
  const BlockReader reader(camera, 8, 0.97);
  for (const StokesBlock& block : reader.Read(Mosaic(
           camera, 0.0, 0.0, [](int x, int y) { return 0.4 + 0.004 * (x - 32) + 0.002 * y; }))) {
    EXPECT_NEAR(block.q, 0.0, 1e-4);
    EXPECT_NEAR(block.u, 0.0, 1e-4);
  }
}

TEST(StokesBlocks, SaturatedCellsDoNotCount) {
  const PolarizationCameraCalibration camera = Camera();
  const BlockReader reader(camera, 8, 0.97);
  const auto blocks = reader.Read(
      Mosaic(camera, 0.2, 0.1, [](int x, int y) { return x < 4 && y < 8 ? 2.0 : 0.4; }));
  EXPECT_EQ(blocks[0].usable, 0.5F);
  const auto white = reader.Read(Mosaic(camera, 0.0, 0.0, [](int, int) { return 2.0; }));
  EXPECT_EQ(white[0].usable, 0.0F);
  EXPECT_EQ(white[0].intensity, 0.0F);
}

TEST(StokesBlocks, OtherSizesAndDepthsAreRefused) {
  const BlockReader reader(Camera(), 8, 0.97);
  EXPECT_THROW(static_cast<void>(reader.Read(cv::Mat(48, 64, CV_8UC1))), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(reader.Read(cv::Mat(48, 62, CV_16UC1))), std::invalid_argument);
  EXPECT_THROW(static_cast<void>(reader.Read(cv::Mat(48, 64, CV_16UC3))), std::invalid_argument);
}

// Automatic derivatives are ceres' own; what can be wrong is the physics: at the truth both vanish.
TEST(TurnResidual, VanishesForTheTrueInstrumentAndHeading) {
  const Eigen::Vector4d gain(1.01, 0.99, 1.0, 1.02);
  const Eigen::Vector4d turned(0.01, -0.02, 0.005, 0.0);
  TurnResidual residual;
  residual.polarizer_rad = Eigen::Vector4d(0.0, -0.7853981634, -2.3561944902, -1.5707963268);
  residual.gain = Eigen::Vector4d::Ones();
  residual.offset = Eigen::Vector4d::Zero();
  residual.axes_B = Eigen::Matrix3d::Identity();
  residual.turn_by_lens = Eigen::Matrix3d::Zero();
  residual.sun_azimuth_rad = 0.4;
  residual.sun_elevation_rad = 0.3;
  const double heading = 1.3;
  // Zenith: the E-vector is across the sun's azimuth, which lies at heading - azimuth from x.
  const double twice = 2.0 * (heading - 0.4) + std::numbers::pi;
  for (int k = 0; k < 4; ++k) {
    const double at = 2.0 * (residual.polarizer_rad[k] + turned[k]);
    residual.mean[k] = 0.3 * gain[k] * (1.0 + 0.5 * std::cos(at - twice));
  }
  const Eigen::Vector4d error = gain - Eigen::Vector4d::Ones();
  Eigen::Matrix<double, 12, 1> instrument;
  instrument << error, Eigen::Vector4d::Zero(), turned;
  const Eigen::Matrix<double, 6, 1> view = Eigen::Matrix<double, 6, 1>::Zero();
  const double scattering = 0.0;
  Eigen::Vector2d value;
  residual(instrument.data(), view.data(), &scattering, &heading, value.data());
  EXPECT_LT(value.norm(), 1e-6);
  // 2 p per radian of heading, over its sigma.
  const double off = heading + 1e-4;
  residual(instrument.data(), view.data(), &scattering, &off, value.data());
  EXPECT_NEAR(std::abs(value[1]), 2.0 * 0.5 * 1e-4 / residual.across_sigma, 1e-5);
}

}  // namespace
}  // namespace polnav::nav
