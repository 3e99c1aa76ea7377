#include "nav/ukf/ukf.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "nav/inertial/options.h"
#include "nav/ukf/start.h"

namespace polnav::nav {
namespace {

using ukf::Entry;
using ukf::Error;
using ukf::State;
using ukf::Step;

// Readings beyond are no readings: more than any such sensor can say.
constexpr double kFastest_rad_s = 100.0;
constexpr double kHardest_m_s2 = 1000.0;

constexpr double kGap = 2.5;                     // intervals of the IMU; more is a gap
constexpr TimeNs kPatience = kNsPerSecond / 10;  // with an IMU that says nothing
constexpr std::size_t kMostWaiting = 64;
constexpr double kSeen_s = 1.0;  // the ground, or the robot is not tracked

// Once the speed is known, where the robot is follows from flow through the velocity alone.
constexpr double kKnownSpeed_m_s = 0.02;
constexpr ukf::Kept kWay{.first = ukf::kPosition, .count = 2};

bool KnowsSpeed(const State& state) {
  return state.P.diagonal().segment<2>(ukf::kVelocity).maxCoeff() <
         kKnownSpeed_m_s * kKnownSpeed_m_s;
}

// Without an IMU it may do anything that a walking robot does: 0.3 rad/s and 1 m/s^2 that last for
// a quarter of a second.
constexpr double kBlindGyro_rad2_s = 0.09 * 0.5;
constexpr double kBlindAccel_m2_s3 = 1.0 * 0.5;
constexpr TimeNs kBlindStep = kNsPerSecond / 50;
constexpr TimeNs kBlindSteps = 200;  // at most

std::size_t CapacityFor(const UkfOptions& options, double imu_hz, double flow_hz) {
  constexpr double kSky_hz = 50.0;
  // A step may be cut in two by each measurement.
  const double rate = imu_hz + 2.0 * (flow_hz + kSky_hz);
  return static_cast<std::size_t>((options.max_delay_s + 0.1) * rate) + 16;
}

TimeNs FlowWindow(const OpticalFlowSample& sample, double rate_hz) {
  // Displacements that were not found count neither in flow nor in time: where in the interval
  // they lie is unknown.
  const TimeNs period = rate_hz > 0.0 ? FromSeconds(1.0 / rate_hz) : sample.integration;
  return std::max(sample.integration, period);
}

}  // namespace

Ukf::Ukf(const UkfOptions& options, const ImuCalibration& imu, const OpticalFlowCalibration& flow,
         const StartPrior& start, std::optional<SkySource> sky)
    : options_(options),
      imu_(imu),
      ground_{imu.T_BI.Inverse() * flow.T_BF, flow},
      start_(start),
      sky_(std::move(sky)),
      noise_(ukf::NoiseOf(imu, options, sky_ ? sky_->options.correlation_time_s : 1.0)),
      timeline_(CapacityFor(options, std::clamp(imu.rate_hz, 1.0, 5000.0),
                            std::clamp(flow.rate_hz, 1.0, 1000.0))),
      sky_doubt_(options.doubt_after_s),
      flow_doubt_(options.doubt_after_s / 3.0),
      range_doubt_(options.doubt_after_s / 3.0) {
  ukf::CheckSigmas(imu, flow, start);
  interval_ = FromSeconds(1.0 / imu.rate_hz);
  if (sky_) q_IS_ = imu.T_BI.q.conjugate() * sky_->calibration.T_BS.q;
  waiting_.reserve(kMostWaiting);
}

Report Ukf::Process(const Measurement& measurement) {
  Report report;
  if (const auto* imu = std::get_if<ImuSample>(&measurement)) {
    report.outcome = TakeImu(*imu, report);
  } else if (const auto* flow = std::get_if<OpticalFlowSample>(&measurement)) {
    report.outcome = IsUsable(*flow) ? Take(flow->stamp, *flow, report) : Outcome::kUnusable;
  } else if (const auto* light = std::get_if<PolarizationSample>(&measurement); light && sky_) {
    report.outcome = IsUsable(*light) ? Take(light->stamp, *light, report) : Outcome::kUnusable;
  } else {
    return report;
  }
  if (!timeline_.started()) return report;
  const TimeNs period = FromSeconds(1.0 / options_.output_rate_hz);
  const TimeNs now = timeline_.Now().stamp;
  if (now / period > answered_ / period) {
    answered_ = now;
    report.estimate = Now();
  }
  return report;
}

std::optional<Estimate> Ukf::Now() const {
  if (!timeline_.started()) return std::nullopt;
  const State& state = timeline_.Now();
  Estimate estimate = ukf::EstimateOf(state, options_, imu_.T_BI);
  estimate.tracked = seen_ && ToSeconds(state.stamp - *seen_) < kSeen_s;
  return estimate;
}

bool Ukf::IsUsable(const OpticalFlowSample& sample) const {
  return sample.flow_rad.allFinite() && std::isfinite(sample.quality) && sample.integration >= 0 &&
         (!sample.range_m || std::isfinite(*sample.range_m));
}

// The last reading to the last bit, which noise forbids, is a frozen driver.
bool Ukf::IsUsable(const PolarizationSample& sample) {
  const bool frozen = newest_light_ && sample.channel == newest_light_->channel;
  newest_light_ = sample;
  const bool finite = std::all_of(sample.channel.begin(), sample.channel.end(),
                                  [](double c) { return std::isfinite(c); });
  return finite && !frozen && UsableLight(sample, sky_->options).has_value();
}

Outcome Ukf::TakeImu(const ImuSample& sample, Report& report) {
  const bool sound = sample.gyro_rad_s.cwiseAbs().maxCoeff() < kFastest_rad_s &&
                     sample.accel_m_s2.cwiseAbs().maxCoeff() < kHardest_m_s2 &&
                     sample.gyro_rad_s.allFinite() && sample.accel_m_s2.allFinite();
  if (!sound) return Outcome::kUnusable;
  if (!timeline_.started()) Begin(sample.stamp - interval_);
  const TimeNs now = timeline_.Now().stamp;
  if (sample.stamp <= now) return Outcome::kUnusable;
  if (static_cast<double>(sample.stamp - now) > kGap * static_cast<double>(interval_)) {
    const TimeNs begin = sample.stamp - interval_;
    while (!waiting_.empty() && waiting_.front().stamp < begin) {
      CoastTo(waiting_.front().stamp);
      TakeWaiting(waiting_.front().stamp, {}, report);
    }
    CoastTo(begin);
  }
  const Step step{sample.gyro_rad_s, sample.accel_m_s2};
  TakeWaiting(sample.stamp, step, report);
  StepTo(sample.stamp, step);
  return Outcome::kUsed;
}

void Ukf::Begin(TimeNs stamp) {
  timeline_.Start(ukf::StartState(options_, imu_, ground_.calibration, start_, stamp));
  answered_ = stamp;
}

void Ukf::StepTo(TimeNs stamp, const Step& step) {
  if (stamp <= timeline_.Now().stamp) return;
  const std::size_t place = timeline_.Insert(timeline_.size());
  Entry& entry = timeline_.at(place);
  entry.stamp = stamp;
  entry.what = step;
  Run(place, nullptr);
}

// Straight on, as nothing says otherwise.
void Ukf::CoastTo(TimeNs stamp) {
  const TimeNs length = std::max(kBlindStep, (stamp - timeline_.Now().stamp) / kBlindSteps);
  while (timeline_.Now().stamp < stamp) {
    const State& now = timeline_.Now();
    const Step step{.gyro_rad_s = now.gyro_bias,
                    .accel_m_s2 = now.accel_bias +
                                  now.q_WI.conjugate() * Eigen::Vector3d(0.0, 0.0, kGravity_m_s2),
                    .blind = true};
    StepTo(std::min(stamp, now.stamp + length), step);
  }
}

// Those up to `until`, each after its part of the step.
void Ukf::TakeWaiting(TimeNs until, const Step& step, Report& report) {
  std::size_t taken = 0;
  for (; taken < waiting_.size() && waiting_[taken].stamp <= until; ++taken) {
    const Waiting& w = waiting_[taken];
    StepTo(w.stamp, step);
    const std::size_t place = timeline_.Insert(timeline_.size());
    timeline_.at(place).stamp = w.stamp;
    timeline_.at(place).what = w.what;
    if (Run(place, &report) == Outcome::kGated) ++report.gated_readings;
  }
  waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<std::ptrdiff_t>(taken));
}

Outcome Ukf::Take(TimeNs stamp, const What& what, Report& report) {
  if (!timeline_.started()) return Outcome::kUnusable;
  const TimeNs now = timeline_.Now().stamp;
  if (stamp <= now) return InsertLate(stamp, what, report);
  if (waiting_.size() == kMostWaiting || stamp - now > 3600 * kNsPerSecond) {
    return Outcome::kUnusable;
  }
  const auto later = [&](const Waiting& w) { return w.stamp > stamp; };
  waiting_.insert(std::find_if(waiting_.begin(), waiting_.end(), later), {stamp, what});
  if (stamp - now > kPatience) {
    while (!waiting_.empty() && waiting_.front().stamp <= stamp) {
      const TimeNs next = waiting_.front().stamp;
      CoastTo(next);
      TakeWaiting(next, {}, report);
    }
  }
  return Outcome::kUsed;
}

Outcome Ukf::InsertLate(TimeNs stamp, const What& what, Report& report) {
  const TimeNs now = timeline_.Now().stamp;
  if (stamp < timeline_.Oldest() || ToSeconds(now - stamp) > options_.max_delay_s) {
    return Outcome::kUnusable;
  }
  std::size_t place = timeline_.PlaceOf(stamp);
  for (std::size_t i = place; i > 0 && timeline_.at(i - 1).stamp == stamp; --i) {
    if (timeline_.at(i - 1).what.index() == what.index() && what.index() != 0) {
      return Outcome::kUnusable;  // the same once more
    }
  }
  if (place == 0) return Outcome::kUnusable;
  if (timeline_.at(place - 1).stamp < stamp) {  // amid a step: cut it in two
    const What step = timeline_.at(place).what;
    place = timeline_.Insert(place);
    timeline_.at(place).stamp = stamp;
    timeline_.at(place).what = step;
    Run(place, nullptr);
    ++place;
  }
  place = timeline_.Insert(place);
  timeline_.at(place).stamp = stamp;
  timeline_.at(place).what = what;
  const Outcome outcome = Run(place, &report);
  for (std::size_t i = place + 1; i < timeline_.size(); ++i) Run(i, nullptr);
  return outcome;
}

Outcome Ukf::Run(std::size_t place, Report* report) {
  Entry& entry = timeline_.at(place);
  entry.after = timeline_.at(place - 1).after;
  entry.after.P.diagonal() += entry.widened;
  if (const auto* step = std::get_if<Step>(&entry.what)) {
    const double h = ToSeconds(entry.stamp - entry.after.stamp);
    ukf::ProcessNoise noise = noise_;
    if (step->blind) {
      noise.gyro_rad2_s += kBlindGyro_rad2_s;
      noise.accel_m2_s3 += kBlindAccel_m2_s3;
    }
    ukf::Predict(step->gyro_rad_s, step->accel_m_s2, h, entry.stamp, noise, entry.after);
    if (!ukf::IsSound(entry.after.P) && !ukf::Repair(entry.after.P)) {
      entry.after = timeline_.at(place - 1).after;  // a step that makes no numbers is none
      entry.after.stamp = entry.stamp;
    }
    return Outcome::kUsed;
  }
  if (const auto* flow = std::get_if<OpticalFlowSample>(&entry.what)) {
    const Outcome ranged = RunRange(*flow, entry, report);
    const Outcome flowed = RunFlow(place, *flow, report);
    if (flowed != Outcome::kUnusable) return flowed;
    return ranged;
  }
  return RunSky(std::get<PolarizationSample>(entry.what), entry, report);
}

Outcome Ukf::RunRange(const OpticalFlowSample& sample, Entry& entry, Report* report) {
  const OpticalFlowCalibration& c = ground_.calibration;
  if (!sample.range_m || *sample.range_m < c.range_min_m || !(*sample.range_m > 0.0) ||
      (c.range_max_m > 0.0 && *sample.range_m > c.range_max_m)) {
    return Outcome::kUnusable;
  }
  const ukf::Expected<1> expected = ukf::ExpectRange(entry.after, ground_);
  using Scalar = Eigen::Matrix<double, 1, 1>;
  const Scalar residual(*sample.range_m - expected.mean(0));
  const Scalar noise(ukf::RangeNoise(entry.after, ground_, options_));
  const ukf::Correction done =
      ukf::Correct<1>(expected, residual, noise, options_.gate_sigmas, entry.after);
  if (!done.usable) return Outcome::kUnusable;
  if (report) {
    Tell({"range", 1, {residual(0), 0.0}, &range_doubt_, ukf::kTerrain, 1}, sample.stamp, done,
         entry, *report);
  }
  return done.gated ? Outcome::kGated : Outcome::kUsed;
}

Outcome Ukf::RunFlow(std::size_t place, const OpticalFlowSample& sample, Report* report) {
  Entry& entry = timeline_.at(place);
  if (sample.quality < options_.min_quality || sample.integration <= 0 ||
      !ukf::KnowsHeight(entry.after, ground_)) {
    return Outcome::kUnusable;
  }
  const double integration_s = ToSeconds(sample.integration);
  const ukf::FlowInterval interval =
      timeline_.IntervalBefore(place, FlowWindow(sample, ground_.calibration.rate_hz));
  const ukf::Expected<2> expected = ukf::ExpectFlow(entry.after, ground_, interval);
  const Eigen::Vector2d residual = sample.flow_rad / integration_s - expected.mean;
  const Eigen::Matrix2d noise =
      ukf::FlowNoise(entry.after, ground_, interval, integration_s, options_) *
      Eigen::Matrix2d::Identity();
  const double range = ukf::RangeOf(entry.after, ground_, Error::Zero());
  const ukf::Correction done =
      ukf::Correct<2>(expected, residual, noise, options_.gate_sigmas, entry.after,
                      KnowsSpeed(entry.after) ? kWay : ukf::Kept{});
  if (!done.usable) return Outcome::kUnusable;
  if (report) {
    if (!done.gated) seen_ = sample.stamp;
    Tell({"optical_flow", 2, range * residual, &flow_doubt_, ukf::kVelocity, 2}, sample.stamp, done,
         entry, *report);
  }
  return done.gated ? Outcome::kGated : Outcome::kUsed;
}

Outcome Ukf::RunSky(const PolarizationSample& sample, Entry& entry, Report* report) {
  const auto light = DecodeSixChannels(sample);
  if (!light) return Outcome::kUnusable;
  const Eigen::Vector3d sun_W = sky_->sun(sample.stamp);
  const ukf::SkyReading reading =
      ukf::WeighReading(*light, sun_W, entry.after.q_WI * q_IS_, sky_->options);
  const ukf::Expected<1> expected = ukf::ExpectSky(entry.after, q_IS_, reading);
  const double nominal = ukf::AxisOf(entry.after, q_IS_, sun_W, Error::Zero());
  using Scalar = Eigen::Matrix<double, 1, 1>;
  const Scalar residual(WrapHalfPi(WrapHalfPi(light->axis_rad - nominal) - expected.mean(0)));
  const Scalar noise(reading.white_rad * reading.white_rad);
  const double sigma = std::sqrt(expected.covariance(0) + noise(0));
  const ukf::Correction done =
      ukf::Correct<1>(expected, residual, noise, options_.gate_sigmas, entry.after);
  if (!done.usable) return Outcome::kUnusable;
  if (report) {
    report->sky.push_back({sample.stamp, residual(0), sigma, done.gated});
    Tell({"polarimeter", 1, {residual(0), 0.0}, &sky_doubt_, ukf::kTheta + 2, 1}, sample.stamp,
         done, entry, *report);
  }
  return done.gated ? Outcome::kGated : Outcome::kUsed;
}

// Where refused readings agree, what follows, and what is done again, starts from less certainty.
void Ukf::Tell(const Reading& reading, TimeNs stamp, const ukf::Correction& done, Entry& entry,
               Report& report) {
  report.failed_solves += done.repaired ? 1 : 0;
  report.innovations.push_back({stamp, reading.sensor, done.nis, reading.dof, done.gated});
  if (!done.gated) {
    reading.doubt->Reset();
    return;
  }
  const auto doubt = reading.doubt->Add(stamp, reading.residual);
  if (!doubt) return;
  entry.widened.segment(reading.at, reading.count).array() += *doubt;
  entry.after.P.diagonal().segment(reading.at, reading.count).array() += *doubt;
}

}  // namespace polnav::nav
