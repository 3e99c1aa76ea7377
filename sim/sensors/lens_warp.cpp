#include "sim/sensors/lens_warp.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "sim/sensors/lens.h"

namespace polnav::sim {
namespace {

using Eigen::Vector2d;

constexpr double kMargin_px = 2.0;  // bilinear interpolation reaches one pixel further
constexpr double kSlack_rad = 3.0 * M_PI / 180.0;
constexpr int kSegments = 16;  // of each edge of the image

// Normalized coordinates along an edge (top, bottom, left, right) of a camera's image, t in [0, 1].
Vector2d OnEdge(const nav::CameraCalibration& camera, int side, double t) {
  const double right = camera.width_px - 1.0;
  const double bottom = camera.height_px - 1.0;
  switch (side) {
    case 0:
      return RayOfPixel(camera, t * right, 0.0);
    case 1:
      return RayOfPixel(camera, t * right, bottom);
    case 2:
      return RayOfPixel(camera, 0.0, t * bottom);
    default:
      return RayOfPixel(camera, right, t * bottom);
  }
}

}  // namespace

double AngleOfField(const nav::CameraCalibration& camera) {
  double widest = 0.0;
  for (int side = 0; side < 4; ++side) {
    // The corners are the furthest from the axis; what is monotonic out to them is so everywhere.
    for (const double t : {0.0, 1.0}) {
      const Vector2d xy = OnEdge(camera, side, t);
      double grown = 0.0;
      for (int i = 1; i <= kSegments; ++i) {
        const double radius = Distort(camera, xy * i / kSegments).norm();
        if (!(radius > grown)) return std::nan("");
        grown = radius;
      }
      widest = std::max(widest, std::atan(xy.norm()));
    }
  }
  return widest;
}

PinholeView CoveringView(const std::vector<nav::CameraCalibration>& cameras, double focal_share) {
  for (const nav::CameraCalibration& camera : cameras) {
    if (!(AngleOfField(camera) <= kWidestAngle_rad + kSlack_rad)) {
      throw std::logic_error("CoveringView: the lens sees further than a pinhole can show");
    }
  }
  constexpr double kFar = std::numeric_limits<double>::max();
  Vector2d low(kFar, kFar);
  Vector2d high(-kFar, -kFar);
  for (const nav::CameraCalibration& camera : cameras) {
    for (int side = 0; side < 4; ++side) {
      for (int i = 0; i <= kSegments; ++i) {
        const Vector2d xy = OnEdge(camera, side, static_cast<double>(i) / kSegments);
        low = low.cwiseMin(xy);
        high = high.cwiseMax(xy);
      }
    }
  }
  const double f = focal_share * cameras.front().fx_px;
  PinholeView view;
  view.fx_px = f;
  view.fy_px = f;
  view.cx_px = std::ceil(kMargin_px - f * low.x());
  view.cy_px = std::ceil(kMargin_px - f * low.y());
  view.width_px = static_cast<int>(std::ceil(view.cx_px + f * high.x() + kMargin_px)) + 1;
  view.height_px = static_cast<int>(std::ceil(view.cy_px + f * high.y() + kMargin_px)) + 1;
  return view;
}

std::vector<Vector2d> UnseenTriangles(const std::vector<nav::CameraCalibration>& cameras,
                                      const PinholeView& view) {
  std::vector<Vector2d> triangles;
  for (int side = 0; side < 4; ++side) {
    const bool horizontal = side < 2;
    const bool low_side = side % 2 == 0;
    const int along = horizontal ? 0 : 1;
    const double border = low_side ? -0.5 : (horizontal ? view.height_px : view.width_px) - 0.5;
    // The least that any camera sees towards this border, edge point by edge point.
    std::vector<Vector2d> seen;
    for (int i = 0; i <= kSegments; ++i) {
      Vector2d outermost;
      for (std::size_t c = 0; c < cameras.size(); ++c) {
        const Vector2d xy = OnEdge(cameras[c], side, static_cast<double>(i) / kSegments);
        Vector2d p(view.fx_px * xy.x() + view.cx_px, view.fy_px * xy.y() + view.cy_px);
        p[1 - along] += low_side ? -kMargin_px : kMargin_px;
        const bool further = c == 0 || (low_side ? p[1 - along] < outermost[1 - along]
                                                 : p[1 - along] > outermost[1 - along]);
        if (further) outermost = p;
      }
      seen.push_back(outermost);
    }
    for (int i = 0; i < kSegments; ++i) {
      const auto k = static_cast<std::size_t>(i);
      Vector2d a = seen[k];
      Vector2d b = seen[k + 1];
      a[1 - along] = border;
      b[1 - along] = border;
      triangles.insert(triangles.end(), {a, b, seen[k], b, seen[k + 1], seen[k]});
    }
  }
  return triangles;
}

LensWarp::LensWarp(const nav::CameraCalibration& camera, const PinholeView& view) {
  cv::Mat source(camera.height_px, camera.width_px, CV_32FC2);
  for (int row = 0; row < source.rows; ++row) {
    for (int col = 0; col < source.cols; ++col) {
      const Vector2d xy = RayOfPixel(camera, col, row);
      source.at<cv::Vec2f>(row, col) = {static_cast<float>(view.fx_px * xy.x() + view.cx_px),
                                        static_cast<float>(view.fy_px * xy.y() + view.cy_px)};
    }
  }
  cv::convertMaps(source, cv::noArray(), whole_, fraction_, CV_16SC2);
}

void LensWarp::Apply(const cv::Mat& pinhole, cv::Mat& distorted) const {
  cv::remap(pinhole, distorted, whole_, fraction_, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
}

void LensWarp::ApplyToRows(const cv::Mat& pinhole, const cv::Range& rows,
                           cv::Mat& distorted) const {
  cv::Mat strip = distorted.rowRange(rows);
  cv::remap(pinhole, strip, whole_.rowRange(rows), fraction_.rowRange(rows), cv::INTER_LINEAR,
            cv::BORDER_REPLICATE);
}

}  // namespace polnav::sim
