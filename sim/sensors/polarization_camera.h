// What does the sky camera see?
//
// A division-of-focal-plane polarimeter (sky/mosaic.h) behind a pinhole or fisheye lens
// (nav/api/lens.h). The simulated one is a particular instrument: gains, dark readings, polarizer
// angles, lens and mounting are drawn once a trial and stay; the estimator believes the nominal
// ones. The four channels' errors turn with the camera: gains read unpolarized light as polarized
// and err by 2 psi, unequal angles shear Q against U and err by 4 psi.
// Every pixel has its own ray, so the four of a cell do not see quite the same light, as in life.
// Directions that the scene hides bring its unpolarized light (sim/world/occlusion.h).
// Sky, scene and obstacles are evaluated every `sky_step_px` pixels and interpolated as (I, Q, U)
// about the pixels' axes, which are smooth everywhere. The error of that against every pixel's own
// ray, at the defaults (step 4) and a sun 30 degrees high, is in the test; edges of obstacles and
// of the scene blur by the step. Flare: light of the sun scattered in the lens, unpolarized,
// falling off as the inverse square of the angle from the sun; the disc itself saturates. Not in
// it: ghosts, motion during the exposure, crosstalk between pixels, fixed pattern but for the four
// channels.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "nav/api/calibration.h"
#include "nav/api/measurements.h"
#include "sim/random.h"
#include "sim/sensors/polarization_camera_options.h"
#include "sim/truth.h"
#include "sim/world/occlusion.h"
#include "sky/mosaic.h"
#include "sky/polarimeter.h"
#include "sky/skylight.h"

namespace polnav::sim {

// What an estimator is told: looks at B's zenith, image rows along B's x; errors as spreads.
[[nodiscard]] nav::PolarizationCameraCalibration NominalPolarizationCamera(
    const PolarizationCameraOptions& options);

class PolarizationCamera {
 public:
  // The sky must outlive the camera, and what hides parts of it. Null: nothing but the obstacles
  // does. Throws std::invalid_argument on an unusable option.
  PolarizationCamera(const PolarizationCameraOptions& options, const sky::WorldSky& sky,
                     std::uint64_t seed, std::uint64_t trial, const Occlusion* occlusion = nullptr);

  // index: of the picture, from 0. Any order.
  [[nodiscard]] nav::PolarizationImage Take(const Truth& truth, std::uint64_t index,
                                            const sky::FogAbove& fog = {}) const;

 private:
  // One picture's world.
  struct View {
    sky::SkyInstant sky;
    Eigen::Quaterniond q_WS;
    Eigen::Vector3d p_WS_m;
    Eigen::Vector3d sun_W;
    Occlusion::View scene;
    double sun_share = 0.0;  // of the sun's own light, past clouds, fog and obstacles
    sky::FogAbove fog;
  };
  struct Grid {
    int cols = 0;
    int rows = 0;
    std::vector<Eigen::Vector3f> stokes;  // [I, Q, U] about the pixels' axes, row by row

    [[nodiscard]] Eigen::Vector3f At(int row, int col, int step) const;
  };
  [[nodiscard]] View ViewFrom(const Truth& truth, const sky::FogAbove& fog) const;
  [[nodiscard]] Grid LookAround(const View& view) const;
  [[nodiscard]] Eigen::Vector3d Light(const nav::PixelAxes& axes, const View& view) const;
  void AddSun(const View& view, const Eigen::Vector2d& pixel, Eigen::Vector3f& stokes) const;
  [[nodiscard]] double Exposure(const Grid& grid) const;
  [[nodiscard]] double HalfView() const;
  [[nodiscard]] double WallHeight(const Eigen::Vector3d& ray_W) const;

  PolarizationCameraOptions options_;
  const sky::WorldSky* sky_;
  const Occlusion* occlusion_;
  double half_view_rad_;  // from the optical axis to the farthest corner
  nav::Lens lens_;        // as it is
  sky::Cell offset_{};
  Eigen::Matrix<double, 4, 3> analyzers_;
  Eigen::Quaterniond q_BS_;
  std::array<Eigen::Vector2d, 8> wall_{};  // harmonics of the obstacles' height [rad]
  RandomStream noise_;
};

}  // namespace polnav::sim
