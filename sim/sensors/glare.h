// What does a low sun throw over the picture?
//
// Light from beside the picture scatters in the lens. Of strength `glare`, in radiances of the
// clear zenith, about a sun phi from the pixel's ray and psi from the optical axis:
//   halo    40 / (1 + (phi / 1.5 deg)^2), which falls with the square of the angle [Vos1984] and
//           over-exposes all around a sun that stands in the picture
//   veil    0.6 exp(-(psi / 35 deg)^2), the same everywhere
//   ghosts  images of the stop: soft discs on the line through the sun and the picture's centre
// From psi = 60 degrees on all of it fades, and is gone at 90.
// A sun that is in the picture but hidden there throws nothing: its disc must be as bright as the
// ideal image has it. Whether something hides a sun beside the picture is for who sets the strength
// to say. The constants are a plausible small lens's, not a measured one's.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>

#include "nav/api/calibration.h"

namespace polnav::sim {

class Glare {
 public:
  explicit Glare(const nav::CameraCalibration& camera);

  // sun_C: unit vector towards the sun in the camera's frame. exposure: of the image, 255 being
  // radiance 1 / exposure.
  // The share of the sun's disc that this image, of the scene alone, does not hide.
  [[nodiscard]] double SunInSight(const Eigen::Vector3d& sun_C, double exposure,
                                  const cv::Mat& image) const;
  void Apply(double glare, const Eigen::Vector3d& sun_C, double exposure, cv::Mat& image) const;

 private:
  [[nodiscard]] Eigen::Vector2d PixelOfSun(const Eigen::Vector3d& sun_C) const;
  void AddGhosts(double scale, const Eigen::Vector2d& sun_px, cv::Mat& added) const;

  nav::CameraCalibration camera_;
  double field_rad_;  // of the corners, from the axis
  cv::Mat rays_;      // CV_32FC3, unit vectors
};

}  // namespace polnav::sim
