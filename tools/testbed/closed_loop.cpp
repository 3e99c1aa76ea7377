#include "tools/testbed/closed_loop.h"

#include <chrono>
#include <optional>

#include "sim/measurement_stream.h"
#include "tools/testbed/calibration_turn.h"
#include "tools/testbed/dataset/euroc_writer.h"
#include "tools/testbed/disturbed_times.h"
#include "tools/testbed/ground_truth_files.h"
#include "tools/testbed/listener.h"
#include "tools/testbed/sightings.h"

namespace polnav::testbed {
namespace {

using Clock = std::chrono::steady_clock;

class Loop {
 public:
  Loop(const Scenario& scenario, const RunOptions& options)
      : scenario_(scenario),
        key_{options.seed, options.trial},
        duration_(nav::FromSeconds(scenario.duration_s)),
        rig_(ToldRig(scenario, key_)),
        listener_(scenario, rig_, key_, duration_, options.level),
        level_(options.level),
        motions_(options.motions),
        render_threads_(options.render_threads) {
    if (!options.record_folder.empty()) {
      recording_.emplace(options.record_folder, scenario, rig_);
    }
    if (!options.ground_truth_folder.empty()) {
      ground_truth_.emplace(
          options.ground_truth_folder,
          sim::DrawTrueStereo(*scenario.sensors.stereo, options.seed, options.trial));
    }
    if (level_ == sim::Level::kMeasurement && rig_.stereo) {
      sightings_.emplace(scenario.estimators.stereo.tracker, *rig_.stereo,
                         WantsDescriptors(scenario));
    }
  }

  RunRecord Run(const std::function<void(double)>& progress) {
    const auto begin = Clock::now();
    const sim::SimulatorOptions simulated{
        scenario_.site,    scenario_.sky,          scenario_.world, scenario_.vehicle,
        scenario_.sensors, scenario_.disturbances, level_};
    sim::MeasurementStream stream(simulated, key_, duration_, render_threads_,
                                  motions_ ? motions_->For(simulated, duration_) : nullptr);
    while (const auto item = stream.Next()) {
      if (const auto* truth = std::get_if<sim::Truth>(&*item)) {
        Take(*truth);
        if (progress) progress(nav::ToSeconds(truth->stamp) / scenario_.duration_s);
      } else if (const auto* frame = std::get_if<sim::FrameTruth>(&*item)) {
        if (ground_truth_) ground_truth_->Write(*frame);
      } else if (const auto* seen = std::get_if<sim::FeatureSightings>(&*item)) {
        listener_.Hear(sightings_->Rectify(*seen));
      } else {
        Take(std::get<nav::Measurement>(*item));
      }
    }
    if (ground_truth_) ground_truth_->Commit();
    RunRecord record = listener_.Finish();
    for (const auto& [stage, ms] : stream.picture_ms()) record.timing[stage].ms = ms;
    record.disturbed = DisturbedTimes(scenario_, key_.trial, record.truth);
    record.sim_duration_s = scenario_.duration_s;
    record.wall_s = std::chrono::duration<double>(Clock::now() - begin).count();
    return record;
  }

 private:
  void Take(const sim::Truth& truth) {
    if (!started_) listener_.Start(GrantStart(scenario_.estimators.start, truth, key_));
    started_ = true;
    if (recording_) recording_->Write(truth);
    listener_.Hear(truth);
  }

  void Take(const nav::Measurement& measurement) {
    if (recording_) recording_->Write(measurement);
    listener_.Hear(measurement);
  }

  const Scenario& scenario_;
  sim::RunKey key_;
  nav::TimeNs duration_;
  nav::Rig rig_;
  Listener listener_;
  sim::Level level_;
  sim::MotionMemory* motions_;
  int render_threads_;
  std::optional<SightingsRectifier> sightings_;
  std::optional<GroundTruthFiles> ground_truth_;
  std::optional<EurocWriter> recording_;
  bool started_ = false;
};

}  // namespace

nav::Rig ToldRig(const Scenario& scenario, const sim::RunKey& key) {
  nav::Rig rig = sim::NominalRig(scenario.sensors);
  if (rig.polarization_camera && scenario.estimators.calibrate_sky_camera) {
    const auto turn = TakeCalibrationTurn(*scenario.sensors.polarization_camera, scenario.sky,
                                          key.seed, key.trial);
    rig.polarization_camera =
        nav::CalibrateFromTurn(scenario.estimators.compass, *rig.polarization_camera, turn)
            .calibration;
  }
  return rig;
}

RunRecord RunClosedLoop(const Scenario& scenario, const RunOptions& options,
                        const std::function<void(double fraction)>& progress) {
  return Loop(scenario, options).Run(progress);
}

}  // namespace polnav::testbed
