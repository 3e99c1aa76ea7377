// Where does the stereo pair see infinity?
//
// A pair that has turned about its vertical axis by a tenth of a milliradian since somebody
// calibrated it says the same wrong thing about every point: all disparities are off by one number,
// here the zero z. It makes the near a little wrong and the far very wrong, and so every drive too
// long or too short. Rows do not show it; motion does. Seen from two places, a static point obeys
//   m' ~ R m + rho t,  rho = (d - z) / (f b)      (m = (X/Z, Y/Z, 1) in C, m' after the motion)
//   d' = z + f b rho / (R m + rho t)_z
// and R, t and z follow from many points at many depths by least squares: near and far ones agree
// on the length of t only if z is right. Each pair of frames gives one measurement of z; they are
// averaged, weighted, with a slow drift allowed. They also err together, as far as the lens and the
// tracking depart from their models: what they say is shared out between z and that, by what is
// expected of each. What stands still or only turns tells nothing and leaves z as it is.
// Fails where all points are at one depth (no information, noticed) or move together.
#pragma once

#include <Eigen/Core>
#include <map>
#include <vector>

#include "nav/api/measurements.h"
#include "nav/stereo/options.h"
#include "nav/stereo/rectifier.h"

namespace polnav::nav {

// One point at the two ends of a motion: (u, v, d) in rectified pixels.
struct TwiceSeen {
  Eigen::Vector3d before;
  Eigen::Vector3d after;
};

struct ZeroMeasurement {
  double zero_px = 0.0;
  double sigma_px = 0.0;  // infinite where the motion does not show it
};

// The zero that makes one rigid motion of all the points, nothing assumed about it.
[[nodiscard]] ZeroMeasurement MeasureZero(const RectifiedCamera& camera,
                                          const std::vector<TwiceSeen>& points,
                                          double point_sigma_px, double first_guess_px);

class DisparityZero {
 public:
  DisparityZero(const DisparityZeroOptions& options, const RectifiedCamera& camera);

  // In the order of their stamps, disparities as they were measured.
  void Add(const StereoFeatures& features);

  // What an infinitely distant point's disparity is believed to be.
  [[nodiscard]] double zero_px() const;

 private:
  using Seen = std::map<std::uint64_t, Eigen::Vector3d>;  // (u, v, d) by id

  void Fuse(const ZeroMeasurement& measured);

  DisparityZeroOptions options_;
  RectifiedCamera camera_;
  // Of z and of what all pairs get wrong alike together, which they cannot tell apart.
  double sum_px_ = 0.0;
  double sum_sigma_px_;
  Seen reference_;
};

}  // namespace polnav::nav
