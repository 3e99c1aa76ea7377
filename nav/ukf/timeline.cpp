#include "nav/ukf/timeline.h"

#include <algorithm>

namespace polnav::nav::ukf {

Timeline::Timeline(std::size_t capacity) : slots_(std::max<std::size_t>(capacity, 8)) {
  order_.reserve(slots_.size());
}

void Timeline::Start(const State& state) {
  order_.assign(1, 0);
  slots_[0] = {.stamp = state.stamp, .what = Step{}, .after = state};
}

std::size_t Timeline::PlaceOf(TimeNs stamp) const {
  std::size_t place = size();
  while (place > 0 && at(place - 1).stamp > stamp) --place;
  return place;
}

std::size_t Timeline::Insert(std::size_t place) {
  std::size_t slot = order_.size();
  if (order_.size() == slots_.size()) {
    slot = order_.front();
    order_.erase(order_.begin());
    --place;
  }
  order_.insert(order_.begin() + static_cast<std::ptrdiff_t>(place), slot);
  at(place).widened.setZero();
  return place;
}

Timeline::Sums Timeline::SumsAt(TimeNs stamp) const {
  const std::size_t next = PlaceOf(stamp);
  const auto whole = [](const State& s) { return Sums{s.turned_rad, s.gained_m_s, s.gained_m}; };
  if (next == 0) return whole(at(0).after);
  const State& from = at(next - 1).after;
  if (next == size() || from.stamp == stamp) return whole(from);
  const State& to = at(next).after;
  const double length = ToSeconds(to.stamp - from.stamp);
  const double passed = ToSeconds(stamp - from.stamp);
  const double share = passed / length;
  const Eigen::Vector3d gained = to.gained_m_s - from.gained_m_s;
  return {from.turned_rad + share * (to.turned_rad - from.turned_rad),
          from.gained_m_s + share * gained,
          from.gained_m + passed * (from.gained_m_s + 0.5 * share * gained)};
}

FlowInterval Timeline::IntervalBefore(std::size_t place, TimeNs length) const {
  const State& end = at(place).after;
  const TimeNs begin = std::max(end.stamp - length, Oldest());
  if (begin >= end.stamp) return {};
  const Sums start = SumsAt(begin);
  const double dt = ToSeconds(end.stamp - begin);
  return {.rate_rad_s = (end.turned_rad - start.turned_rad) / dt,
          .gained_m_s = end.gained_m_s - (end.gained_m - start.gained_m) / dt,
          .duration_s = dt};
}

}  // namespace polnav::nav::ukf
