#include "sim/sensors/flow_interval.h"

#include <stdexcept>

namespace polnav::sim {

nav::OpticalFlowSample Integrate(const FlowInterval& interval,
                                 const std::vector<PictureShift>& shifts, double focal_px) {
  const std::vector<FlowFrame>& frames = interval.frames;
  if (frames.size() != shifts.size() + 1 || shifts.empty()) {
    throw std::logic_error("Integrate: one displacement from each frame to the next");
  }
  nav::OpticalFlowSample sample{.stamp = frames.back().stamp, .range_m = interval.range_m};
  Eigen::Vector3d turned = Eigen::Vector3d::Zero();
  double matched = 0.0;
  for (std::size_t i = 0; i < shifts.size(); ++i) {
    const FlowFrame& frame = frames[i + 1];
    turned += frame.gyro_rad;
    if (!shifts[i].valid()) continue;
    // A turn about x moves the picture down, one about y moves it to the left.
    sample.flow_rad += Eigen::Vector2d(shifts[i].shift_px.y(), -shifts[i].shift_px.x()) / focal_px;
    sample.gyro_rad += frame.gyro_rad;
    sample.integration += frame.stamp - frames[i].stamp;
    matched += static_cast<double>(shifts[i].matched) / shifts[i].blocks;
  }
  sample.quality = matched / static_cast<double>(shifts.size());
  if (sample.integration == 0) {
    sample.integration = frames.back().stamp - frames.front().stamp;
    sample.gyro_rad = turned;
  }
  return sample;
}

}  // namespace polnav::sim
