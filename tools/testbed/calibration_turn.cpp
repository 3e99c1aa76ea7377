#include "tools/testbed/calibration_turn.h"

#include <numbers>

#include "sim/sensors/polarization_camera.h"
#include "sky/sun.h"

namespace polnav::testbed {

std::vector<nav::TurnPicture> TakeCalibrationTurn(const sim::PolarizationCameraOptions& camera,
                                                  const sky::SkyOptions& sky, std::uint64_t seed,
                                                  std::uint64_t trial) {
  constexpr int kPictures = 24;
  const Eigen::Vector3d sun_W = sky::DirectionEnu(2.0, nav::DegToRad(25.0));
  sky::SkyOptions clear = sky;
  clear.clouds = "clear";
  const sky::WorldSky world(clear, sun_W, trial);
  const sim::PolarizationCamera instrument(camera, world, seed, trial);
  std::vector<nav::TurnPicture> pictures;
  for (int k = 0; k < kPictures; ++k) {
    sim::Truth standing;
    const double heading = nav::WrapPi(2.0 * std::numbers::pi * k / kPictures);
    standing.T_WB.q = nav::LevelAttitude(heading);
    // Pictures of a run count from 0; these have numbers, and so noise, of their own.
    const auto index = static_cast<std::uint64_t>(1000000 + k);
    pictures.push_back({.mosaic = instrument.Take(standing, index).mosaic,
                        .sun_W = sun_W,
                        .heading_rad = heading});
  }
  return pictures;
}

}  // namespace polnav::testbed
