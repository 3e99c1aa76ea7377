#include "tests/testbed/example_run.h"

#include <cmath>
#include <numbers>

namespace polnav::testbed {

std::string ExampleScenarioYaml() {
  return R"(name: example
description: A car on a circle
paper: [Chu2021]
duration_s: 60
seed: 42
site:
  latitude_deg: 38.832
  longitude_deg: 121.503
  utc: 2020-11-11T07:00:00Z
sensors:
  stereo: {}
  imu: {rate_hz: 100}
  polarimeter: {rate_hz: 20}
estimators:
  run: [stereo, stereo_polarization]
criteria:
  - name: heading is good
    metric: estimators.stereo_polarization.heading_deg.rmse
    at_most: 1.0
  - name: the sky helps
    metric: estimators.stereo_polarization.heading_deg.rmse
    below: estimators.stereo.heading_deg.rmse
)";
}

RunRecord ExampleRun(const Scenario& scenario, const RunOptions& options,
                     const std::function<void(double)>& progress) {
  RunRecord record;
  record.sim_duration_s = scenario.duration_s;
  record.wall_s = 2.0;
  record.peak_rss_mb = 300.0;
  const int n = static_cast<int>(scenario.duration_s * 10.0);
  for (int i = 0; i <= n; ++i) {
    const double angle = 0.1 * i * 6.0 / 60.0;
    sim::Truth truth{.stamp = i * 100'000'000LL};
    truth.T_WB.q = nav::LevelAttitude(-angle);
    truth.T_WB.p = {60.0 * std::cos(angle) - 60.0, 60.0 * std::sin(angle), 0.0};
    record.truth.push_back(truth);
    if (progress) progress(static_cast<double>(i) / n);
  }
  for (const std::string& name : scenario.estimators.run) {
    EstimatorRun run{.name = name};
    const double error_rad = nav::DegToRad(name == "stereo" ? 2.0 : 0.5);
    for (const sim::Truth& truth : record.truth) {
      nav::Estimate e{.stamp = truth.stamp, .T_WB = truth.T_WB};
      e.T_WB.q = nav::LevelAttitude(nav::CompassHeading(truth.T_WB.q) + error_rad);
      e.T_WB.p += Eigen::Vector3d(0.3, 0.4, 0.0);
      e.covariance = nav::Matrix6d::Identity() * 1e-3;
      e.tracked = true;
      run.estimates.push_back(e);
    }
    run.sha256 = HashOf(run.estimates);
    record.estimators.push_back(std::move(run));
  }
  record.streams["imu"] = {6000 + options.seed, std::string(64, 'a')};
  record.timing["render"].ms = {1.0, 2.0, 3.0};
  record.rss_mb = {100.0, 200.0, 300.0};
  record.polarization_readings = {{0.0, 0.01}, {0.05, -0.02}};
  cv::Mat picture(40, 60, CV_8UC1, cv::Scalar(90));
  picture.row(20) = 200;
  record.images.push_back({"left <camera>", 0, picture});
  return record;
}

}  // namespace polnav::testbed
