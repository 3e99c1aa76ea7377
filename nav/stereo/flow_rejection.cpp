#include "nav/stereo/flow_rejection.h"

#include <Eigen/LU>

namespace polnav::nav {

std::vector<bool> MovesWithScene(const RectifiedCamera& camera,
                                 const std::vector<LandmarkView>& views, const PosePrior& expected,
                                 const PixelSigmas& pixels, double gate_sigmas) {
  std::vector<bool> moves_with_scene;
  const Viewpoint target = ViewpointOf(camera, expected.T_WB);
  for (const LandmarkView& view : views) {
    const auto e = Reproject(camera, view.host, target, view.landmark, view.pixel, pixels);
    if (!e) {  // behind the camera
      moves_with_scene.push_back(false);
      continue;
    }
    const Eigen::Matrix3d covariance =
        Eigen::Matrix3d::Identity() + e->by_target * expected.covariance * e->by_target.transpose();
    const double distance2 = e->residual.dot(covariance.inverse() * e->residual);
    moves_with_scene.push_back(distance2 <= gate_sigmas * gate_sigmas);
  }
  return moves_with_scene;
}

}  // namespace polnav::nav
