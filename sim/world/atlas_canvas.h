// How is a view of a vehicle painted, in metres?
#pragma once

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "sim/random.h"
#include "sim/world/actor_textures.h"

namespace polnav::sim {

// Draws in metres into one view of an atlas; x to the right, z up from the view's lower edge.
class AtlasCanvas {
 public:
  AtlasCanvas(cv::Mat& atlas, const AtlasView& view, double width_m, double height_m)
      : image_(atlas(cv::Rect(static_cast<int>(view.u * atlas.cols),
                              static_cast<int>(view.v * atlas.rows),
                              static_cast<int>(view.width * atlas.cols),
                              static_cast<int>(view.height * atlas.rows)))),
        x_px_m_(image_.cols / width_m),
        z_px_m_(image_.rows / height_m) {}

  void Fill(const std::vector<Profile>& outline, double grey) {
    std::vector<cv::Point> points;
    for (const Profile& p : outline) points.push_back(At(p));
    cv::fillPoly(image_, std::vector<std::vector<cv::Point>>{points}, cv::Scalar(grey),
                 cv::LINE_AA);
  }
  void Box(double x0, double z0, double x1, double z1, double grey) {
    cv::rectangle(image_, At({x0, z0}), At({x1, z1}), cv::Scalar(grey), cv::FILLED);
  }
  void Line(const Profile& from, const Profile& to, double grey, int thickness_px) {
    cv::line(image_, At(from), At(to), cv::Scalar(grey), thickness_px, cv::LINE_AA);
  }
  void Disc(const Profile& center, double radius_m, double grey) {
    cv::ellipse(image_, At(center),
                {static_cast<int>(radius_m * x_px_m_), static_cast<int>(radius_m * z_px_m_)}, 0.0,
                0.0, 360.0, cv::Scalar(grey), cv::FILLED, cv::LINE_AA);
  }
  // Brightness that falls off downwards, as on a bulging panel that mirrors the sky.
  void ShadeDown(double top, double bottom) {
    for (int row = 0; row < image_.rows; ++row) {
      image_.row(row) *= top + (bottom - top) * row / image_.rows;
    }
  }

 private:
  [[nodiscard]] cv::Point At(const Profile& p) const {
    return {static_cast<int>(p.x_m * x_px_m_), static_cast<int>(image_.rows - p.z_m * z_px_m_)};
  }

  cv::Mat image_;
  double x_px_m_;
  double z_px_m_;
};

inline constexpr double kGlass = 22.0;

[[nodiscard]] inline double Between(RandomStream::Sample& random, double low, double high) {
  return low + (high - low) * random.Uniform();
}

// Glass with slabs of what it mirrors, cut off at its outline by being drawn first.
inline void DrawGlass(AtlasCanvas& canvas, double x0, double z0, double x1, double z1,
                      RandomStream::Sample& random) {
  canvas.Box(x0, z0, x1, z1, kGlass);
  const int slabs = 5 + static_cast<int>(3.0 * (x1 - x0));
  for (int i = 0; i < slabs; ++i) {
    const double width = Between(random, 0.1, 0.5);
    const double x = Between(random, x0, std::max(x0, x1 - width));
    const double z = Between(random, z0, z1);
    canvas.Box(x, z0, x + width, z, Between(random, 14.0, 62.0));
  }
}

}  // namespace polnav::sim
