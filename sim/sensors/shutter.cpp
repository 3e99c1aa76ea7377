#include "sim/sensors/shutter.h"

#include <algorithm>
#include <cmath>

#include "sim/sensors/rotation.h"

namespace polnav::sim {
namespace {

constexpr double kStep_px = 0.5;
constexpr double kStep_s = 1e-3;
constexpr double kNearest_m = 3.0;
constexpr double kCountMax = 64.0;

}  // namespace

Shutter::Shutter(double exposure_time_s, double rolling_shutter_s, double focal_px)
    : exposure_time_s_(exposure_time_s),
      rolling_shutter_s_(rolling_shutter_s),
      open_s_(exposure_time_s + rolling_shutter_s),
      focal_px_(focal_px) {}

std::vector<SubFrame> Shutter::SubFramesOf(const FrameRequest& request) const {
  if (IsInstant()) return {{request.stamp, request.T_WB}};
  const double speed_px_s =
      focal_px_ * (request.w_WB_B_rad_s.norm() + request.v_WB_m_s.norm() / kNearest_m);
  const double wanted = open_s_ * std::max(speed_px_s / kStep_px, 1.0 / kStep_s);
  const int count = static_cast<int>(std::clamp(std::ceil(wanted), 1.0, kCountMax));
  std::vector<SubFrame> sub_frames;
  for (int i = 0; i < count; ++i) {
    const double t_s = open_s_ * ((i + 0.5) / count - 0.5);
    sub_frames.push_back({request.stamp + nav::FromSeconds(t_s),
                          {request.T_WB.q * RotationOf(request.w_WB_B_rad_s * t_s),
                           request.T_WB.p + request.v_WB_m_s * t_s}});
  }
  return sub_frames;
}

double Shutter::Share(int row, int rows, int i, int count) const {
  const double width_s = open_s_ / count;
  const double begin_s = width_s * i - 0.5 * open_s_;
  const double middle_s = rolling_shutter_s_ * (rows > 1 ? row / (rows - 1.0) - 0.5 : 0.0);
  // A row open for less than a sub-frame sees the two about its middle, as it were open for one.
  const double exposure_s = std::max(exposure_time_s_, width_s);
  const double low = std::max(begin_s, middle_s - 0.5 * exposure_s);
  const double high = std::min(begin_s + width_s, middle_s + 0.5 * exposure_s);
  // At the ends of the picture the widened exposure reaches beyond the sub-frames: what is left.
  const double open = std::min(0.5 * open_s_, middle_s + 0.5 * exposure_s) -
                      std::max(-0.5 * open_s_, middle_s - 0.5 * exposure_s);
  return std::max(0.0, high - low) / open;
}

}  // namespace polnav::sim
