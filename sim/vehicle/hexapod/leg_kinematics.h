// Where is a foot for these joint angles, and which angles bring it there?
//
//   H  a leg's root: at the coxa's joint on the body's rim, x outwards, z as B's
// Angles (coxa, femur, tibia) [rad]: the coxa turns about z, counterclockwise from above; femur and
// tibia turn upwards from straight on. All zero: the leg is stretched out level.
#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>

#include "nav/api/geometry.h"
#include "sim/vehicle/hexapod/hexapod_options.h"

namespace polnav::sim {

inline constexpr int kLegs = 6;
inline constexpr int kJointsOfLeg = 3;

// Roots in order: front left, middle left, rear left, rear right, middle right, front right: every
// second leg is a tripod.
[[nodiscard]] std::array<nav::Pose, kLegs> LegRoots(const HexapodOptions& options);  // T_BH

[[nodiscard]] Eigen::Vector3d FootOf(const LegOptions& leg, const Eigen::Vector3d& angles_rad);

// The knee bends upwards. Nothing when the foot is out of the leg's reach or a joint's range.
[[nodiscard]] std::optional<Eigen::Vector3d> AnglesFor(const LegOptions& leg,
                                                       const Eigen::Vector3d& foot_H_m);

}  // namespace polnav::sim
