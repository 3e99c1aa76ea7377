// Where is the optical-flow sensor, frame by frame, and what do its gyroscopes and its sonar say?
//
//   F  at position_m in B; nominally x forward, y right, z down, as a PX4Flow's board counts
// The part of the sensor that needs no picture, at both levels: it hears the truth at every frame
// and hands over an interval when a reading is due. What the picture then says is for
// optical_flow_camera.h or, at measurement level, optical_flow_model.h.
// Focal length, mounting, gyroscopes and sonar are a particular unit's, drawn once a trial.
// The gyroscopes' bias does not wander: a run is short against the minutes in which it would.
#pragma once

#include <cstdint>
#include <optional>

#include "nav/api/calibration.h"
#include "sim/random.h"
#include "sim/sensors/flow_interval.h"
#include "sim/sensors/flow_range.h"
#include "sim/sensors/optical_flow_options.h"
#include "sim/truth.h"
#include "sim/world/occlusion.h"
#include "sim/world/terrain.h"

namespace polnav::sim {

// What an estimator is told.
[[nodiscard]] nav::OpticalFlowCalibration NominalOpticalFlow(const OpticalFlowOptions& options);

// The camera as it really is.
struct TrueFlowCamera {
  nav::Pose T_BF;
  double focal_px = 0.0;
};
[[nodiscard]] TrueFlowCamera DrawTrueFlowCamera(const OpticalFlowOptions& options,
                                                std::uint64_t seed, std::uint64_t trial);

class OpticalFlow {
 public:
  // Terrain and occlusion must outlive it. occlusion null: nothing stands on the ground.
  OpticalFlow(const OpticalFlowOptions& options, const Terrain& terrain, const Occlusion* occlusion,
              std::uint64_t seed, std::uint64_t trial);

  // At every frame, in order; the first is at time zero. An interval whenever a reading is due.
  [[nodiscard]] std::optional<FlowInterval> Look(const Truth& truth);

 private:
  [[nodiscard]] Eigen::Vector3d ReadGyro(const Eigen::Quaterniond& q_WF, double dt_s);
  void Measure(FlowInterval& interval) const;

  OpticalFlowOptions options_;
  const Terrain& terrain_;
  const Occlusion* occlusion_;
  TrueFlowCamera camera_;
  RangeFinder range_;
  std::size_t frames_per_reading_;
  Eigen::Vector3d gyro_bias_rad_s_;
  Eigen::Vector3d gyro_scale_;
  RandomStream gyro_noise_;
  std::uint64_t frame_ = 0;
  FlowInterval interval_;
};

}  // namespace polnav::sim
