// Which way does an actor go, and when?
//
// Makers of ActorKeys at constant speed, on the terrain: along the road, or along a smooth curve
// through given points. Vehicles lean with the ground, people stand upright. Keys do not depend on
// when the path ends, except for being there.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "sim/world/scene.h"
#include "sim/world/street_frame.h"

namespace polnav::sim {

enum class Stance { kOnWheels, kUpright };

// Along the ring road, laps without end. At the instant at_s it is at arc length s_m.
struct RoadRun {
  double s_m = 0.0;
  double at_s = 0.0;
  double offset_m = 0.0;   // to the left of the centre line as driven
  double speed_m_s = 8.0;  // of arc length; negative: against the driving direction
  double begin_s = 0.0;    // it is there from then
  double end_s = 60.0;     // until then, or a second or two longer
  double lift_m = 0.0;     // above the terrain, for the pavement
  Stance stance = Stance::kOnWheels;
};
[[nodiscard]] std::vector<ActorKey> AlongRoad(const StreetFrame& street, const RoadRun& run);

// Throws std::invalid_argument when there are fewer than two points or two in a row are the same.
void CheckPath(const std::vector<Eigen::Vector2d>& points_m);

// Along a Catmull-Rom curve through two points or more (east, north) [m]: a straight line for two.
// From the first point at begin_s to the last one, where it vanishes; or round and round until
// end_s, the last point being followed by the first; to and fro between two. Throws as CheckPath.
struct PointRun {
  std::vector<Eigen::Vector2d> points_m;
  double speed_m_s = 1.4;
  double begin_s = 0.0;
  double end_s = 60.0;
  bool loop = false;
  double lift_m = 0.0;
  Stance stance = Stance::kUpright;
};
[[nodiscard]] std::vector<ActorKey> AlongPolyline(const StreetFrame& street, const PointRun& run);

}  // namespace polnav::sim
