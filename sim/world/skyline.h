// Above which elevation is there nothing around an eye?
//
// A bound by azimuth, made from upright cylinders about things: quick to ask for the thousands of
// rays of a picture of the sky, and never below the truth.
#pragma once

#include <Eigen/Core>
#include <array>

namespace polnav::sim {

class Skyline {
 public:
  explicit Skyline(const Eigen::Vector3d& eye_m) : eye_m_(eye_m) {}

  struct Cylinder {
    double x_m, y_m, radius_m, top_m;
  };
  void Raise(const Cylinder& thing);

  // ray: unit vector. True: nothing of what the skyline was raised for is along it.
  [[nodiscard]] bool IsBelow(const Eigen::Vector3d& ray) const;

 private:
  // Narrow enough for houses, few enough to be cheap; counter-clockwise from east.
  static constexpr std::size_t kCells = 256;
  [[nodiscard]] static std::size_t CellAt(double angle_rad);

  Eigen::Vector3d eye_m_;
  std::array<float, kCells> sine_{};  // of the elevation; the horizon where nothing is higher
};

}  // namespace polnav::sim
