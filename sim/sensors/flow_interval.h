// What happens to an optical-flow sensor between two of its readings?
//
//   F  z along the optical axis, x and y as the flow is counted (nav/api/measurements.h). In the
//      picture x is right and y is down.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "nav/api/geometry.h"
#include "nav/api/measurements.h"
#include "nav/api/time.h"
#include "sim/sensors/block_matching.h"

namespace polnav::sim {

// An instant at which the sensor takes a picture.
struct FlowFrame {
  nav::TimeNs stamp = 0;
  nav::Pose T_WF;  // true
  // By its own gyroscopes, since the frame before.
  Eigen::Vector3d gyro_rad = Eigen::Vector3d::Zero();
  // To what is seen along the optical axis; absent: nothing there.
  std::optional<double> distance_m;
};

struct FlowInterval {
  std::uint64_t index = 0;        // of the reading
  std::vector<FlowFrame> frames;  // the first ended the interval before
  std::optional<double> range_m;  // as measured, at the end
};

// How the picture moved from each frame to the next: one less than frames. A displacement that is
// not valid is left out of flow, gyro and time alike, as a PX4Flow does; when none is valid, the
// flow is zero over the whole time, with quality 0. focal_px: what the firmware believes.
[[nodiscard]] nav::OpticalFlowSample Integrate(const FlowInterval& interval,
                                               const std::vector<PictureShift>& shifts,
                                               double focal_px);

}  // namespace polnav::sim
