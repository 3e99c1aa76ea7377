// What came in the last moments, and what did the filter know after each?
//
// Steps of the IMU and measurements in order of their stamps, each with the state after it, so that
// one that comes late is put where it belongs and what follows is done again. Holds so many entries
// and forgets the oldest; nothing is allocated after the start.
#pragma once

#include <cstddef>
#include <optional>
#include <variant>
#include <vector>

#include "nav/api/measurements.h"
#include "nav/ukf/ground_sensors.h"
#include "nav/ukf/state.h"

namespace polnav::nav::ukf {

// From the entry before to this one.
struct Step {
  Eigen::Vector3d gyro_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_m_s2 = Eigen::Vector3d::Zero();
  bool blind = false;  // no reading: these are guesses
};

struct Entry {
  TimeNs stamp = 0;
  std::variant<Step, OpticalFlowSample, PolarizationSample> what;
  Error widened = Error::Zero();  // what the filter's doubt added to the variances before it
  State after;
};

class Timeline {
 public:
  explicit Timeline(std::size_t capacity);

  void Start(const State& state);
  [[nodiscard]] bool started() const { return !order_.empty(); }
  [[nodiscard]] std::size_t size() const { return order_.size(); }

  // In order of stamps; 0 is the oldest.
  [[nodiscard]] Entry& at(std::size_t i) { return slots_[order_[i]]; }
  [[nodiscard]] const Entry& at(std::size_t i) const { return slots_[order_[i]]; }
  [[nodiscard]] const State& Now() const { return at(size() - 1).after; }
  [[nodiscard]] TimeNs Oldest() const { return at(0).stamp; }

  // The place behind all entries that are not later.
  [[nodiscard]] std::size_t PlaceOf(TimeNs stamp) const;

  // Makes room there; what is in it is the caller's to fill in. Returns the place, which is another
  // when the oldest entry had to go.
  std::size_t Insert(std::size_t place);

  // The flow's interval, which ends at this entry's stamp.
  [[nodiscard]] FlowInterval IntervalBefore(std::size_t place, TimeNs length) const;

 private:
  struct Sums {
    Eigen::Vector3d turned_rad;
    Eigen::Vector3d gained_m_s;
    Eigen::Vector3d gained_m;
  };
  [[nodiscard]] Sums SumsAt(TimeNs stamp) const;

  std::vector<Entry> slots_;
  std::vector<std::size_t> order_;  // of slots
};

}  // namespace polnav::nav::ukf
