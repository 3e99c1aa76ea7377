// What do the estimators make of what the sensors say?
//
// Faults first, then the front end and the estimators, each in order of arrival; what they answer
// is kept, with hashes of every stream and wall times. Whoever feeds it (the simulator, a recorded
// dataset) hands over truths and measurements in order of stamps: where they come from makes no
// difference to a single byte of what the estimators say.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "nav/api/calibration.h"
#include "nav/api/measurements.h"
#include "nav/stereo/tracker.h"
#include "sim/faults/fault_injector.h"
#include "sim/simulator.h"
#include "tools/testbed/estimators.h"
#include "tools/testbed/force_spectrum.h"
#include "tools/testbed/hash.h"
#include "tools/testbed/polarization_readings.h"
#include "tools/testbed/run_record.h"
#include "tools/testbed/scenario.h"

namespace polnav::testbed {

// What the scenario grants at the start: the true pose, blurred by the sigmas that it states.
[[nodiscard]] nav::StartPrior GrantStart(const StartOptions& start, const sim::Truth& truth,
                                         const sim::RunKey& key);

class Listener {
 public:
  // Of the scenario only site, faults and estimators matter here. rig: what the estimators are
  // told. duration: of the whole run, to spread pictures and looks at the memory over it.
  Listener(const Scenario& scenario, nav::Rig rig, const sim::RunKey& key, nav::TimeNs duration,
           sim::Level level = sim::Level::kImage);

  // Once, before the first measurement.
  void Start(const nav::StartPrior& start);

  void Hear(const sim::Truth& truth);
  void Hear(const nav::Measurement& measurement);  // as the sensor said it, before any fault

  // At the end, once: what was still on its way arrives, and nothing is heard any more. The wall
  // time and the duration are the caller's to fill in.
  [[nodiscard]] RunRecord Finish();

 private:
  struct RunningEstimator {
    EstimatorRun run;
    AnyEstimator estimator;
  };

  void Take(const nav::Measurement& measurement);
  void TakeImages(const nav::StereoImages& images);
  void TakeSeen(const nav::StereoFeatures& features);
  void TakeFeatures(const nav::StereoFeatures& features);
  void LeaveOut();
  static nav::Report Feed(const nav::Measurement& measurement, RunningEstimator& e);
  void KeepDiagnostics(const nav::Report& report, RunningEstimator& e);
  void LookAtMemory(nav::TimeNs stamp);
  [[nodiscard]] bool IsSampleDue(nav::TimeNs stamp) const;
  void KeepSampleImage(const nav::StereoImages& images);
  void KeepSkyImage(const nav::PolarizationImage& sky);

  Scenario scenario_;
  nav::Rig rig_;
  nav::TimeNs duration_;
  sim::FaultInjector faults_;
  PolarizationReadings readings_;
  std::optional<nav::StereoTracker> tracker_;
  std::optional<nav::StereoFeatures> newest_seen_;  // where no pictures are drawn
  std::optional<ForceSpectrum> force_;
  double front_end_ms_ = 0.0;  // of the newest pair of pictures
  std::vector<RunningEstimator> estimators_;
  std::map<std::string, Sha256> hashes_;
  RunRecord record_;
};

}  // namespace polnav::testbed
