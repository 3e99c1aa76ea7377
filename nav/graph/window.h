// What does the sliding window hold?
//
// The graph of [Chu2021, eqs 13-16]: vertices are keyframe poses and landmarks, with an IMU also
// velocities and biases; edges are stereo reprojections (e1-e3), polarization (e4), the IMU's sums
// from one keyframe to the next, and the prior that marginalization leaves of what has slid out.
// Plain data; bundle_adjustment.h and marginalization.h work on it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "nav/api/geometry.h"
#include "nav/api/time.h"
#include "nav/inertial/inertial_edge.h"
#include "nav/stereo/reprojection.h"

namespace polnav::nav {

// Headings that the polarimeter fakes, constants that the window finds out on the way [rad]:
//   0     by a turn in its mounting
//   1..4  by the cosine and sine of twice, and of four times, the light's axis: channels that are
//         not equal, polarizers that are crooked
inline constexpr int kSkyErrors = 5;
using SkyErrors = Eigen::Matrix<double, kSkyErrors, 1>;

// Of (dp, dtheta), of (dv, dgyro_bias, daccel_bias), zero without an IMU, and of the sky's errors.
inline constexpr int kState = 15 + kSkyErrors;
using StateCovariance = Eigen::Matrix<double, kState, kState>;

// Compass heading of a keyframe from polarization, the half turn already chosen.
struct HeadingEdge {
  double heading_rad = 0.0;
  double sigma_rad = 0.0;
  SkyErrors by_errors = SkyErrors::Zero();  // of the heading that is read
  // The heading that the sky gives changes by this times a tilt about W's east and north, against
  // the attitude that it was found with. Zero: the heading alone counts [Chu2021, eq. 15].
  Eigen::Vector2d by_tilt = Eigen::Vector2d::Zero();
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
};

// "Up" in B, unit vector: what the accelerometer knows of an attitude.
struct LevelEdge {
  Eigen::Vector3d up_B = Eigen::Vector3d::UnitZ();
  double sigma_rad = 0.0;
};

// What is known of a keyframe's motion where no readings connect it to the one before.
struct MotionPrior {
  Motion mean;
  Eigen::Vector3d sigmas;  // of velocity [m/s], gyro bias [rad/s], accelerometer bias [m/s^2]
};

// How far the step from the keyframe before may be off when vision did not follow it.
struct CoastSigmas {
  double position_m = 0.0;
  double angle_rad = 0.0;
};

struct Keyframe {
  std::uint64_t id = 0;
  TimeNs stamp = 0;
  Pose T_WB;
  std::optional<HeadingEdge> heading;
  std::optional<CoastSigmas> coasted;
  // With an IMU; not on the window's first keyframe, whose past is the window's prior.
  Motion motion;
  std::optional<InertialEdge> inertial;  // from the keyframe before
  std::optional<MotionPrior> motion_prior;
};

struct Sighting {
  std::uint64_t keyframe = 0;  // Keyframe::id
  StereoPixel pixel;
};

struct Landmark {
  std::uint64_t host = 0;           // Keyframe::id, always one in the window
  Eigen::Vector3d coordinates;      // (X/Z, Y/Z, 1/Z) in the host's camera
  std::vector<Sighting> sightings;  // in order of keyframes; the host's own is first
};

// 1/2 | residual + jacobian * delta |^2 where delta stacks Difference(pose, linearized) of the
// first keyframes of the window, in their order, then, with an IMU, the first one's motion minus
// where it is linearized, and last, in a window, the sky's errors, likewise.
struct Prior {
  std::vector<Pose> linearized;
  std::optional<Motion> motion;
  std::optional<SkyErrors> errors;
  Eigen::MatrixXd jacobian;
  Eigen::VectorXd residual;
};

struct Window {
  bool inertial = false;                        // the rig has an IMU: motions are estimated
  std::deque<Keyframe> keyframes;               // oldest first
  std::map<std::uint64_t, Landmark> landmarks;  // by track id: ordered, so that sums are too
  SkyErrors errors = SkyErrors::Zero();
  Prior prior;
};

// Position of a keyframe in the window. Throws std::logic_error when it has slid out.
[[nodiscard]] std::size_t IndexOf(const Window& window, std::uint64_t keyframe);

// Of each keyframe.
[[nodiscard]] std::vector<Viewpoint> ViewpointsOf(const RectifiedCamera& camera,
                                                  const Window& window);

}  // namespace polnav::nav
