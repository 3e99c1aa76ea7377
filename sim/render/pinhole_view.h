// What does an ideal camera project where?
#pragma once

namespace polnav::sim {

// Pixel (0, 0) is the centre of the top left pixel; camera x right, y down, z forward.
struct PinholeView {
  int width_px = 0;
  int height_px = 0;
  double fx_px = 0.0;
  double fy_px = 0.0;
  double cx_px = 0.0;
  double cy_px = 0.0;
};

}  // namespace polnav::sim
