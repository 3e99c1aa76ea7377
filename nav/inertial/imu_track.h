// How has the IMU moved since the last keyframe?
//
// Sums up readings from frame to frame, predicts each frame from the last keyframe's state, and
// gives the edge between two keyframes. When readings are missing, or not to be trusted, there is
// no answer until the next keyframe.
#pragma once

#include <optional>

#include "nav/graph/window.h"
#include "nav/inertial/imu_buffer.h"
#include "nav/inertial/inertial_edge.h"

namespace polnav::nav {

class ImuTrack {
 public:
  ImuTrack(const ImuCalibration& calibration, const InertialOptions& options);

  Outcome Add(const ImuSample& sample) { return buffer_.Add(sample); }

  // A keyframe at the newest frame: the sum begins anew.
  void Begin(TimeNs stamp, const Motion& motion);

  // It has gone wrong: until then there is no answer.
  void Distrust(TimeNs until);

  // Up to the next frame.
  void Advance(TimeNs stamp);

  // The newest frame by its keyframe's state; see nav::Predict.
  [[nodiscard]] std::optional<InertialPrediction> Predict(const Keyframe& keyframe,
                                                          const Matrix15d& covariance) const;

  // Makes the newest frame, a keyframe now, follow the one before: an edge, or where readings are
  // missing what is known of its motion without.
  void Connect(const Motion& before, const Matrix15d& covariance, Keyframe& keyframe);

  // Of a motion that nothing is known of: (dv, dgyro_bias, daccel_bias).
  [[nodiscard]] Matrix9d StartCovariance() const;

 private:
  [[nodiscard]] BiasWalk WalkSinceKeyframe();

  InertialOptions options_;
  Pose T_BI_;
  ImuNoise noise_;
  ImuBuffer buffer_;
  TimeNs at_ = 0;
  Preintegration sum_;
  bool complete_ = false;
  TimeNs distrusted_until_ = 0;
  Eigen::Vector3d slow_rate_ = Eigen::Vector3d::Zero();  // mean of the last seconds
};

}  // namespace polnav::nav
