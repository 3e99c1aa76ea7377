#include "tools/testbed/closed_loop.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <stdexcept>

#include "nav/stereo/tracker.h"
#include "sim/faults/fault_injector.h"
#include "sim/measurement_stream.h"
#include "sim/random.h"
#include "tools/testbed/calibration_turn.h"
#include "tools/testbed/estimators.h"
#include "tools/testbed/ground_truth_files.h"
#include "tools/testbed/memory_use.h"
#include "tools/testbed/polarization_readings.h"
#include "tools/testbed/stream_hash.h"

namespace polnav::testbed {
namespace {

using Clock = std::chrono::steady_clock;

double MsSince(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

// What the scenario grants: the true start, blurred by the sigmas that it states.
nav::StartPrior GrantStart(const StartOptions& start, const sim::Truth& truth,
                           const RunOptions& options) {
  sim::RandomStream::Sample draw =
      sim::RandomStream(options.seed, options.trial, "estimators/start").At(0);
  nav::StartPrior prior{.position_sigma_m = start.position_sigma_m,
                        .heading_sigma_rad = nav::DegToRad(start.heading_sigma_deg),
                        .level_sigma_rad = nav::DegToRad(start.level_sigma_deg)};
  prior.heading_rad = nav::CompassHeading(truth.T_WB.q) + prior.heading_sigma_rad * draw.Gaussian();
  for (int i = 0; i < 3; ++i) {
    prior.p_WB_m(i) = truth.T_WB.p(i) + prior.position_sigma_m * draw.Gaussian();
  }
  return prior;
}

struct RunningEstimator {
  EstimatorRun run;
  AnyEstimator estimator;
};

// The corners that the front end follows.
cv::Mat DrawFeatures(const cv::Mat& image, const std::vector<cv::Point2f>& points) {
  cv::Mat drawn;
  cv::cvtColor(image, drawn, cv::COLOR_GRAY2BGR);
  for (const cv::Point2f& p : points) {
    cv::circle(drawn, p, 3, cv::Scalar(60, 220, 60), 1, cv::LINE_AA);
  }
  return drawn;
}

// What the estimators are told about the sensors.
nav::Rig RigFor(const Scenario& scenario, const RunOptions& options) {
  nav::Rig rig = sim::NominalRig(scenario.sensors);
  if (rig.polarization_camera && scenario.estimators.calibrate_sky_camera) {
    const auto turn = TakeCalibrationTurn(*scenario.sensors.polarization_camera, scenario.sky,
                                          options.seed, options.trial);
    rig.polarization_camera =
        nav::CalibrateFromTurn(scenario.estimators.compass, *rig.polarization_camera, turn)
            .calibration;
  }
  return rig;
}

class Loop {
 public:
  Loop(const Scenario& scenario, const RunOptions& options)
      : scenario_(scenario),
        options_(options),
        rig_(RigFor(scenario, options)),
        duration_(nav::FromSeconds(scenario.duration_s)),
        faults_(scenario.faults, rig_, options.seed, options.trial),
        readings_(rig_.polarimeter, SunFor(scenario.site)) {
    const auto& run = scenario.estimators.run;
    const bool describe = std::any_of(run.begin(), run.end(), [&](const std::string& name) {
      return ClosesLoops(scenario, name);
    });
    if (!options.ground_truth_folder.empty()) {
      ground_truth_.emplace(
          options.ground_truth_folder,
          sim::DrawTrueStereo(*scenario.sensors.stereo, options.seed, options.trial));
    }
    if (rig_.stereo) tracker_.emplace(scenario.estimators.stereo.tracker, *rig_.stereo, describe);
  }

  RunRecord Run(const std::function<void(double)>& progress) {
    const auto begin = Clock::now();
    sim::MeasurementStream stream({scenario_.site, scenario_.sky, scenario_.world,
                                   scenario_.vehicle, scenario_.sensors, scenario_.disturbances},
                                  {options_.seed, options_.trial}, duration_,
                                  options_.render_threads);
    while (const auto item = stream.Next()) {
      if (const auto* truth = std::get_if<sim::Truth>(&*item)) {
        Take(*truth);
        if (progress) progress(nav::ToSeconds(truth->stamp) / scenario_.duration_s);
      } else if (const auto* frame = std::get_if<sim::FrameTruth>(&*item)) {
        if (ground_truth_) ground_truth_->Write(*frame);
      } else {
        for (const nav::Measurement& arrived : faults_.Take(std::get<nav::Measurement>(*item))) {
          Take(arrived);
        }
      }
    }
    for (const nav::Measurement& arrived : faults_.Flush()) Take(arrived);
    if (ground_truth_) ground_truth_->Commit();
    Finish(stream.picture_ms());
    record_.wall_s = MsSince(begin) * 1e-3;
    return std::move(record_);
  }

 private:
  void Take(const sim::Truth& truth) {
    if (record_.truth.empty()) StartEstimators(truth);
    record_.truth.push_back(truth);
    HashTruth(truth, hashes_["truth"]);
    ++record_.streams["truth"].count;
    // A hundred looks at the memory over the run.
    const double due = scenario_.duration_s * static_cast<double>(record_.rss_mb.size()) / 100.0;
    if (nav::ToSeconds(truth.stamp) >= due) record_.rss_mb.push_back(ResidentMemoryMb());
  }

  void StartEstimators(const sim::Truth& truth) {
    const nav::StartPrior start = GrantStart(scenario_.estimators.start, truth, options_);
    for (const std::string& name : scenario_.estimators.run) {
      estimators_.push_back({{.name = name, .heading_only = InfoOf(name).heading_only},
                             MakeEstimator(name, scenario_, rig_, start)});
    }
  }

  void Take(const nav::Measurement& measurement) {
    const auto begin = Clock::now();
    const std::string stream = StreamName(measurement);
    HashMeasurement(measurement, hashes_[stream]);
    ++record_.streams[stream].count;
    if (const auto* images = std::get_if<nav::StereoImages>(&measurement)) {
      record_.timing["hash"].ms.push_back(MsSince(begin));
      TakeImages(*images);
      return;
    }
    if (const auto* light = std::get_if<nav::PolarizationSample>(&measurement)) {
      readings_.Add(*light);
    }
    if (const auto* sky = std::get_if<nav::PolarizationImage>(&measurement)) KeepSkyImage(*sky);
    for (RunningEstimator& e : estimators_) {
      const auto estimator_begin = Clock::now();
      Feed(measurement, e);
      // Only pictures take a time worth a line in the report.
      if (std::holds_alternative<nav::PolarizationImage>(measurement)) {
        record_.timing[e.run.name].ms.push_back(MsSince(estimator_begin));
      }
    }
  }

  // The front end works once for all estimators: it does not depend on what they believe.
  void TakeImages(const nav::StereoImages& images) {
    if (estimators_.empty()) return;
    if (!tracker_->Accepts(images)) {
      for (RunningEstimator& e : estimators_) {
        e.run.counts.Add({.outcome = nav::Outcome::kUnusable});
      }
      return;
    }
    const auto begin = Clock::now();
    const nav::Measurement features = tracker_->Track(images);
    record_.timing["front_end"].ms.push_back(MsSince(begin));
    KeepSampleImage(images);
    for (RunningEstimator& e : estimators_) {
      const auto estimator_begin = Clock::now();
      Feed(features, e);
      record_.timing[e.run.name].ms.push_back(MsSince(estimator_begin));
    }
  }

  static void Feed(const nav::Measurement& measurement, RunningEstimator& e) {
    const nav::Report report =
        std::visit([&](auto& estimator) { return estimator.Process(measurement); }, e.estimator);
    e.run.counts.Add(report);
    if (report.estimate) e.run.estimates.push_back(*report.estimate);
  }

  // Four views spread over the run.
  [[nodiscard]] bool IsSampleDue(nav::TimeNs stamp) const {
    constexpr nav::TimeNs kCount = 4;
    const auto kept = static_cast<nav::TimeNs>(record_.images.size());
    return kept < kCount && stamp >= duration_ * (2 * kept + 1) / (2 * kCount);
  }

  void KeepSampleImage(const nav::StereoImages& images) {
    if (!IsSampleDue(images.stamp)) return;
    record_.images.push_back({.title = "left camera and what the front end follows",
                              .stamp = images.stamp,
                              .image = DrawFeatures(images.left, tracker_->points_px())});
  }

  // Where there are cameras, theirs are the pictures to show.
  void KeepSkyImage(const nav::PolarizationImage& sky) {
    if (rig_.stereo || !IsSampleDue(sky.stamp)) return;
    cv::Mat grey;
    sky.mosaic.convertTo(grey, CV_8UC1,
                         255.0 / (std::ldexp(1.0, rig_.polarization_camera->bits) - 1.0));
    record_.images.push_back(
        {.title = "mosaic of the sky camera", .stamp = sky.stamp, .image = grey});
  }

  void Finish(const std::map<std::string, std::vector<double>>& picture_ms) {
    for (auto& [name, hash] : hashes_) record_.streams[name].sha256 = hash.HexDigest();
    for (const auto& [stage, ms] : picture_ms) record_.timing[stage].ms = ms;
    for (RunningEstimator& e : estimators_) {
      e.run.sha256 = HashOf(e.run.estimates);
      record_.estimators.push_back(std::move(e.run));
    }
    record_.polarization_readings = readings_.ErrorsAgainst(record_.truth);
    record_.sim_duration_s = scenario_.duration_s;
    record_.peak_rss_mb = PeakMemoryMb();
  }

  const Scenario& scenario_;
  RunOptions options_;
  nav::Rig rig_;
  nav::TimeNs duration_;
  sim::FaultInjector faults_;
  PolarizationReadings readings_;
  std::optional<nav::StereoTracker> tracker_;
  std::optional<GroundTruthFiles> ground_truth_;
  std::vector<RunningEstimator> estimators_;
  std::map<std::string, Sha256> hashes_;
  RunRecord record_;
};

}  // namespace

RunRecord RunClosedLoop(const Scenario& scenario, const RunOptions& options,
                        const std::function<void(double fraction)>& progress) {
  return Loop(scenario, options).Run(progress);
}

}  // namespace polnav::testbed
