// Where is a walking robot, by the filter as Zeng2020 prints it?
//
// n = 10: position, velocity and quaternion of B in W. The IMU predicts, without biases [Zeng2020,
// eq. 1]; corrections are the heading of a sky above a level sensor [Zeng2020, eqs 9-10] and the
// velocity that optical flow and the range to the ground give, upwards by the range's change
// [Zeng2020, eqs 11-15]. 2n + 1 sigma points of weights 1/(2n), none at the centre [Zeng2020, eqs
// 17-24]; quaternions are averaged as vectors and normalized.
// As printed but for what a run needs: sensors that are not at B's origin have their lever arms
// taken out, as the paper assumes done; a covariance that is not definite is mended.
// With start.standing_s it stands for so long first, as an inertial navigator is aligned: the mean
// rates of both sensors' gyroscopes and what the force has beyond gravity are taken off all
// readings after, and level is where the force points. The paper does not speak of it. Fails as it
// must: biases go into tilt and velocity, tilt into the heading; nothing is gated.
#pragma once

#include <optional>

#include "nav/api/calibration.h"
#include "nav/api/estimate.h"
#include "nav/api/measurements.h"
#include "nav/ukf/options.h"
#include "nav/ukf/standing.h"
#include "nav/ukf/ukf.h"

namespace polnav::nav {

class PaperUkf {
 public:
  // Throws std::invalid_argument like nav::Ukf. sky: of its options only the self-checks count.
  PaperUkf(const PaperUkfOptions& options, const ImuCalibration& imu,
           const OpticalFlowCalibration& flow, const StartPrior& start,
           std::optional<SkySource> sky);

  [[nodiscard]] Report Process(const Measurement& measurement);

 private:
  static constexpr int kSize = 10;
  static constexpr int kPoints = 2 * kSize;
  using Vector = Eigen::Matrix<double, kSize, 1>;  // p, v, q as w x y z
  using Square = Eigen::Matrix<double, kSize, kSize>;
  using Points = Eigen::Matrix<double, kSize, kPoints>;

  [[nodiscard]] Outcome TakeImu(const ImuSample& sample);
  [[nodiscard]] bool StandsYet(TimeNs stamp) const;
  void Align();
  [[nodiscard]] Outcome TakeFlow(const OpticalFlowSample& sample, Report& report);
  [[nodiscard]] Outcome TakeLight(const PolarizationSample& sample, Report& report);
  void Begin(TimeNs stamp);
  [[nodiscard]] Points SigmaPoints(Report* report);
  template <int Z>
  [[nodiscard]] bool Correct(const Eigen::Matrix<double, Z, kPoints>& expected,
                             const Eigen::Matrix<double, Z, 1>& measured,
                             const Eigen::Matrix<double, Z, 1>& variance, const Points& points,
                             Innovation innovation, Report& report);
  [[nodiscard]] Estimate Answer() const;

  PaperUkfOptions options_;
  ImuCalibration imu_;
  OpticalFlowCalibration flow_;
  StartPrior start_;
  std::optional<SkySource> sky_;
  TimeNs interval_;

  ukf::Standing standing_;
  std::optional<TimeNs> began_;
  bool aligned_ = false;
  ukf::StandingErrors errors_;  // taken off the IMU's readings
  // What the flow sensor's own gyroscopes turned while the robot stood, and in which time.
  Eigen::Vector3d flow_turned_rad_ = Eigen::Vector3d::Zero();
  double flow_stood_s_ = 0.0;
  Eigen::Vector2d flow_bias_rad_s_ = Eigen::Vector2d::Zero();

  std::optional<TimeNs> now_;
  Vector x_ = Vector::Zero();
  Square P_ = Square::Zero();
  Eigen::Vector3d rate_B_ = Eigen::Vector3d::Zero();  // newest, for lever arms
  std::optional<OpticalFlowSample> ranged_;           // the newest flow with a range
  std::optional<PolarizationSample> newest_light_;
  TimeNs answered_ = 0;
};

}  // namespace polnav::nav
