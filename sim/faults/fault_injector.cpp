#include "sim/faults/fault_injector.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "sim/faults/corruption.h"
#include "sim/faults/deviation.h"

namespace polnav::sim {
namespace {

void SetStamp(nav::TimeNs stamp, nav::Measurement& measurement) {
  std::visit([&](auto& m) { m.stamp = stamp; }, measurement);
}

void Kill(const DeadChannelFault& fault, const nav::Rig& rig, nav::Measurement& measurement) {
  if (auto* light = std::get_if<nav::PolarizationSample>(&measurement)) {
    light->channel.at(static_cast<std::size_t>(fault.channel)) = fault.level;
  } else if (auto* sky = std::get_if<nav::PolarizationImage>(&measurement)) {
    const double value = std::round(fault.level * FullScale(rig, sky->mosaic));
    sky->mosaic = sky->mosaic.clone();
    for (int row = fault.channel / 2; row < sky->mosaic.rows; row += 2) {
      for (int column = fault.channel % 2; column < sky->mosaic.cols; column += 2) {
        sky->mosaic(cv::Rect(column, row, 1, 1)).setTo(value);
      }
    }
  }
}

// In whole nanoseconds of the fault's own duration: a stamp never passes through double.
nav::TimeNs ClockError(const ClockFault& fault, nav::TimeNs since_begin) {
  const double skew_ns = fault.skew_ppm * 1e-6 * static_cast<double>(since_begin);
  return nav::FromSeconds(fault.offset_s) + static_cast<nav::TimeNs>(std::llround(skew_ns));
}

}  // namespace

FaultInjector::FaultInjector(const std::vector<FaultOptions>& faults, const nav::Rig& rig,
                             std::uint64_t seed, std::uint64_t trial)
    : rig_(rig) {
  for (std::size_t i = 0; i < faults.size(); ++i) {
    const FaultOptions& options = faults[i];
    const std::vector<FaultKind> kinds = KindsGiven(options);
    if (kinds.size() != 1 || !KindFits(kinds[0], options.sensor)) {
      throw std::logic_error("FaultInjector: a fault has one kind, and one that fits its sensor");
    }
    const nav::TimeNs begin = nav::FromSeconds(options.start_s);
    faults_[options.sensor].push_back(
        {.options = options,
         .kind = kinds[0],
         .begin = begin,
         .end = options.duration_s ? begin + nav::FromSeconds(*options.duration_s)
                                   : std::numeric_limits<nav::TimeNs>::max(),
         .random =
             RandomStream(seed, trial, "fault/" + std::to_string(i) + "/" + NameOf(kinds[0]))});
  }
  for (auto& [sensor, list] : faults_) {
    std::stable_sort(list.begin(), list.end(),
                     [](const Fault& a, const Fault& b) { return a.kind < b.kind; });
  }
}

std::vector<nav::Measurement> FaultInjector::Take(const nav::Measurement& measurement) {
  const nav::TimeNs stamp = nav::StampOf(measurement);
  now_ = started_ ? std::max(now_, stamp) : stamp;
  started_ = true;
  const std::string sensor = nav::StreamName(measurement);
  Passage passage{.measurement = measurement, .stamp = stamp, .index = counts_[sensor]++};
  const auto found = faults_.find(sensor);
  if (found != faults_.end()) {
    for (Fault& fault : found->second) PassThrough(fault, passage);
  }
  for (int i = 0; i < passage.copies; ++i) {
    under_way_.emplace(now_ + passage.late, passage.measurement);
  }
  std::vector<nav::Measurement> arrived;
  const auto later = under_way_.upper_bound(now_);
  for (auto it = under_way_.begin(); it != later; ++it) arrived.push_back(std::move(it->second));
  under_way_.erase(under_way_.begin(), later);
  return arrived;
}

std::vector<nav::Measurement> FaultInjector::Flush() {
  std::vector<nav::Measurement> arrived;
  for (auto& [arrival, measurement] : under_way_) arrived.push_back(std::move(measurement));
  under_way_.clear();
  return arrived;
}

void FaultInjector::PassThrough(Fault& fault, Passage& passage) const {
  const bool active = passage.stamp >= fault.begin && passage.stamp < fault.end;
  // Stuck from the very start: at its first reading.
  const bool before = passage.stamp < fault.begin;
  if (fault.kind == FaultKind::kStuck && (before || (active && !fault.held))) {
    fault.held = passage.measurement;
  }
  if (!active) return;
  RandomStream::Sample draw = fault.random.At(passage.index);
  const FaultOptions& o = fault.options;
  switch (fault.kind) {
    case FaultKind::kClock:
      SetStamp(passage.stamp + ClockError(*o.clock, passage.stamp - fault.begin),
               passage.measurement);
      return;
    case FaultKind::kOff:
      passage.copies = 0;
      return;
    case FaultKind::kDrop:
      if (draw.Uniform() < o.drop->probability) passage.copies = 0;
      return;
    case FaultKind::kDuplicate:
      if (draw.Uniform() < o.duplicate->probability) passage.copies *= 1 + o.duplicate->copies;
      return;
    case FaultKind::kDelay:
      passage.late += nav::FromSeconds(o.delay->delay_s);
      return;
    case FaultKind::kReorder:
      if (draw.Uniform() < o.reorder->probability) {
        passage.late += nav::FromSeconds(o.reorder->hold_s);
      }
      return;
    default:
      ChangeReading(fault, passage, draw);
  }
}

void FaultInjector::ChangeReading(Fault& fault, Passage& passage,
                                  RandomStream::Sample& draw) const {
  const FaultOptions& o = fault.options;
  const auto normal = [&] { return draw.Gaussian(); };
  switch (fault.kind) {
    case FaultKind::kStuck:
      passage.measurement = *fault.held;
      SetStamp(passage.stamp, passage.measurement);
      return;
    case FaultKind::kBias:
      Deviate(
          *o.bias, rig_, [] { return 1.0; }, passage.measurement);
      return;
    case FaultKind::kDrift: {
      const double grown = nav::ToSeconds(passage.stamp - fault.begin) / o.drift->over_s;
      Deviate(
          *o.drift, rig_, [&] { return grown; }, passage.measurement);
      return;
    }
    case FaultKind::kNoise:
      if (o.noise->times) {
        MultiplyNoise(*o.noise->times, rig_, normal, passage.measurement);
      } else {
        Deviate(*o.noise, rig_, normal, passage.measurement);
      }
      return;
    case FaultKind::kDeadChannel:
      Kill(*o.dead_channel, rig_, passage.measurement);
      return;
    case FaultKind::kCorrupt:
      if (draw.Uniform() < o.corrupt->probability) {
        CorruptPictures(*o.corrupt, draw, passage.measurement);
      }
      return;
    default:
      throw std::logic_error("FaultInjector: this kind does not change readings");
  }
}

void FaultInjector::CorruptPictures(const CorruptFault& fault, RandomStream::Sample& draw,
                                    nav::Measurement& measurement) const {
  if (auto* pair = std::get_if<nav::StereoImages>(&measurement)) {
    if (fault.side != "right") pair->left = Corrupted(fault, 255.0, pair->left, draw);
    if (fault.side != "left") pair->right = Corrupted(fault, 255.0, pair->right, draw);
  } else if (auto* sky = std::get_if<nav::PolarizationImage>(&measurement)) {
    sky->mosaic = Corrupted(fault, FullScale(rig_, sky->mosaic), sky->mosaic, draw);
  }
}

}  // namespace polnav::sim
