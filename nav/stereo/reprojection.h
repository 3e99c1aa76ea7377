// How far is a seen point from where it should be seen?
//
// Residuals e1, e2, e3 of [Chu2021, eq. 15] (e3 with its sign mended: disparity = b f / Z) of a
// landmark that is kept relative to the keyframe that first saw it (its host h):
//   m = (X/Z, Y/Z, 1/Z) in the host's rectified camera C: well-behaved up to infinity
// seen from keyframe j. Poses are T_WB; perturbations are (dp, dtheta) in W:
//   p <- p + dp,  q <- Exp(dtheta) q.
// All Jacobians are exact; tests hold them against finite differences.
#pragma once

#include <Eigen/Core>
#include <optional>

#include "nav/api/geometry.h"
#include "nav/api/measurements.h"
#include "nav/stereo/rectifier.h"

namespace polnav::nav {

struct StereoPixel {
  Eigen::Vector2d uv_px = Eigen::Vector2d::Zero();
  std::optional<double> disparity_px;  // u_left - u_right; absent: only the left camera saw it
};

[[nodiscard]] StereoPixel PixelOf(const FeatureObservation& feature);

struct PixelSigmas {
  double position_px = 0.35;
  double disparity_px = 0.30;
};

using Matrix3x6d = Eigen::Matrix<double, 3, 6>;

// Residual (observed - predicted) in sigmas; row 3 is zero when there is no disparity.
struct Reprojection {
  Eigen::Vector3d residual;
  Matrix3x6d by_host;
  Matrix3x6d by_target;
  Eigen::Matrix3d by_landmark;
};

// What all points that a keyframe sees have in common.
struct Viewpoint {
  Eigen::Matrix3d R_WC;
  Eigen::Vector3d p_WB;
  Eigen::Vector3d arm_W;  // from the body to the camera
};
[[nodiscard]] Viewpoint ViewpointOf(const RectifiedCamera& camera, const Pose& T_WB);

// Nothing when the point is not in front of the target camera. The host itself as target is
// allowed: then by_host + by_target = 0.
[[nodiscard]] std::optional<Reprojection> Reproject(const RectifiedCamera& camera,
                                                    const Viewpoint& host, const Viewpoint& target,
                                                    const Eigen::Vector3d& landmark,
                                                    const StereoPixel& seen,
                                                    const PixelSigmas& sigmas);

// The landmark (host coordinates, see above) that a stereo observation makes.
[[nodiscard]] Eigen::Vector3d LandmarkOf(const RectifiedCamera& camera, const StereoPixel& seen);

// Antisymmetric matrix with Skew(a) b = a x b.
[[nodiscard]] Eigen::Matrix3d Skew(const Eigen::Vector3d& a);

// Rotation by the vector theta [rad].
[[nodiscard]] Eigen::Quaterniond ExpRotation(const Eigen::Vector3d& theta);

// Rotation vector of q, angle at most pi [rad].
[[nodiscard]] Eigen::Vector3d LogRotation(const Eigen::Quaterniond& q);

// p + dp, Exp(dtheta) q.
[[nodiscard]] Pose Perturb(const Pose& T_WB, const Eigen::Matrix<double, 6, 1>& delta);

// The delta with Perturb(reference, delta) == pose.
[[nodiscard]] Eigen::Matrix<double, 6, 1> Difference(const Pose& pose, const Pose& reference);

}  // namespace polnav::nav
