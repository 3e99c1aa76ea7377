// What does the sliding window hold?
//
// The graph of [Chu2021, eqs 13-16]: vertices are keyframe poses and landmarks; edges are stereo
// reprojections (e1-e3), headings from polarization (e4), the accelerometer's level, and the prior
// that marginalization leaves of what has slid out. Plain data; bundle_adjustment.h and
// marginalization.h work on it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "nav/api/geometry.h"
#include "nav/api/time.h"
#include "nav/stereo/reprojection.h"

namespace polnav::nav {

// Compass heading of a keyframe from polarization, the half turn already chosen.
struct HeadingEdge {
  double heading_rad = 0.0;
  double sigma_rad = 0.0;
};

// "Up" in B, unit vector, from the accelerometer (nav/stereo/levelling.h).
struct LevelEdge {
  Eigen::Vector3d up_B = Eigen::Vector3d::UnitZ();
  double sigma_rad = 0.0;
};

struct Keyframe {
  std::uint64_t id = 0;
  TimeNs stamp = 0;
  Pose T_WB;
  std::optional<HeadingEdge> heading;
  std::optional<LevelEdge> level;
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
// first keyframes of the window, in their order.
struct Prior {
  std::vector<Pose> linearized;
  Eigen::MatrixXd jacobian;
  Eigen::VectorXd residual;
};

struct Window {
  std::deque<Keyframe> keyframes;               // oldest first
  std::map<std::uint64_t, Landmark> landmarks;  // by track id: ordered, so that sums are too
  Prior prior;
};

// Position of a keyframe in the window. Throws std::logic_error when it has slid out.
[[nodiscard]] std::size_t IndexOf(const Window& window, std::uint64_t keyframe);

}  // namespace polnav::nav
