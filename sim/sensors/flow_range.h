// How far is it along a sensor's axis to the ground, and what does a sonar make of it?
//
// The ground is the terrain, near the sensor a plane. What stands or moves on it counts where the
// world has such things: the nearest within the sonar's beam (its axis and four rays on the cone),
// and for the camera what is on the axis. A real sonar also hears the ground nearer than along the
// axis when it is tilted (by 0.06 percent at 2 degrees), gets its echoes at 10 Hz rather than with
// every reading, and loses them on soft or steep ground [MB1043]: not in it, but for drop-outs
// that come at random.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>

#include "nav/api/geometry.h"
#include "nav/api/time.h"
#include "sim/random.h"
#include "sim/sensors/optical_flow_options.h"
#include "sim/world/occlusion.h"
#include "sim/world/terrain.h"

namespace polnav::sim {

// The ground about where the axis meets it.
struct GroundPlane {
  Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal_W = Eigen::Vector3d::UnitZ();

  // Along F's z. Nothing when it does not point at the plane, or at less than 6 degrees.
  [[nodiscard]] std::optional<double> Distance(const nav::Pose& T_WF) const;
};
[[nodiscard]] GroundPlane GroundAlong(const Terrain& terrain, const nav::Pose& T_WF);

// On the axis and within the beam; nothing where there is none.
struct ThingsAhead {
  std::optional<double> on_axis_m;
  std::optional<double> in_beam_m;
};
[[nodiscard]] ThingsAhead LookForThings(const Occlusion& occlusion, const nav::Pose& T_WF,
                                        nav::TimeNs stamp, double beam_rad);

// One unit: bias and scale are drawn once a trial.
class RangeFinder {
 public:
  RangeFinder(const OpticalFlowOptions& options, std::uint64_t seed, std::uint64_t trial);

  // index: of the reading. Any order. Absent: out of range, or no echo.
  [[nodiscard]] std::optional<double> Read(std::optional<double> distance_m,
                                           std::uint64_t index) const;

 private:
  OpticalFlowOptions options_;
  double bias_m_;
  double scale_;
  RandomStream noise_;
};

}  // namespace polnav::sim
