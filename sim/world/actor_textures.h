// What is painted on cars, buses and people?
//
// A vehicle's texture is an atlas of its views: left side, right side, from above, front and back,
// each scaled to the vehicle's length, width and height (AtlasView). Row 0 is the top.
#pragma once

#include <array>
#include <opencv2/core/mat.hpp>

#include "sim/random.h"

namespace polnav::sim {

// A point of a side view: along from the back (0) to the front (length), up from the ground [m].
struct Profile {
  double x_m, z_m;
};

// The outline of a car from back to front along its top, and where its wheels are.
struct CarShape {
  double length_m = 4.5;
  double width_m = 1.78;
  double height_m = 1.46;
  std::array<Profile, 8> top;  // bumper, boot, rear window from and to, roof to, bonnet, nose
  double rear_wheel_m = 0.85;  // from the back
  double front_wheel_m = 3.55;
  double wheel_radius_m = 0.32;
};
[[nodiscard]] CarShape Saloon();
[[nodiscard]] CarShape Hatchback();
[[nodiscard]] CarShape OffRoader();

// Where in a vehicle's texture a view lies: shares of its width and height.
struct AtlasView {
  double u, v, width, height;
};
inline constexpr AtlasView kLeftView{0.0, 0.0, 1.0, 0.25};
inline constexpr AtlasView kRightView{0.0, 0.25, 1.0, 0.25};
inline constexpr AtlasView kTopView{0.0, 0.5, 1.0, 0.25};
inline constexpr AtlasView kFrontView{0.0, 0.75, 0.5, 0.25};
inline constexpr AtlasView kBackView{0.5, 0.75, 0.5, 0.25};

inline constexpr double kBusLength_m = 12.0;
inline constexpr double kBusWidth_m = 2.55;
inline constexpr double kBusHeight_m = 3.2;

// paint: reflectance of the body in grey levels.
[[nodiscard]] cv::Mat CarTexture(const CarShape& shape, double paint,
                                 RandomStream::Sample& random);  // 512 x 1024
[[nodiscard]] cv::Mat BusTexture(RandomStream::Sample& random);  // 1024 x 1024
// Cloth with a weave, stripes or checks.
[[nodiscard]] cv::Mat ClothTexture(int style, RandomStream::Sample& random);  // 256 x 256

}  // namespace polnav::sim
