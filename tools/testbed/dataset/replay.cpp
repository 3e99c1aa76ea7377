#include "tools/testbed/dataset/replay.h"

#include <algorithm>
#include <chrono>

#include "tools/testbed/listener.h"

namespace polnav::testbed {
namespace {

using Clock = std::chrono::steady_clock;

nav::StartPrior StartAtOrigin(const StartOptions& start) {
  return {.position_sigma_m = start.position_sigma_m,
          .heading_rad = 0.0,
          .heading_sigma_rad = nav::DegToRad(start.heading_sigma_deg),
          .level_sigma_rad = nav::DegToRad(start.level_sigma_deg)};
}

class Playback {
 public:
  Playback(Dataset dataset, const Scenario& settings)
      : dataset_(std::move(dataset)),
        settings_(settings),
        key_{.seed = settings.seed},
        listener_(settings, dataset_.info().rig, key_, dataset_.info().duration) {}

  ReplayOutcome Run(const std::function<void(double)>& progress) {
    const auto begin = Clock::now();
    if (!dataset_.info().has_truth) Start(StartAtOrigin(settings_.estimators.start));
    while (const std::optional<DatasetItem> item = Next()) {
      if (const auto* truth = std::get_if<sim::Truth>(&*item)) {
        if (!started_) Start(GrantStart(settings_.estimators.start, *truth, key_));
        listener_.Hear(*truth);
        Reached(truth->stamp, progress);
      } else {
        Take(std::get<nav::Measurement>(*item));
        Reached(nav::StampOf(std::get<nav::Measurement>(*item)), progress);
      }
    }
    outcome_.record = listener_.Finish();
    outcome_.problems = dataset_.problems();
    outcome_.record.sim_duration_s = nav::ToSeconds(reached_);
    outcome_.record.wall_s = std::chrono::duration<double>(Clock::now() - begin).count();
    return std::move(outcome_);
  }

 private:
  std::optional<DatasetItem> Next() {
    try {
      return dataset_.Next();
    } catch (const InputError& error) {
      outcome_.failure = error;
      return std::nullopt;
    }
  }

  void Start(const nav::StartPrior& prior) {
    listener_.Start(prior);
    started_ = true;
  }

  void Take(const nav::Measurement& measurement) {
    if (started_) {
      listener_.Hear(measurement);
    } else {
      ++outcome_.before_start;
    }
  }

  void Reached(nav::TimeNs stamp, const std::function<void(double)>& progress) {
    reached_ = std::max(reached_, stamp);
    const nav::TimeNs whole = dataset_.info().duration;
    if (progress && whole > 0) progress(nav::ToSeconds(reached_) / nav::ToSeconds(whole));
  }

  Dataset dataset_;
  const Scenario& settings_;
  sim::RunKey key_;
  Listener listener_;
  ReplayOutcome outcome_;
  nav::TimeNs reached_ = 0;
  bool started_ = false;
};

}  // namespace

ReplayOutcome Replay(Dataset dataset, const Scenario& settings,
                     const std::function<void(double fraction)>& progress) {
  return Playback(std::move(dataset), settings).Run(progress);
}

}  // namespace polnav::testbed
