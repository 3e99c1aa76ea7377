// Where is a point given along and across the road?
//
// s: arc length; offset: metres to the left of the centre line, towards the inside of the loop.
// Deep inside, where normals of the road would cross, the offset runs straight to the centre.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

#include "sim/world/terrain.h"
#include "sim/world/track.h"

namespace polnav::sim {

class StreetFrame {
 public:
  StreetFrame(const Track& track, const Terrain& terrain) : track_(track), terrain_(terrain) {}

  [[nodiscard]] Eigen::Vector3d At(double s_m, double offset_m, double lift_m = 0.0) const {
    const Track::Point point = track_.At(s_m);
    const Eigen::Vector2d left(-point.tangent.y(), point.tangent.x());
    const double straight_from = 0.4 * track_.mean_radius_m();
    Eigen::Vector2d p = point.p_m + std::min(offset_m, straight_from) * left;
    if (offset_m > straight_from) {
      const double share = (offset_m - straight_from) / (track_.mean_radius_m() - straight_from);
      p += share * (track_.center_m() - p);
    }
    return OnGround(p, lift_m);
  }

  [[nodiscard]] Eigen::Vector3d OnGround(const Eigen::Vector2d& p_m, double lift_m) const {
    return {p_m.x(), p_m.y(), terrain_.Height(p_m.x(), p_m.y()) + lift_m};
  }

  [[nodiscard]] Eigen::Vector3d NormalAt(const Eigen::Vector2d& p_m) const {
    return terrain_.Normal(p_m.x(), p_m.y());
  }

  // Direction of driving, counter-clockwise from east [rad].
  [[nodiscard]] double Yaw(double s_m) const {
    const Eigen::Vector2d t = track_.At(s_m).tangent;
    return std::atan2(t.y(), t.x());
  }

  [[nodiscard]] double half_road_m() const { return 0.5 * track_.road_width_m(); }
  [[nodiscard]] double length_m() const { return track_.length_m(); }
  [[nodiscard]] double radius_m() const { return track_.mean_radius_m(); }
  [[nodiscard]] const Eigen::Vector2d& center_m() const { return track_.center_m(); }

 private:
  const Track& track_;
  const Terrain& terrain_;
};

// Cross section, in offsets from the road's edges.
inline constexpr double kKerbHeight_m = 0.12;
inline constexpr double kKerbWidth_m = 0.3;
inline constexpr double kBayWidth_m = 2.3;       // parked cars, outside the road
inline constexpr double kInnerPath_m = 3.0;      // paved, inside the inner kerb
inline constexpr double kOuterPavement_m = 6.0;  // outside the outer kerb
inline constexpr double kVerge_m = 4.0;          // grass beyond it

}  // namespace polnav::sim
