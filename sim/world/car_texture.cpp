#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "sim/world/actor_textures.h"
#include "sim/world/atlas_canvas.h"
#include "sim/world/texture_noise.h"

namespace polnav::sim {
namespace {

using Sample = RandomStream::Sample;

void DrawCarSide(const CarShape& shape, double paint, cv::Mat& atlas, const AtlasView& view,
                 Sample& random) {
  AtlasCanvas canvas(atlas, view, shape.length_m, shape.height_m);
  const auto& top = shape.top;
  const double belt = top[2].z_m - 0.04;
  const double roof = top[4].z_m - 0.09;
  const double rear = top[2].x_m + 0.12;
  const double front = top[5].x_m - 0.10;
  canvas.ShadeDown(1.12, 0.80);
  DrawGlass(canvas, rear, belt, front, roof + 0.05, random);
  // Paint over what is beyond the windows: the pillars along the slanting glass, and the roof.
  canvas.Fill({{0.0, belt}, {rear, belt}, {top[3].x_m + 0.12, roof}, {0.0, roof}}, paint);
  canvas.Fill(
      {{shape.length_m, belt}, {front, belt}, {top[4].x_m - 0.02, roof}, {shape.length_m, roof}},
      paint);
  canvas.Box(0.0, roof, shape.length_m, shape.height_m, 1.05 * paint);
  const double pillar = 0.5 * (shape.rear_wheel_m + shape.front_wheel_m) - 0.1;
  canvas.Line({pillar, belt}, {pillar - 0.05, roof}, 0.5 * paint, 7);
  for (const double x : {rear + 0.35, pillar, front - 0.08}) {  // seams of the doors
    canvas.Line({x, 0.32}, {x, belt}, 0.35 * paint, 2);
  }
  for (const double x : {pillar - 0.22, front - 0.95}) {  // handles
    canvas.Box(x, belt - 0.14, x + 0.18, belt - 0.10, std::min(255.0, 60.0 + 1.2 * paint));
  }
  canvas.Line({0.2, belt - 0.22}, {shape.length_m - 0.3, belt - 0.25}, 0.75 * paint, 3);
  canvas.Box(0.0, 0.0, shape.length_m, 0.30, 26.0);
  for (const double x : {shape.rear_wheel_m, shape.front_wheel_m}) {
    canvas.Disc({x, shape.wheel_radius_m}, shape.wheel_radius_m + 0.06, 10.0);
  }
  canvas.Box(0.0, belt - 0.25, 0.22, belt - 0.05, 48.0);
  canvas.Fill({{shape.length_m - 0.42, top[6].z_m - 0.05},
               {shape.length_m, top[6].z_m - 0.14},
               {shape.length_m, top[6].z_m - 0.26},
               {shape.length_m - 0.25, top[6].z_m - 0.22}},
              225.0);
}

void DrawCarTop(const CarShape& shape, cv::Mat& atlas, Sample& random) {
  AtlasCanvas canvas(atlas, kTopView, shape.length_m, shape.width_m);
  const auto& top = shape.top;
  const double in = 0.17;
  DrawGlass(canvas, top[2].x_m + 0.05, in, top[3].x_m - 0.03, shape.width_m - in, random);
  DrawGlass(canvas, top[4].x_m + 0.03, in, top[5].x_m - 0.03, shape.width_m - in, random);
  canvas.Line({top[5].x_m + 0.1, 0.25}, {shape.length_m - 0.1, 0.35}, 40.0, 2);
  canvas.Line({top[5].x_m + 0.1, shape.width_m - 0.25},
              {shape.length_m - 0.1, shape.width_m - 0.35}, 40.0, 2);
}

void DrawCarEnds(const CarShape& shape, double paint, cv::Mat& atlas) {
  const double w = shape.width_m;
  const double nose = shape.top[6].z_m;
  AtlasCanvas front(atlas, kFrontView, w, shape.height_m);
  front.Box(0.45, nose - 0.30, w - 0.45, nose - 0.12, 18.0);  // grille
  for (int i = 1; i < 4; ++i) {
    front.Line({0.45, nose - 0.12 - 0.045 * i}, {w - 0.45, nose - 0.12 - 0.045 * i}, 90.0, 2);
  }
  front.Box(0.08, nose - 0.26, 0.42, nose - 0.12, 235.0);
  front.Box(w - 0.42, nose - 0.26, w - 0.08, nose - 0.12, 235.0);
  front.Box(0.1, 0.2, w - 0.1, 0.30, 22.0);
  front.Box(0.5 * w - 0.24, 0.36, 0.5 * w + 0.24, 0.47, 190.0);
  AtlasCanvas back(atlas, kBackView, w, shape.height_m);
  const double boot = shape.top[1].z_m;
  back.Box(0.05, boot - 0.30, 0.38, boot - 0.10, 46.0);
  back.Box(w - 0.38, boot - 0.30, w - 0.05, boot - 0.10, 46.0);
  back.Box(0.5 * w - 0.26, boot - 0.30, 0.5 * w + 0.26, boot - 0.18, 205.0);
  back.Line({0.05, 0.52}, {w - 0.05, 0.52}, 0.55 * paint, 3);
  back.Box(0.0, 0.0, w, 0.32, 26.0);
}

}  // namespace

CarShape Saloon() {
  return {.top = {{{0.0, 0.62},
                   {0.06, 0.97},
                   {0.72, 1.02},
                   {1.42, 1.41},
                   {2.55, 1.46},
                   {3.30, 1.00},
                   {4.40, 0.80},
                   {4.5, 0.60}}}};
}

CarShape Hatchback() {
  return {.length_m = 4.0,
          .width_m = 1.72,
          .height_m = 1.52,
          .top = {{{0.0, 0.60},
                   {0.04, 0.95},
                   {0.10, 1.00},
                   {0.62, 1.46},
                   {2.15, 1.52},
                   {3.00, 1.05},
                   {3.88, 0.84},
                   {4.0, 0.60}}},
          .rear_wheel_m = 0.68,
          .front_wheel_m = 3.20,
          .wheel_radius_m = 0.31};
}

CarShape OffRoader() {
  return {.length_m = 4.6,
          .width_m = 1.86,
          .height_m = 1.72,
          .top = {{{0.0, 0.70},
                   {0.04, 1.08},
                   {0.10, 1.14},
                   {0.42, 1.66},
                   {2.55, 1.72},
                   {3.30, 1.18},
                   {4.45, 1.00},
                   {4.6, 0.72}}},
          .rear_wheel_m = 0.85,
          .front_wheel_m = 3.62,
          .wheel_radius_m = 0.36};
}

cv::Mat CarTexture(const CarShape& shape, double paint, Sample& random) {
  cv::Mat atlas = paint * (1.0 + 0.05 * FractalNoise(1024, {2, 8, 0.8}, random));
  atlas = atlas.rowRange(0, 512).clone();
  DrawCarSide(shape, paint, atlas, kLeftView, random);
  DrawCarSide(shape, paint, atlas, kRightView, random);
  DrawCarTop(shape, atlas, random);
  DrawCarEnds(shape, paint, atlas);
  cv::Mat grey;
  atlas.convertTo(grey, CV_8UC1);
  return grey;
}

}  // namespace polnav::sim
