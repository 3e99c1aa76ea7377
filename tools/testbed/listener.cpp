#include "tools/testbed/listener.h"

#include <chrono>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>

#include "sim/random.h"
#include "tools/testbed/level_checks.h"
#include "tools/testbed/memory_use.h"
#include "tools/testbed/sightings.h"
#include "tools/testbed/stream_hash.h"

namespace polnav::testbed {
namespace {

using Clock = std::chrono::steady_clock;

double MsSince(Clock::time_point begin) {
  return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

// The corners that the front end follows.
cv::Mat DrawFeatures(const cv::Mat& image, const std::vector<cv::Point2f>& points) {
  cv::Mat drawn;
  cv::cvtColor(image, drawn, cv::COLOR_GRAY2BGR);
  for (const cv::Point2f& p : points) {
    cv::circle(drawn, p, 3, cv::Scalar(60, 220, 60), 1, cv::LINE_AA);
  }
  return drawn;
}

}  // namespace

nav::StartPrior GrantStart(const StartOptions& start, const sim::Truth& truth,
                           const sim::RunKey& key) {
  sim::RandomStream::Sample draw = sim::RandomStream(key.seed, key.trial, "estimators/start").At(0);
  nav::StartPrior prior{.position_sigma_m = start.position_sigma_m,
                        .heading_sigma_rad = nav::DegToRad(start.heading_sigma_deg),
                        .level_sigma_rad = nav::DegToRad(start.level_sigma_deg),
                        .standing_s = start.standing_s};
  prior.heading_rad = nav::CompassHeading(truth.T_WB.q) + prior.heading_sigma_rad * draw.Gaussian();
  for (int i = 0; i < 3; ++i) {
    prior.p_WB_m(i) = truth.T_WB.p(i) + prior.position_sigma_m * draw.Gaussian();
  }
  return prior;
}

Listener::Listener(const Scenario& scenario, nav::Rig rig, const sim::RunKey& key,
                   nav::TimeNs duration, sim::Level level)
    : scenario_(scenario),
      rig_(std::move(rig)),
      duration_(duration),
      faults_(FaultsAt(level, scenario.faults), rig_, key.seed, key.trial),
      readings_(rig_.polarimeter, SunFor(scenario.site)) {
  if (rig_.stereo) {
    tracker_.emplace(scenario_.estimators.stereo.tracker, *rig_.stereo,
                     WantsDescriptors(scenario_));
  }
  if (rig_.imu) force_.emplace(*rig_.imu);
}

void Listener::Start(const nav::StartPrior& start) {
  for (const std::string& name : scenario_.estimators.run) {
    estimators_.push_back({{.name = name, .heading_only = InfoOf(name).heading_only},
                           MakeEstimator(name, scenario_, rig_, start)});
  }
}

void Listener::Hear(const sim::Truth& truth) {
  record_.truth.push_back(truth);
  HashTruth(truth, hashes_["truth"]);
  ++record_.streams["truth"].count;
  LookAtMemory(truth.stamp);
}

void Listener::Hear(const nav::Measurement& measurement) {
  LookAtMemory(nav::StampOf(measurement));
  for (const nav::Measurement& arrived : faults_.Take(measurement)) Take(arrived);
}

// A hundred looks over the run.
void Listener::LookAtMemory(nav::TimeNs stamp) {
  const double due_s =
      nav::ToSeconds(duration_) * static_cast<double>(record_.rss_mb.size()) / 100.0;
  if (nav::ToSeconds(stamp) >= due_s) record_.rss_mb.push_back(ResidentMemoryMb());
}

void Listener::Take(const nav::Measurement& measurement) {
  const auto begin = Clock::now();
  const std::string stream = StreamName(measurement);
  HashMeasurement(measurement, hashes_[stream]);
  ++record_.streams[stream].count;
  if (const auto* images = std::get_if<nav::StereoImages>(&measurement)) {
    record_.timing["hash"].ms.push_back(MsSince(begin));
    TakeImages(*images);
    return;
  }
  if (const auto* features = std::get_if<nav::StereoFeatures>(&measurement)) {
    TakeSeen(*features);
    return;
  }
  if (const auto* light = std::get_if<nav::PolarizationSample>(&measurement)) {
    readings_.Add(*light);
  }
  if (const auto* sky = std::get_if<nav::PolarizationImage>(&measurement)) KeepSkyImage(*sky);
  if (const auto* imu = std::get_if<nav::ImuSample>(&measurement); imu && force_) force_->Add(*imu);
  for (RunningEstimator& e : estimators_) {
    const auto estimator_begin = Clock::now();
    static_cast<void>(Feed(measurement, e));
    // Only pictures take a time worth a line in the report.
    if (std::holds_alternative<nav::PolarizationImage>(measurement)) {
      record_.timing[e.run.name].ms.push_back(MsSince(estimator_begin));
    }
  }
}

// The front end works once for all estimators: it does not depend on what they believe.
void Listener::TakeImages(const nav::StereoImages& images) {
  if (estimators_.empty()) return;
  if (!tracker_->Accepts(images)) {
    LeaveOut();
    return;
  }
  const auto begin = Clock::now();
  const nav::StereoFeatures features = tracker_->Track(images);
  front_end_ms_ = MsSince(begin);
  record_.timing["front_end"].ms.push_back(front_end_ms_);
  KeepSampleImage(images);
  TakeFeatures(features);
}

void Listener::LeaveOut() {
  for (RunningEstimator& e : estimators_) e.run.counts.Add({.outcome = nav::Outcome::kUnusable});
}

void Listener::TakeSeen(const nav::StereoFeatures& features) {
  if (newest_seen_ && !IsNews(features, *newest_seen_)) {
    LeaveOut();
    return;
  }
  newest_seen_ = features;
  TakeFeatures(features);
}

void Listener::TakeFeatures(const nav::StereoFeatures& features) {
  for (RunningEstimator& e : estimators_) {
    const auto estimator_begin = Clock::now();
    const nav::Report report = Feed(nav::Measurement(features), e);
    const double ms = MsSince(estimator_begin);
    record_.timing[e.run.name].ms.push_back(ms);
    record_.timing[e.run.name + "/frame"].ms.push_back(front_end_ms_ + ms);
    KeepDiagnostics(report, e);
  }
}

// Stages as "stereo/pose"; one that a frame did not reach is no call of it.
void Listener::KeepDiagnostics(const nav::Report& report, RunningEstimator& e) {
  e.run.diagnostics.Add(report);
  for (std::size_t i = 0; i < report.stage_s.size(); ++i) {
    if (report.stage_s[i] <= 0.0) continue;
    record_.timing[e.run.name + "/" + nav::kStageNames[i]].ms.push_back(1e3 * report.stage_s[i]);
  }
}

nav::Report Listener::Feed(const nav::Measurement& measurement, RunningEstimator& e) {
  const nav::Report report =
      std::visit([&](auto& estimator) { return estimator.Process(measurement); }, e.estimator);
  e.run.counts.Add(report);
  e.run.diagnostics.AddInnovations(report);
  if (report.estimate) e.run.estimates.push_back(*report.estimate);
  return report;
}

// Four views spread over the run.
bool Listener::IsSampleDue(nav::TimeNs stamp) const {
  constexpr nav::TimeNs kCount = 4;
  const auto kept = static_cast<nav::TimeNs>(record_.images.size());
  return kept < kCount && stamp >= duration_ * (2 * kept + 1) / (2 * kCount);
}

void Listener::KeepSampleImage(const nav::StereoImages& images) {
  if (!IsSampleDue(images.stamp)) return;
  record_.images.push_back({.title = "left camera and what the front end follows",
                            .stamp = images.stamp,
                            .image = DrawFeatures(images.left, tracker_->points_px())});
}

// Where there are cameras, theirs are the pictures to show.
void Listener::KeepSkyImage(const nav::PolarizationImage& sky) {
  if (rig_.stereo || !IsSampleDue(sky.stamp)) return;
  cv::Mat grey;
  sky.mosaic.convertTo(grey, CV_8UC1,
                       255.0 / (std::ldexp(1.0, rig_.polarization_camera->bits) - 1.0));
  record_.images.push_back(
      {.title = "mosaic of the sky camera", .stamp = sky.stamp, .image = grey});
}

RunRecord Listener::Finish() {
  for (const nav::Measurement& arrived : faults_.Flush()) Take(arrived);
  for (auto& [name, hash] : hashes_) record_.streams[name].sha256 = hash.HexDigest();
  for (RunningEstimator& e : estimators_) {
    e.run.sha256 = HashOf(e.run.estimates);
    record_.estimators.push_back(std::move(e.run));
  }
  record_.polarization_readings = readings_.ErrorsAgainst(record_.truth);
  if (force_) record_.force = force_->Lines();
  record_.peak_rss_mb = PeakMemoryMb();
  return std::move(record_);
}

}  // namespace polnav::testbed
