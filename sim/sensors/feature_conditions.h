// How much of the scene's corners is left to follow under what stands before a camera's pixels?
//
// Rough rules for sim/sensors/camera_conditions.h where no picture is drawn. What lowers a corner's
// contrast over the noise shortens its reach by the same share (feature_cloud.h), so that the
// number of points falls with its square:
//   darkness  signal over shot and read noise, against that of a picture of target_mean
//   fog       exp(-3.912 d / visibility) at the distance d [Koschmieder1924]
//   glare     1 / (1 + strength)
//   overexposure  what is brighter than full scale shows no corner: brightness is taken as uniform
//             up to twice target_mean
//   dirt, rain    squares of the lens of 24 px, in each eye others, show nothing; dirt stays, drops
//             are elsewhere every second
#pragma once

#include <Eigen/Core>

#include "nav/api/time.h"
#include "sim/random.h"
#include "sim/sensors/camera_conditions.h"
#include "sim/sensors/stereo_options.h"

namespace polnav::sim {

class FeatureConditions {
 public:
  FeatureConditions(const CameraConditions& conditions, const StereoCameraOptions& options,
                    const RandomStream& cover_stream, nav::TimeNs stamp);

  // Of a corner's contrast over the noise, as far away as this.
  [[nodiscard]] double ContrastShare(double distance_m) const;
  // brightness: over the brightest there is.
  [[nodiscard]] bool Saturates(double brightness) const { return brightness > brightest_; }
  // eye: 0 left, 1 right.
  [[nodiscard]] bool IsCovered(int eye, const Eigen::Vector2d& pixel) const;

 private:
  CameraConditions conditions_;
  RandomStream cover_stream_;
  std::uint64_t second_;
  double contrast_share_;
  double brightest_;
};

}  // namespace polnav::sim
