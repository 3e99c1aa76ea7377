// What does an ideal pinhole camera see?
//
// Off-screen OpenGL 3.3 core through OSMesa (llvmpipe): grey, linear light. One renderer is one
// context: create it and use it in one thread only. The same call gives the same bytes in any
// thread and any process of one machine, whatever was drawn before; another processor may round
// shades differently. Points between 0.2 m and 600 m before the camera are drawn; no motion blur.
// The sun stands where it stood at the scenario's start; clouds move, once a second.
#pragma once

#include <Eigen/Core>
#include <limits>
#include <memory>
#include <opencv2/core/mat.hpp>
#include <vector>

#include "nav/api/geometry.h"
#include "nav/api/time.h"
#include "sim/render/grain.h"
#include "sim/render/pinhole_view.h"
#include "sim/world/scene.h"
#include "sky/skylight.h"

namespace polnav::sim {

struct RenderRequest {
  nav::Pose T_WC;
  nav::TimeNs stamp = 0;  // where actors and clouds are
  double exposure = 0.1;  // 255 is radiance 1 / exposure; the clear zenith has 1
  // Of fog; see sim/world/fog.h.
  double visibility_m = std::numeric_limits<double>::infinity();
};

class Renderer {
 public:
  // Scene and sky are copied: they need not outlive the constructor.
  // unneeded_px: corners of triangles whose pixels nobody will look at, left black and not paid
  // for.
  Renderer(const Scene& scene, const sky::WorldSky& sky, const PinholeView& view,
           const std::vector<Eigen::Vector2d>& unneeded_px = {});
  // Of what is less than some metres away: with the ground's grain, for RenderRadiance alone.
  Renderer(const Scene& scene, const sky::WorldSky& sky, const PinholeView& view,
           const CloseUp& close_up);
  ~Renderer();
  Renderer(const Renderer&) = delete;
  Renderer& operator=(const Renderer&) = delete;

  // Grey image CV_8UC1 of height x width.
  void Render(const RenderRequest& request, cv::Mat& image);
  // Of a close-up: radiance times request.exposure, CV_32FC1.
  void RenderRadiance(const RenderRequest& request, cv::Mat& image);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace polnav::sim
