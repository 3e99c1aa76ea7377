#include "sim/world/actor.h"

#include <algorithm>

namespace polnav::sim {
namespace {

// The point at `share` of the way from b to c, with slopes that a and d set [per the times given].
Eigen::Vector3d Hermite(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                        const Eigen::Vector3d& slope_from, const Eigen::Vector3d& slope_to,
                        double share) {
  const double s2 = share * share;
  const double s3 = s2 * share;
  return (2.0 * s3 - 3.0 * s2 + 1.0) * from + (s3 - 2.0 * s2 + share) * slope_from +
         (3.0 * s2 - 2.0 * s3) * to + (s3 - s2) * slope_to;
}

// Velocity at a key from its neighbours: at an end, from the one there is [m/s].
Eigen::Vector3d VelocityAt(const std::vector<ActorKey>& path, std::size_t i) {
  const ActorKey& before = path[i == 0 ? 0 : i - 1];
  const ActorKey& after = path[std::min(i + 1, path.size() - 1)];
  return (after.T_WA.p - before.T_WA.p) / nav::ToSeconds(after.stamp - before.stamp);
}

}  // namespace

std::optional<nav::Pose> PoseOf(const std::vector<ActorKey>& path, nav::TimeNs stamp) {
  if (path.empty() || stamp < path.front().stamp || stamp > path.back().stamp) return std::nullopt;
  const auto after = std::upper_bound(path.begin(), path.end(), stamp,
                                      [](nav::TimeNs t, const ActorKey& k) { return t < k.stamp; });
  if (after == path.end()) return path.back().T_WA;
  const auto i = static_cast<std::size_t>(after - path.begin()) - 1;
  const double step_s = nav::ToSeconds(path[i + 1].stamp - path[i].stamp);
  const double share = nav::ToSeconds(stamp - path[i].stamp) / step_s;
  nav::Pose pose;
  pose.p = Hermite(path[i].T_WA.p, path[i + 1].T_WA.p, step_s * VelocityAt(path, i),
                   step_s * VelocityAt(path, i + 1), share);
  pose.q = path[i].T_WA.q.slerp(share, path[i + 1].T_WA.q);
  return pose;
}

}  // namespace polnav::sim
