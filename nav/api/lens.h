// Which way does a pixel of a sky camera look?
//
//   S         camera: x along the image's rows to the right, y down, z along the optical axis
//   pixel     (u, v) [px]; the centre of the top left pixel is (0, 0)
//   pinhole       r = focal tan(angle from the axis)  [Fan2020, eqs 20-21]
//   equidistant   r = focal angle: what fisheyes nearly are
// A ray's own axes are S's x and y, turned by the smallest rotation that takes z to the ray: an
// ideal lens keeps a polarizer's angle against the radius of the image, and so these are the axes
// from which a pixel's polarizer counts wherever it sits.
// Not in it: distortion against these two forms, and the lens's own polarization (a few per cent
// near the rim of a fisheye).
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace polnav::nav {

enum class LensModel { kPinhole, kEquidistant };

struct Lens {
  LensModel model = LensModel::kPinhole;
  double focal_px = 0.0;
  Eigen::Vector2d center_px = Eigen::Vector2d::Zero();  // where the optical axis meets the sensor
};

struct PixelAxes {
  Eigen::Vector3d ray_S = Eigen::Vector3d::UnitZ();  // unit vector towards the sky
  Eigen::Vector3d x_S = Eigen::Vector3d::UnitX();    // polarizers count from here ...
  Eigen::Vector3d y_S = Eigen::Vector3d::UnitY();    // ... towards here
};

// An equidistant lens sees no further than straight back; beyond that the ray is clamped there.
[[nodiscard]] inline PixelAxes AxesOfPixel(const Lens& lens, const Eigen::Vector2d& pixel) {
  const Eigen::Vector2d offset = (pixel - lens.center_px) / lens.focal_px;
  const double radius = offset.norm();
  const double angle =
      lens.model == LensModel::kPinhole ? std::atan(radius) : std::min(radius, std::numbers::pi);
  const double cosine = std::cos(angle);
  const double sine = std::sin(angle);
  const Eigen::Vector2d along =
      radius > 0.0 ? Eigen::Vector2d(offset / radius) : Eigen::Vector2d::UnitX();
  // Rodrigues' rotation of x and y about the axis across `along`.
  const double c1 = cosine - 1.0;
  return {.ray_S = {sine * along.x(), sine * along.y(), cosine},
          .x_S = {1.0 + c1 * along.x() * along.x(), c1 * along.x() * along.y(), -sine * along.x()},
          .y_S = {c1 * along.x() * along.y(), 1.0 + c1 * along.y() * along.y(), -sine * along.y()}};
}

// Where a ray lands. A pinhole has no place for what lies beside or behind it: not a number.
[[nodiscard]] inline Eigen::Vector2d PixelOfRay(const Lens& lens, const Eigen::Vector3d& ray_S) {
  const double sine = ray_S.head<2>().norm();
  if (lens.model == LensModel::kPinhole && !(ray_S.z() > 0.0)) {
    return Eigen::Vector2d::Constant(std::nan(""));
  }
  if (!(sine > 0.0)) return lens.center_px;
  const double radius =
      lens.model == LensModel::kPinhole ? sine / ray_S.z() : std::atan2(sine, ray_S.z());
  return lens.center_px + lens.focal_px * radius / sine * ray_S.head<2>();
}

}  // namespace polnav::nav
