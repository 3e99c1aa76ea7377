// How do measurements come out in order while pictures are still being taken?
//
// One thread steps the simulator, `render_threads` threads take its pictures, and Next() hands
// everything over in order of stamps. A bounded number of frames is under way, so memory does not
// grow and a slow estimator slows the simulation instead of missing anything. What comes out does
// not depend on the number of threads.
#pragma once

#include <condition_variable>
#include <deque>
#include <future>
#include <mutex>
#include <optional>
#include <thread>
#include <variant>
#include <vector>

#include "nav/api/measurements.h"
#include "sim/simulator.h"

namespace polnav::sim {

// Wall time that one picture pair took, for reports only.
struct TimedImages {
  nav::StereoImages images;
  double render_ms = 0.0;
};

using StreamItem = std::variant<Truth, nav::Measurement>;

class MeasurementStream {
 public:
  // Emits what falls due from time zero up to and including `duration`.
  MeasurementStream(const SimulatorOptions& options, const RunKey& key, nav::TimeNs duration,
                    int render_threads);
  ~MeasurementStream();
  MeasurementStream(const MeasurementStream&) = delete;
  MeasurementStream& operator=(const MeasurementStream&) = delete;

  // Nothing at the end. Rethrows what went wrong in the threads behind it.
  [[nodiscard]] std::optional<StreamItem> Next();

  // One entry a stereo frame handed over so far [ms].
  [[nodiscard]] const std::vector<double>& render_ms() const { return render_ms_; }

 private:
  struct FrameJob {
    FrameRequest request;
    std::promise<TimedImages> done;
  };
  using Slot = std::variant<StreamItem, std::future<TimedImages>>;

  void Simulate(nav::TimeNs duration);
  void TakePictures();
  [[nodiscard]] bool Push(const Simulator::Emission& emission);

  SimulatorOptions options_;
  RunKey key_;
  Simulator simulator_;
  std::size_t frames_under_way_max_;

  std::mutex mutex_;
  std::condition_variable room_;   // for the simulator: a frame was handed over
  std::condition_variable job_;    // for the cameras: a picture is wanted
  std::condition_variable ready_;  // for Next(): something was pushed
  std::deque<Slot> slots_;
  std::deque<FrameJob> jobs_;
  std::size_t frames_under_way_ = 0;
  bool finished_ = false;   // the simulator has emitted everything
  bool abandoned_ = false;  // nobody will call Next() again
  std::exception_ptr failure_;
  std::vector<double> render_ms_;
  std::vector<std::jthread> threads_;  // last: they end before what they use
};

}  // namespace polnav::sim
