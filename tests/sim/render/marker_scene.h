// Bright round spots at known points in a black room: what a camera's geometry is tested with.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <opencv2/core.hpp>
#include <vector>

#include "nav/api/geometry.h"
#include "sim/world/scene.h"
#include "sky/skylight.h"

namespace polnav::sim {

inline sky::WorldSky TestSky() {
  return {sky::SkyOptions{}, Eigen::Vector3d(-0.7, -0.6, 0.3).normalized(), 1};
}

inline void AddQuad(const std::array<Eigen::Vector3d, 4>& corners_ccw, int texture, Scene& scene) {
  constexpr std::array<std::array<float, 2>, 4> kUv = {{{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
  Mesh mesh{.indices = {0, 1, 2, 0, 2, 3}, .texture = texture};
  for (std::size_t i = 0; i < 4; ++i) {
    // Lit as if level, so that every spot is equally bright.
    mesh.vertices.push_back({corners_ccw[i].cast<float>(), Eigen::Vector3f::UnitZ(),
                             Eigen::Vector2f(kUv[i][0], kUv[i][1])});
  }
  scene.meshes.push_back(mesh);
}

// Texture 0 is black, 1 a Gaussian spot that reaches zero before its border, 2 is white.
inline Scene BlackRoom() {
  constexpr int kSide = 64;
  cv::Mat spot(kSide, kSide, CV_8UC1);
  for (int row = 0; row < kSide; ++row) {
    for (int col = 0; col < kSide; ++col) {
      const double x = (col - 0.5 * (kSide - 1)) / 8.0;
      const double y = (row - 0.5 * (kSide - 1)) / 8.0;
      spot.at<std::uint8_t>(row, col) =
          cv::saturate_cast<std::uint8_t>(255.0 * std::exp(-0.5 * (x * x + y * y)));
    }
  }
  Scene scene;
  scene.textures = {cv::Mat::zeros(4, 4, CV_8UC1), spot, cv::Mat(4, 4, CV_8UC1, cv::Scalar(255))};
  constexpr double kWall_m = 250.0;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double sign : {-1.0, 1.0}) {
      // right x up points inwards.
      Eigen::Vector3d inward = Eigen::Vector3d::Zero();
      inward[axis] = -sign;
      const Eigen::Vector3d right = Eigen::Vector3d::Unit((axis + 1) % 3);
      const Eigen::Vector3d up = inward.cross(right);
      const Eigen::Vector3d center = -kWall_m * inward;
      AddQuad({center + kWall_m * (-right - up), center + kWall_m * (right - up),
               center + kWall_m * (right + up), center + kWall_m * (-right + up)},
              0, scene);
    }
  }
  return scene;
}

// A spot at p_C whose plane is parallel to the image, some 24 pixels wide.
inline void AddSpot(const nav::Pose& T_WC, const Eigen::Vector3d& p_C, double focal_px,
                    Scene& scene) {
  const double half = 12.0 * p_C.z() / focal_px;
  const auto corner = [&](double x, double y) {
    return Eigen::Vector3d(T_WC * (p_C + Eigen::Vector3d(x * half, y * half, 0.0)));
  };
  AddQuad({corner(-1, 1), corner(1, 1), corner(1, -1), corner(-1, -1)}, 1, scene);
}

// Centre of brightness within 16 pixels of a guess, refined once.
inline Eigen::Vector2d Centroid(const cv::Mat& image, Eigen::Vector2d guess) {
  for (int pass = 0; pass < 2; ++pass) {
    constexpr int kReach = 16;
    const int u0 = static_cast<int>(std::lround(guess.x()));
    const int v0 = static_cast<int>(std::lround(guess.y()));
    double sum = 0.0;
    Eigen::Vector2d moment = Eigen::Vector2d::Zero();
    for (int v = std::max(0, v0 - kReach); v <= std::min(image.rows - 1, v0 + kReach); ++v) {
      for (int u = std::max(0, u0 - kReach); u <= std::min(image.cols - 1, u0 + kReach); ++u) {
        const double grey = image.at<std::uint8_t>(v, u);
        if (grey < 6.0) continue;  // read noise in the dark
        sum += grey;
        moment += grey * Eigen::Vector2d(u, v);
      }
    }
    if (sum == 0.0) return {-1e3, -1e3};
    guess = moment / sum;
  }
  return guess;
}

}  // namespace polnav::sim
