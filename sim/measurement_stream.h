// How do measurements come out in order while pictures are still being taken?
//
// One thread steps the simulator, `render_threads` threads take its pictures, and Next() hands
// everything over in order of stamps. A bounded number of pictures is under way, so memory does not
// grow and a slow estimator slows the simulation instead of missing anything. What comes out does
// not depend on the number of threads.
#pragma once

#include <condition_variable>
#include <deque>
#include <future>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <variant>
#include <vector>

#include "nav/api/measurements.h"
#include "sim/sensors/frame_truth.h"
#include "sim/sensors/optical_flow_camera.h"
#include "sim/simulator.h"

namespace polnav::sim {

// A frame's truth comes out when the next frame's place is known; the last frame has none.
// At measurement level sightings come in the place of pictures: what they mean in a rectified pair
// is for who knows the nominal calibration.
using StreamItem = std::variant<Truth, nav::Measurement, FrameTruth, FeatureSightings>;

class MeasurementStream {
 public:
  // Emits what falls due from time zero up to and including `duration`.
  // motion: as the simulator takes it.
  MeasurementStream(const SimulatorOptions& options, const RunKey& key, nav::TimeNs duration,
                    int render_threads, std::shared_ptr<const Motion> motion = nullptr);
  ~MeasurementStream();
  MeasurementStream(const MeasurementStream&) = delete;
  MeasurementStream& operator=(const MeasurementStream&) = delete;

  // Nothing at the end. Rethrows what went wrong in the threads behind it.
  [[nodiscard]] std::optional<StreamItem> Next();

  // Wall times of the pictures handed over so far, by what took them; for reports only [ms].
  [[nodiscard]] const std::map<std::string, std::vector<double>>& picture_ms() const {
    return picture_ms_;
  }

 private:
  using PictureRequest = std::variant<FrameRequest, SkyRequest, FrameTruthRequest, FlowRequest>;
  struct TimedPicture {
    StreamItem picture;
    const char* stage = "";  // key of picture_ms
    double ms = 0.0;
  };
  // A thread's own: their OpenGL contexts belong to it.
  struct Cameras {
    std::optional<StereoCamera> stereo;
    std::optional<OpticalFlowCamera> flow;
  };
  struct PictureJob {
    PictureRequest request;
    std::promise<TimedPicture> done;
  };
  using Slot = std::variant<StreamItem, std::future<TimedPicture>>;

  [[nodiscard]] bool takes_pictures() const {
    return simulator_.true_stereo() && options_.level == Level::kImage;
  }
  void Simulate(nav::TimeNs duration);
  void TakePictures();
  [[nodiscard]] TimedPicture Take(const PictureRequest& request, Cameras& cameras) const;
  [[nodiscard]] bool Push(const Simulator::Emission& emission);
  [[nodiscard]] bool PushFrame(const FrameRequest& request);
  [[nodiscard]] bool Ask(const PictureRequest& request);
  [[nodiscard]] bool Put(StreamItem item);
  [[nodiscard]] bool ReadyToHandOver() const;
  [[nodiscard]] bool WaitForRoom(std::unique_lock<std::mutex>& lock);

  SimulatorOptions options_;
  RunKey key_;
  Simulator simulator_;
  std::optional<FrameRequest> last_frame_;  // only the simulator's thread uses it
  std::size_t pictures_under_way_max_;

  std::mutex mutex_;
  std::condition_variable room_;   // for the simulator: a picture was handed over
  std::condition_variable job_;    // for the cameras: a picture is wanted
  std::condition_variable ready_;  // for Next(): enough was pushed
  std::deque<Slot> slots_;
  std::deque<Slot> batch_;  // taken from slots_; Next()'s own
  std::deque<PictureJob> jobs_;
  std::size_t pictures_under_way_ = 0;
  bool finished_ = false;   // the simulator has emitted everything
  bool abandoned_ = false;  // nobody will call Next() again
  std::exception_ptr failure_;
  std::map<std::string, std::vector<double>> picture_ms_;
  std::vector<std::jthread> threads_;  // last: they end before what they use
};

}  // namespace polnav::sim
