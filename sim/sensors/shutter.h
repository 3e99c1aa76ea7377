// When does which row of a picture see the world?
//
// Row v of an image of `rows` is exposed for exposure_time_s about
//   stamp + rolling_shutter_s (v / (rows - 1) - 1/2),
// so that the stamp is the middle of the exposure of the middle row. The time that any row is open
// is cut into equal sub-frames, each drawn as an instant at its middle; a row is the mean of the
// sub-frames, weighted by the time for which it was open in each.
// The vehicle keeps its velocity and its angular velocity meanwhile: over 20 ms that errs by half
// the acceleration times (10 ms)^2, 0.15 mm at 3 m/s^2. Greys are averaged after each sub-frame was
// clipped at full scale: a lamp that saturates leaves a streak that is too dark.
#pragma once

#include <vector>

#include "nav/api/geometry.h"
#include "nav/api/time.h"
#include "sim/sensors/frame_request.h"

namespace polnav::sim {

struct SubFrame {
  nav::TimeNs stamp = 0;
  nav::Pose T_WB;
};

class Shutter {
 public:
  Shutter(double exposure_time_s, double rolling_shutter_s, double focal_px);

  // Everything at one instant: the picture is its only sub-frame.
  [[nodiscard]] bool IsInstant() const { return open_s_ == 0.0; }

  // So many that from one to the next neither the picture moves by more than half a pixel, things
  // 3 m away taken as the nearest, nor more than a millisecond passes; but never more than 64.
  [[nodiscard]] std::vector<SubFrame> SubFramesOf(const FrameRequest& request) const;

  // Share of a row's exposure that falls into sub-frame i of `count`; they sum to one.
  [[nodiscard]] double Share(int row, int rows, int i, int count) const;

 private:
  double exposure_time_s_;
  double rolling_shutter_s_;
  double open_s_;  // from the first row's beginning to the last row's end
  double focal_px_;
};

}  // namespace polnav::sim
