// Where is a walking robot, from its IMU, optical flow, range and the polarized sky?
//
// An unscented Kalman filter [Julier2004] [Wan2000] on the manifold [Hertzberg2013]: the IMU
// predicts (predict.h), optical flow and range (ground_sensors.h) and the sky (sky_sensor.h)
// correct. Position, velocity, attitude and both biases (n = 15), and seven slow errors of the
// sensors (state.h). Never assumes that the robot stands still. What comes late is put where it
// belongs (timeline.h); what is refused for long makes the filter doubt itself (doubt.h).
//   ukf                     with the sky
//   ukf_no_polarization     without: heading is dead reckoning, and its covariance says so
// Fails where feet are in the air for long without flow: an accelerometer alone loses the position
// within seconds, which the covariance says too.
#pragma once

#include <optional>
#include <vector>

#include "nav/api/calibration.h"
#include "nav/api/estimate.h"
#include "nav/api/measurements.h"
#include "nav/polarization/heading_fusion.h"
#include "nav/ukf/doubt.h"
#include "nav/ukf/options.h"
#include "nav/ukf/predict.h"
#include "nav/ukf/sky_sensor.h"
#include "nav/ukf/timeline.h"

namespace polnav::nav {

// What a filter takes from the sky.
struct SkySource {
  PolarizationOptions options;
  PolarimeterCalibration calibration;
  SunModel sun;
};

class Ukf {
 public:
  // Throws std::invalid_argument for a sigma that is negative or no number, or an IMU without rate.
  Ukf(const UkfOptions& options, const ImuCalibration& imu, const OpticalFlowCalibration& flow,
      const StartPrior& start, std::optional<SkySource> sky);

  [[nodiscard]] Report Process(const Measurement& measurement);

  // Nothing before the first reading of the IMU.
  [[nodiscard]] std::optional<Estimate> Now() const;

 private:
  using What = std::variant<ukf::Step, OpticalFlowSample, PolarizationSample>;
  struct Waiting {
    TimeNs stamp;
    What what;
  };

  // For Tell.
  struct Reading {
    std::string_view sensor;
    int dof;
    Eigen::Vector2d residual;  // in the unit of what is doubted
    ukf::Doubt* doubt;
    Eigen::Index at;  // the errors that become less certain
    int count;
  };

  [[nodiscard]] Outcome TakeImu(const ImuSample& sample, Report& report);
  [[nodiscard]] Outcome Take(TimeNs stamp, const What& what, Report& report);
  [[nodiscard]] bool IsUsable(const OpticalFlowSample& sample) const;
  [[nodiscard]] bool IsUsable(const PolarizationSample& sample);
  void Begin(TimeNs stamp);
  void StepTo(TimeNs stamp, const ukf::Step& step);
  void CoastTo(TimeNs stamp);
  void TakeWaiting(TimeNs until, const ukf::Step& step, Report& report);
  [[nodiscard]] Outcome InsertLate(TimeNs stamp, const What& what, Report& report);

  // Works out the state after an entry from the one before. report: null when it is done again.
  Outcome Run(std::size_t place, Report* report);
  Outcome RunFlow(std::size_t place, const OpticalFlowSample& sample, Report* report);
  Outcome RunRange(const OpticalFlowSample& sample, ukf::Entry& entry, Report* report);
  Outcome RunSky(const PolarizationSample& sample, ukf::Entry& entry, Report* report);
  // What became of a reading goes into the report.
  void Tell(const Reading& reading, TimeNs stamp, const ukf::Correction& done, ukf::Entry& entry,
            Report& report);

  UkfOptions options_;
  ImuCalibration imu_;
  ukf::GroundSensor ground_;
  StartPrior start_;
  std::optional<SkySource> sky_;
  Eigen::Quaterniond q_IS_ = Eigen::Quaterniond::Identity();
  ukf::ProcessNoise noise_;
  TimeNs interval_;  // of the IMU
  ukf::Timeline timeline_;
  std::vector<Waiting> waiting_;  // for the IMU, in order of stamps
  ukf::Doubt sky_doubt_;
  ukf::Doubt flow_doubt_;
  ukf::Doubt range_doubt_;
  std::optional<PolarizationSample> newest_light_;
  std::optional<TimeNs> seen_;  // the ground, last
  TimeNs answered_ = 0;
};

}  // namespace polnav::nav
