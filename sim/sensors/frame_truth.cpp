#include "sim/sensors/frame_truth.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <opencv2/core.hpp>
#include <optional>

#include "sim/sensors/lens.h"
#include "sim/sensors/lens_warp.h"
#include "sim/world/actor.h"

namespace polnav::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr float kNotANumber = std::numeric_limits<float>::quiet_NaN();
// A point is hidden in the next picture when something else is nearer by more than this.
constexpr double kHiddenShare = 0.01;
constexpr double kHidden_m = 0.02;

// What the next picture shows, asked between its pixels.
class Layers {
 public:
  explicit Layers(const TruthLayers& layers) : layers_(layers) {}

  // [1/m]; zero is the sky. On the surface of the nearest pixel, taken as a plane there.
  [[nodiscard]] double InverseDepthAt(const Vector2d& pixel) const {
    const cv::Size size = layers_.depth_m.size();
    const int col = std::clamp(static_cast<int>(std::lround(pixel.x())), 0, size.width - 1);
    const int row = std::clamp(static_cast<int>(std::lround(pixel.y())), 0, size.height - 1);
    return std::max(0.0, Inverse(row, col) + Slope(row, col, 0, 1) * (pixel.x() - col) +
                             Slope(row, col, 1, 0) * (pixel.y() - row));
  }

  // True: it shows this instance within a pixel of there.
  [[nodiscard]] bool Shows(int instance, const Vector2d& pixel) const {
    const int u = static_cast<int>(std::floor(pixel.x()));
    const int v = static_cast<int>(std::floor(pixel.y()));
    for (int row = v; row <= v + 1; ++row) {
      for (int col = u; col <= u + 1; ++col) {
        if (Has(row, col) && Instance(row, col) == instance) return true;
      }
    }
    return false;
  }

 private:
  [[nodiscard]] bool Has(int row, int col) const {
    return row >= 0 && col >= 0 && row < layers_.depth_m.rows && col < layers_.depth_m.cols;
  }
  [[nodiscard]] int Instance(int row, int col) const {
    return layers_.instance.at<std::uint16_t>(row, col);
  }
  [[nodiscard]] double Inverse(int row, int col) const {
    return 1.0 / layers_.depth_m.at<float>(row, col);
  }

  // Of 1/z per pixel along one side. On a plane both neighbours agree; the smaller step is the one
  // that stays on this pixel's surface.
  [[nodiscard]] double Slope(int row, int col, int down, int right) const {
    double slope = 0.0;
    bool found = false;
    for (const int step : {-1, 1}) {
      const int r = row + step * down;
      const int c = col + step * right;
      if (!Has(r, c) || Instance(r, c) != Instance(row, col)) continue;
      const double candidate = step * (Inverse(r, c) - Inverse(row, col));
      if (!found || std::abs(candidate) < std::abs(slope)) slope = candidate;
      found = true;
    }
    return slope;
  }

  const TruthLayers& layers_;
};

// How what belongs to one instance moves from the frame's camera into the next one's.
struct Motion {
  nav::Pose T_NC;  // N: the camera at the next frame
  bool moves = false;
};

class Motions {
 public:
  Motions(const nav::Pose& T_BC, const FrameTruthRequest& request, const std::vector<Actor>& actors)
      : T_WC_(request.frame.T_WB * T_BC),
        T_NW_((request.next_T_WB * T_BC).Inverse()),
        request_(request),
        actors_(actors) {}

  // Nothing: it is not there at the next frame.
  [[nodiscard]] const std::optional<Motion>& Of(int instance) {
    const auto known = known_.find(instance);
    if (known != known_.end()) return known->second;
    return known_.emplace(instance, Find(instance)).first->second;
  }

 private:
  [[nodiscard]] std::optional<Motion> Find(int instance) const {
    if (instance < kFirstActor) return Motion{T_NW_ * T_WC_};
    const auto& path = actors_.at(static_cast<std::size_t>(instance - kFirstActor)).path;
    const auto T_WA = PoseOf(path, request_.frame.stamp);
    const auto next_T_WA = PoseOf(path, request_.next_stamp);
    if (!T_WA || !next_T_WA) return std::nullopt;
    const bool moves =
        (next_T_WA->p - T_WA->p).norm() > 1e-6 || next_T_WA->q.angularDistance(T_WA->q) > 1e-6;
    return Motion{T_NW_ * *next_T_WA * T_WA->Inverse() * T_WC_, moves};
  }

  nav::Pose T_WC_;
  nav::Pose T_NW_;
  const FrameTruthRequest& request_;
  const std::vector<Actor>& actors_;
  std::map<int, std::optional<Motion>> known_;
};

bool IsInside(const nav::CameraCalibration& camera, const Vector2d& pixel) {
  return pixel.x() >= -0.5 && pixel.y() >= -0.5 && pixel.x() <= camera.width_px - 0.5 &&
         pixel.y() <= camera.height_px - 0.5;
}

// Where the point on this ray is in the next picture.
std::optional<Vector2d> NextPixel(const nav::CameraCalibration& camera, double widest_tangent,
                                  const Layers& next, const Vector2d& ray, double depth_m,
                                  int instance, const nav::Pose& T_NC) {
  const bool sky = std::isinf(depth_m);
  const Vector3d p_N =
      sky ? Vector3d(T_NC.q * ray.homogeneous()) : Vector3d(T_NC * (depth_m * ray.homogeneous()));
  if (!(p_N.z() > 0.0)) return std::nullopt;
  const Vector2d xy = p_N.head<2>() / p_N.z();
  // Beyond its field a distortion may fold back.
  if (xy.norm() > widest_tangent) return std::nullopt;
  const Vector2d pixel = ProjectToPixel(camera, p_N);
  if (!IsInside(camera, pixel) || !next.Shows(instance, pixel)) return std::nullopt;
  if (sky) return pixel;
  const double nearest = 1.0 / std::max(next.InverseDepthAt(pixel), 1e-9);
  if (p_N.z() > (1.0 + kHiddenShare) * nearest + kHidden_m) return std::nullopt;
  return pixel;
}

}  // namespace

FrameTruth MakeFrameTruth(const nav::CameraCalibration& camera, const TruthLayers& now,
                          const TruthLayers& next, const FrameTruthRequest& request,
                          const std::vector<Actor>& actors) {
  const Layers there(next);
  Motions motions(camera.T_BC, request, actors);
  const double widest_tangent = 1.05 * std::tan(AngleOfField(camera));
  const cv::Size size(camera.width_px, camera.height_px);
  FrameTruth truth{.stamp = request.frame.stamp,
                   .index = request.frame.index,
                   .depth_m = now.depth_m,
                   .instance = now.instance,
                   .flow_px = cv::Mat(size, CV_32FC2),
                   .moving = cv::Mat(size, CV_8UC1)};
  for (int row = 0; row < size.height; ++row) {
    for (int col = 0; col < size.width; ++col) {
      const int instance = now.instance.at<std::uint16_t>(row, col);
      const std::optional<Motion>& motion = motions.Of(instance);
      std::optional<Vector2d> to;
      if (motion) {
        to = NextPixel(camera, widest_tangent, there, RayOfPixel(camera, col, row),
                       now.depth_m.at<float>(row, col), instance, motion->T_NC);
      }
      truth.flow_px.at<cv::Vec2f>(row, col) =
          to ? cv::Vec2f(static_cast<float>(to->x() - col), static_cast<float>(to->y() - row))
             : cv::Vec2f(kNotANumber, kNotANumber);
      // Who leaves the scene moves, too.
      truth.moving.at<std::uint8_t>(row, col) = !motion || motion->moves ? 255 : 0;
    }
  }
  return truth;
}

}  // namespace polnav::sim
