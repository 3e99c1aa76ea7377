#include "nav/stereo/flow_rejection.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>

namespace polnav::nav {
namespace {

// Share of the predicted displacement by which a change of speed within one frame can miss it.
constexpr double kSpeedShare = 0.25;

// Chi-square with three degrees of freedom: 0.1 % of a static scene's features are beyond.
constexpr double kGate2 = 16.3;

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

struct Departure {
  Eigen::Vector2d px;   // seen minus predicted
  double predicted_px;  // length of the predicted displacement
};

}  // namespace

std::vector<bool> MovesAsPredicted(const RectifiedCamera& camera,
                                   const std::vector<LandmarkView>& views,
                                   const PosePrior& expected, const PixelSigmas& sigmas) {
  std::vector<bool> moves_with_scene;
  for (const LandmarkView& view : views) {
    const auto e = Reproject(camera, *view.T_WBh, expected.T_WB, view.landmark, view.pixel, sigmas);
    if (!e) {
      moves_with_scene.push_back(false);
      continue;
    }
    const Eigen::Matrix3d covariance =
        Eigen::Matrix3d::Identity() + e->by_target * expected.covariance * e->by_target.transpose();
    const double distance2 = e->residual.dot(covariance.inverse() * e->residual);
    moves_with_scene.push_back(distance2 <= kGate2);
  }
  return moves_with_scene;
}

std::vector<bool> MovesWithScene(const RectifiedCamera& camera,
                                 const std::vector<LandmarkView>& views, const Pose& T_WB_before,
                                 const Pose& T_WB_expected, double threshold_px) {
  const PixelSigmas in_px{.position_px = 1.0, .disparity_px = 1.0};
  std::vector<std::optional<Departure>> departures;
  std::vector<double> u;
  std::vector<double> v;
  for (const LandmarkView& view : views) {
    const auto now =
        Reproject(camera, *view.T_WBh, T_WB_expected, view.landmark, view.pixel, in_px);
    const auto then = Reproject(camera, *view.T_WBh, T_WB_before, view.landmark, view.pixel, in_px);
    departures.emplace_back();
    if (!now || !then) continue;
    const Eigen::Vector2d px = now->residual.head<2>();
    departures.back() = {px, (then->residual.head<2>() - px).norm()};
    u.push_back(px.x());
    v.push_back(px.y());
  }
  std::vector<bool> moves_with_scene(views.size(), false);
  if (u.empty()) return moves_with_scene;
  const Eigen::Vector2d common(Median(u), Median(v));
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (!departures[i]) continue;
    const double limit = threshold_px + kSpeedShare * departures[i]->predicted_px;
    moves_with_scene[i] = (departures[i]->px - common).norm() <= limit;
  }
  return moves_with_scene;
}

}  // namespace polnav::nav
