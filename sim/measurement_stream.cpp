#include "sim/measurement_stream.h"

#include <chrono>
#include <stdexcept>
#include <utility>

namespace polnav::sim {
namespace {

constexpr std::size_t kSlotsMax = 1024;  // some seconds of all sensors

}  // namespace

MeasurementStream::MeasurementStream(const SimulatorOptions& options, const RunKey& key,
                                     nav::TimeNs duration, int render_threads)
    : options_(options), key_(key), simulator_(options, key, duration) {
  if (render_threads < 1) throw std::logic_error("MeasurementStream: needs a render thread");
  // Enough for every camera to be busy while one picture waits in front of the estimators.
  pictures_under_way_max_ = 2 * static_cast<std::size_t>(render_threads) + 2;
  if (simulator_.true_stereo() || simulator_.polarization_camera()) {
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
    while (simulator_.truth().stamp <= duration) {
      for (const Simulator::Emission& emission : simulator_.Step()) {
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

// False: nobody wants any more.
bool MeasurementStream::Push(const Simulator::Emission& emission) {
  std::unique_lock lock(mutex_);
  room_.wait(lock, [&] {
    return abandoned_ ||
           (pictures_under_way_ < pictures_under_way_max_ && slots_.size() < kSlotsMax);
  });
  const auto ask = [&](const PictureRequest& request) {
    jobs_.push_back({request, {}});
    slots_.emplace_back(jobs_.back().done.get_future());
    ++pictures_under_way_;
    job_.notify_one();
  };
  if (const auto* request = std::get_if<FrameRequest>(&emission)) {
    ask(*request);
  } else if (const auto* sky = std::get_if<SkyRequest>(&emission)) {
    ask(*sky);
  } else if (const auto* truth = std::get_if<Truth>(&emission)) {
    slots_.emplace_back(StreamItem(*truth));
  } else if (const auto* imu = std::get_if<nav::ImuSample>(&emission)) {
    slots_.emplace_back(StreamItem(nav::Measurement(*imu)));
  } else if (const auto* light = std::get_if<nav::PolarizationSample>(&emission)) {
    slots_.emplace_back(StreamItem(nav::Measurement(*light)));
  } else {
    slots_.emplace_back(StreamItem(nav::Measurement(std::get<nav::ReferencePose>(emission))));
  }
  ready_.notify_one();
  return !abandoned_;
}

void MeasurementStream::TakePictures() {
  std::optional<StereoCamera> camera;  // its OpenGL context belongs to this thread
  while (true) {
    std::unique_lock lock(mutex_);
    job_.wait(lock, [&] { return abandoned_ || finished_ || !jobs_.empty(); });
    if (abandoned_ || jobs_.empty()) return;
    PictureJob job = std::move(jobs_.front());
    jobs_.pop_front();
    lock.unlock();
    try {
      job.done.set_value(Take(job.request, camera));
    } catch (...) {
      job.done.set_exception(std::current_exception());
    }
  }
}

MeasurementStream::TimedPicture MeasurementStream::Take(const PictureRequest& request,
                                                        std::optional<StereoCamera>& camera) const {
  const auto* frame = std::get_if<FrameRequest>(&request);
  if (frame != nullptr && !camera) {
    camera.emplace(simulator_.scene(), simulator_.sky(), *simulator_.true_stereo(),
                   *options_.sensors.stereo, key_.seed, key_.trial);
  }
  const auto begin = std::chrono::steady_clock::now();
  TimedPicture taken;
  if (frame != nullptr) {
    taken = {.picture = camera->Capture(frame->T_WB, frame->stamp, frame->index),
             .stage = "render"};
  } else {
    const auto& sky = std::get<SkyRequest>(request);
    taken = {.picture = simulator_.polarization_camera()->Take(sky.truth, sky.index),
             .stage = "sky_camera"};
  }
  const std::chrono::duration<double, std::milli> ms = std::chrono::steady_clock::now() - begin;
  taken.ms = ms.count();
  return taken;
}

std::optional<StreamItem> MeasurementStream::Next() {
  std::unique_lock lock(mutex_);
  ready_.wait(lock, [&] { return finished_ || !slots_.empty(); });
  if (slots_.empty()) {
    if (failure_) std::rethrow_exception(failure_);
    return std::nullopt;
  }
  Slot slot = std::move(slots_.front());
  slots_.pop_front();
  room_.notify_one();
  if (auto* item = std::get_if<StreamItem>(&slot)) return std::move(*item);
  lock.unlock();
  TimedPicture taken = std::get<std::future<TimedPicture>>(slot).get();
  lock.lock();
  --pictures_under_way_;
  picture_ms_[taken.stage].push_back(taken.ms);
  room_.notify_one();
  return StreamItem(std::move(taken.picture));
}

}  // namespace polnav::sim
