// How far is an estimated trajectory from the truth?
//
// The definitions of evo (Michael Grupp, github.com/MichaelGrupp/evo), number for number: nearest
// stamps, Umeyama alignment without scale, absolute (APE; its translation part is the ATE) and
// relative errors (RPE) over consecutive pairs by distance travelled. Errors in metres and radians.
// Needs enough motion: an alignment of poses on one line is refused, and a run shorter than a
// pair's distance has no RPE.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/testbed/trajectory.h"

namespace polnav::testbed {

// Truth and estimate of one instant.
struct PosePair {
  nav::TimeNs stamp = 0;  // the estimate's
  nav::Pose truth;
  nav::Pose estimate;
};

// evo's rule: each pose of the shorter trajectory (the estimate when equally long) gets the nearest
// of the other, unless that is more than max_difference away.
[[nodiscard]] std::vector<PosePair> Associate(const Trajectory& truth, const Trajectory& estimate,
                                              nav::TimeNs max_difference = kTogether);

enum class Alignment {
  kNone,
  kYaw,  // rotation about the vertical and translation: what gravity leaves unknown
  kSe3,  // rotation and translation, Umeyama without scale
};

// "none", "yaw", "se3".
[[nodiscard]] const char* NameOf(Alignment alignment);

// T_WE maps the estimate's world into the truth's, least squares over the positions. Nothing when
// the positions do not determine it (all on one line; for yaw: all above each other).
[[nodiscard]] std::optional<nav::Pose> Align(const std::vector<PosePair>& pairs,
                                             Alignment alignment);

// Every estimate moved by T_WE.
[[nodiscard]] std::vector<PosePair> Moved(const nav::Pose& T_WE, std::vector<PosePair> pairs);

[[nodiscard]] std::vector<double> ApeTranslation(const std::vector<PosePair>& pairs);
[[nodiscard]] std::vector<double> ApeAngle(const std::vector<PosePair>& pairs);

// evo's pairs by path: after every delta_m travelled by the *estimate* an index is noted, the count
// starting anew there; pairs are consecutive indices. What is travelled before the first index
// belongs to no pair.
[[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> PairsByPath(
    const std::vector<PosePair>& pairs, double delta_m);

// E = (Q_i^-1 Q_j)^-1 (P_i^-1 P_j) of truth Q and estimate P over each pair.
struct RelativeErrors {
  std::vector<double> translation_m;
  std::vector<double> angle_rad;
};
[[nodiscard]] RelativeErrors Rpe(const std::vector<PosePair>& pairs, double delta_m);

// [rad], in [0, pi].
[[nodiscard]] double RotationAngle(const Eigen::Quaterniond& q);

}  // namespace polnav::testbed
