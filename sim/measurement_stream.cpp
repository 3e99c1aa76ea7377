#include "sim/measurement_stream.h"

#include <chrono>
#include <stdexcept>
#include <utility>

#include "sim/sensors/auto_exposure.h"

namespace polnav::sim {
namespace {

constexpr std::size_t kSlotsMax = 1024;  // some seconds of all sensors
// Handed over at once where no picture is under way: to wake a thread for every reading costs more
// than the reading.
constexpr std::size_t kBatch = 128;

}  // namespace

MeasurementStream::MeasurementStream(const SimulatorOptions& options, const RunKey& key,
                                     nav::TimeNs duration, int render_threads,
                                     std::shared_ptr<const Motion> motion)
    : options_(options), key_(key), simulator_(options, key, duration, std::move(motion)) {
  if (render_threads < 1) throw std::logic_error("MeasurementStream: needs a render thread");
  // Enough for every camera to be busy while one picture waits in front of the estimators.
  pictures_under_way_max_ = 2 * static_cast<std::size_t>(render_threads) + 2;
  if (takes_pictures() || simulator_.polarization_camera() || simulator_.looks_down()) {
    for (int i = 0; i < render_threads; ++i) threads_.emplace_back([this] { TakePictures(); });
  }
  threads_.emplace_back([this, duration] { Simulate(duration); });
}

MeasurementStream::~MeasurementStream() {
  const std::lock_guard lock(mutex_);
  abandoned_ = true;
  room_.notify_all();
  job_.notify_all();
}

void MeasurementStream::Simulate(nav::TimeNs duration) {
  try {
    std::optional<AutoExposure> auto_exposure;  // its OpenGL context belongs to this thread
    if (takes_pictures() && options_.sensors.stereo->auto_exposure) {
      auto_exposure.emplace(simulator_.scene(), simulator_.sky(), simulator_.true_stereo()->left,
                            *options_.sensors.stereo);
    }
    while (simulator_.truth().stamp <= duration) {
      for (Simulator::Emission& emission : simulator_.Step()) {
        auto* const frame = std::get_if<FrameRequest>(&emission);
        if (frame != nullptr && auto_exposure) frame->exposure = auto_exposure->Next(*frame);
        if (!Push(emission)) return;
      }
    }
  } catch (...) {
    const std::lock_guard lock(mutex_);
    failure_ = std::current_exception();
  }
  const std::lock_guard lock(mutex_);
  finished_ = true;
  ready_.notify_all();
  job_.notify_all();
}

// False: nobody wants any more. This and the three below.
bool MeasurementStream::Push(const Simulator::Emission& emission) {
  if (const auto* request = std::get_if<FrameRequest>(&emission)) return PushFrame(*request);
  if (const auto* sky = std::get_if<SkyRequest>(&emission)) return Ask(*sky);
  if (const auto* flow = std::get_if<FlowRequest>(&emission)) return Ask(*flow);
  if (const auto* truth = std::get_if<Truth>(&emission)) return Put(StreamItem(*truth));
  if (const auto* seen = std::get_if<FeatureSightings>(&emission)) return Put(StreamItem(*seen));
  if (const auto* imu = std::get_if<nav::ImuSample>(&emission)) {
    return Put(StreamItem(nav::Measurement(*imu)));
  }
  if (const auto* light = std::get_if<nav::PolarizationSample>(&emission)) {
    return Put(StreamItem(nav::Measurement(*light)));
  }
  if (const auto* flow = std::get_if<nav::OpticalFlowSample>(&emission)) {
    return Put(StreamItem(nav::Measurement(*flow)));
  }
  return Put(StreamItem(nav::Measurement(std::get<nav::ReferencePose>(emission))));
}

bool MeasurementStream::PushFrame(const FrameRequest& request) {
  if (options_.sensors.stereo->ground_truth) {
    if (last_frame_ && !Ask(FrameTruthRequest{*last_frame_, request.stamp, request.T_WB})) {
      return false;
    }
    last_frame_ = request;
  }
  return Ask(request);
}

bool MeasurementStream::Ask(const PictureRequest& request) {
  std::unique_lock lock(mutex_);
  if (!WaitForRoom(lock)) return false;
  jobs_.push_back({request, {}});
  slots_.emplace_back(jobs_.back().done.get_future());
  ++pictures_under_way_;
  job_.notify_one();
  ready_.notify_one();
  return true;
}

bool MeasurementStream::Put(StreamItem item) {
  std::unique_lock lock(mutex_);
  if (!WaitForRoom(lock)) return false;
  slots_.emplace_back(std::move(item));
  if (ReadyToHandOver()) ready_.notify_one();
  return true;
}

// The simulator waits for room only when one of these holds, so that neither waits for the other.
bool MeasurementStream::ReadyToHandOver() const {
  return finished_ || pictures_under_way_ > 0 || slots_.size() >= kBatch;
}

bool MeasurementStream::WaitForRoom(std::unique_lock<std::mutex>& lock) {
  room_.wait(lock, [&] {
    return abandoned_ ||
           (pictures_under_way_ < pictures_under_way_max_ && slots_.size() < kSlotsMax);
  });
  return !abandoned_;
}

void MeasurementStream::TakePictures() {
  Cameras cameras;
  while (true) {
    std::unique_lock lock(mutex_);
    job_.wait(lock, [&] { return abandoned_ || finished_ || !jobs_.empty(); });
    if (abandoned_ || jobs_.empty()) return;
    PictureJob job = std::move(jobs_.front());
    jobs_.pop_front();
    lock.unlock();
    try {
      job.done.set_value(Take(job.request, cameras));
    } catch (...) {
      job.done.set_exception(std::current_exception());
    }
  }
}

MeasurementStream::TimedPicture MeasurementStream::Take(const PictureRequest& request,
                                                        Cameras& cameras) const {
  const auto* frame = std::get_if<FrameRequest>(&request);
  const auto* frame_truth = std::get_if<FrameTruthRequest>(&request);
  const auto* flow = std::get_if<FlowRequest>(&request);
  if ((frame != nullptr || frame_truth != nullptr) && !cameras.stereo) {
    cameras.stereo.emplace(simulator_.scene(), simulator_.sky(), *simulator_.true_stereo(),
                           *options_.sensors.stereo, key_.seed, key_.trial);
  }
  if (flow != nullptr && !cameras.flow) {
    cameras.flow.emplace(simulator_.scene(), simulator_.sky(), *options_.sensors.optical_flow,
                         GrainContrast(options_.world), key_.seed, key_.trial);
  }
  const auto begin = std::chrono::steady_clock::now();
  TimedPicture taken;
  if (frame != nullptr) {
    taken = {.picture = nav::Measurement(cameras.stereo->Capture(*frame)), .stage = "render"};
  } else if (frame_truth != nullptr) {
    taken = {.picture = cameras.stereo->CaptureTruth(*frame_truth), .stage = "ground_truth"};
  } else if (flow != nullptr) {
    taken = {.picture = nav::Measurement(cameras.flow->Take(flow->interval)),
             .stage = "flow_camera"};
  } else {
    const auto& sky = std::get<SkyRequest>(request);
    taken = {.picture = nav::Measurement(
                 simulator_.polarization_camera()->Take(sky.truth, sky.index, sky.fog)),
             .stage = "sky_camera"};
  }
  const std::chrono::duration<double, std::milli> ms = std::chrono::steady_clock::now() - begin;
  taken.ms = ms.count();
  return taken;
}

std::optional<StreamItem> MeasurementStream::Next() {
  if (batch_.empty()) {
    std::unique_lock lock(mutex_);
    ready_.wait(lock, [&] { return finished_ || (ReadyToHandOver() && !slots_.empty()); });
    if (slots_.empty()) {
      if (failure_) std::rethrow_exception(failure_);
      return std::nullopt;
    }
    std::swap(batch_, slots_);
    room_.notify_one();
  }
  Slot slot = std::move(batch_.front());
  batch_.pop_front();
  if (auto* item = std::get_if<StreamItem>(&slot)) return std::move(*item);
  TimedPicture taken = std::get<std::future<TimedPicture>>(slot).get();
  const std::lock_guard lock(mutex_);
  --pictures_under_way_;
  picture_ms_[taken.stage].push_back(taken.ms);
  room_.notify_one();
  return std::move(taken.picture);
}

}  // namespace polnav::sim
