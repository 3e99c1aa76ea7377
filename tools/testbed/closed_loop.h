// What happens when the simulated vehicle drives and the estimators listen?
//
// One run: simulate, hand each measurement to every estimator in order of simulated arrival, keep
// what they answer. (scenario, seed, trial) fixes every byte of the record except wall times and
// memory, whatever the number of render threads.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>

#include "sim/motion_memory.h"
#include "tools/testbed/run_record.h"
#include "tools/testbed/scenario.h"

namespace polnav::testbed {

struct RunOptions {
  std::uint64_t seed = 1;
  std::uint64_t trial = 0;
  int render_threads = 1;
  sim::Level level = sim::Level::kImage;
  // Where the cameras' ground truth goes when sensors.stereo.ground_truth asks for it; empty:
  // nowhere.
  std::filesystem::path ground_truth_folder;
  // Where everything that the sensors say is recorded; empty: nowhere. See dataset/euroc_writer.h.
  std::filesystem::path record_folder;
  // Of the runs before this one, to which it may move alike; null: none.
  sim::MotionMemory* motions = nullptr;
};

// What the estimators are told about the sensors: the data sheet, and a calibration turn where the
// scenario asks for one.
[[nodiscard]] nav::Rig ToldRig(const Scenario& scenario, const sim::RunKey& key);

// progress: called now and then with the simulated fraction of the run, 0 to 1; may be empty.
[[nodiscard]] RunRecord RunClosedLoop(const Scenario& scenario, const RunOptions& options,
                                      const std::function<void(double fraction)>& progress);

}  // namespace polnav::testbed
