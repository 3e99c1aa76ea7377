#include "sim/world/atlas_canvas.h"
#include "sim/world/texture_noise.h"

namespace polnav::sim {
namespace {

using Sample = RandomStream::Sample;

void DrawBusSide(cv::Mat& atlas, const AtlasView& view, bool has_doors, Sample& random) {
  AtlasCanvas canvas(atlas, view, kBusLength_m, kBusHeight_m);
  canvas.Box(0.0, 0.55, kBusLength_m, 1.15, 78.0);  // the livery's band
  canvas.Fill({{0.0, 0.55}, {3.4, 0.55}, {5.0, 1.15}, {0.0, 1.15}}, 128.0);
  DrawGlass(canvas, 0.35, 1.32, kBusLength_m - 0.15, 2.62, random);
  for (int i = 0; i < 9; ++i) {  // passengers and seats
    const double x = 0.7 + 1.2 * i + Between(random, 0.0, 0.5);
    canvas.Disc({x, 1.66}, 0.13, Between(random, 50.0, 110.0));
    canvas.Box(x - 0.22, 1.32, x + 0.22, 1.54, Between(random, 40.0, 120.0));
  }
  for (int i = 0; i <= 8; ++i) {
    const double x = 0.35 + 1.425 * i;
    canvas.Box(x - 0.05, 1.32, x + 0.05, 2.62, 12.0);
  }
  canvas.Box(0.0, 2.62, kBusLength_m, 2.70, 60.0);
  canvas.Box(7.9, 2.72, 10.3, 2.98, 14.0);  // where it goes
  for (int i = 0; i < 9; ++i) {
    const double x = 8.05 + 0.24 * i;
    canvas.Box(x, 2.78, x + Between(random, 0.05, 0.17), 2.92, 215.0);
  }
  for (int i = 1; i < 12; ++i) canvas.Line({1.0 * i, 0.33}, {1.0 * i, 0.55}, 95.0, 1);
  canvas.Box(0.0, 0.0, kBusLength_m, 0.34, 34.0);
  if (has_doors) {
    for (const double x : {5.2, 10.35}) {
      canvas.Box(x, 0.30, x + 1.3, 2.62, 40.0);
      canvas.Box(x + 0.07, 0.45, x + 0.61, 2.52, kGlass);
      canvas.Box(x + 0.69, 0.45, x + 1.23, 2.52, kGlass + 8.0);
    }
  }
  for (const double x : {2.9, 9.2}) canvas.Disc({x, 0.5}, 0.60, 9.0);
}

void DrawBusEnds(cv::Mat& atlas, Sample& random) {
  AtlasCanvas front(atlas, kFrontView, kBusWidth_m, kBusHeight_m);
  DrawGlass(front, 0.12, 1.05, kBusWidth_m - 0.12, 2.58, random);
  front.Line({0.5 * kBusWidth_m, 1.05}, {0.5 * kBusWidth_m, 2.58}, 16.0, 4);
  front.Box(0.35, 2.66, kBusWidth_m - 0.35, 3.02, 12.0);
  for (int i = 0; i < 8; ++i) {
    const double x = 0.45 + 0.2 * i;
    front.Box(x, 2.72, x + Between(random, 0.05, 0.16), 2.95, 225.0);
  }
  front.Box(0.12, 0.62, 0.55, 0.86, 235.0);
  front.Box(kBusWidth_m - 0.55, 0.62, kBusWidth_m - 0.12, 0.86, 235.0);
  front.Box(0.0, 0.2, kBusWidth_m, 0.45, 60.0);
  front.Box(0.5 * kBusWidth_m - 0.26, 0.48, 0.5 * kBusWidth_m + 0.26, 0.60, 205.0);
  AtlasCanvas back(atlas, kBackView, kBusWidth_m, kBusHeight_m);
  DrawGlass(back, 0.35, 1.75, kBusWidth_m - 0.35, 2.55, random);
  for (int i = 0; i < 6; ++i) {
    back.Line({0.4, 0.75 + 0.12 * i}, {kBusWidth_m - 0.4, 0.75 + 0.12 * i}, 40.0, 3);
  }
  back.Box(0.06, 0.70, 0.28, 1.60, 50.0);
  back.Box(kBusWidth_m - 0.28, 0.70, kBusWidth_m - 0.06, 1.60, 50.0);
  back.Box(0.5 * kBusWidth_m - 0.26, 0.50, 0.5 * kBusWidth_m + 0.26, 0.62, 205.0);
}

}  // namespace

cv::Mat BusTexture(Sample& random) {
  cv::Mat atlas = 168.0 * (1.0 + 0.06 * FractalNoise(1024, {2, 8, 0.8}, random));
  DrawBusSide(atlas, kLeftView, false, random);
  DrawBusSide(atlas, kRightView, true, random);
  DrawBusEnds(atlas, random);
  AtlasCanvas roof(atlas, kTopView, kBusLength_m, kBusWidth_m);
  roof.Box(3.5, 0.6, 6.2, kBusWidth_m - 0.6, 120.0);
  roof.Box(8.4, 0.8, 9.2, kBusWidth_m - 0.8, 60.0);
  cv::Mat grey;
  atlas.convertTo(grey, CV_8UC1);
  return grey;
}

cv::Mat ClothTexture(int style, Sample& random) {
  constexpr int kSide = 256;
  cv::Mat cloth = 150.0 * (1.0 + 0.22 * FractalNoise(kSide, {2, 8, 0.9}, random));
  const int pitch = 32;
  for (int at = 0; at < kSide; at += pitch) {
    if (style % 3 == 1) cloth.rowRange(at, at + pitch / 2) *= 0.45;
    if (style % 3 == 2) {
      cloth.rowRange(at, at + pitch / 3) *= 0.7;
      cloth.colRange(at, at + pitch / 3) *= 0.7;
    }
  }
  cv::Mat grey;
  cloth.convertTo(grey, CV_8UC1);
  return grey;
}

}  // namespace polnav::sim
