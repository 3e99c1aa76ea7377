#include "sim/world/facade_textures.h"

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "sim/world/texture_noise.h"

namespace polnav::sim {
namespace {

using Sample = RandomStream::Sample;

constexpr int kSide = 1024;
constexpr int kCell = kSide / kBaysPerTexture;  // 1.25 cm a pixel

double Between(Sample& random, double low, double high) {
  return low + (high - low) * random.Uniform();
}

int IntBetween(Sample& random, int low, int high) {
  return low + static_cast<int>(random.Bits() % static_cast<std::uint32_t>(high - low + 1));
}

void LayBricks(cv::Mat& wall, int width_px, int height_px, double spread, Sample& random) {
  for (int row = 0; row * height_px < wall.rows; ++row) {
    const int shift = row % 2 == 0 ? 0 : -width_px / 2;
    for (int x = shift; x < wall.cols; x += width_px) {
      const cv::Rect brick = cv::Rect(x, row * height_px, width_px - 2, height_px - 2) &
                             cv::Rect(0, 0, wall.cols, wall.rows);
      if (brick.area() > 0) wall(brick) += cv::Scalar(spread * random.Gaussian() + 10.0);
    }
  }
}

cv::Mat Wall(int style, Sample& random) {
  const double grey = Between(random, 70.0, 150.0);
  cv::Mat wall = grey + 0.30 * grey * FractalNoise(kSide, {1, 9, 0.8}, random);
  switch (style % 4) {
    case 1:
      LayBricks(wall, 32, 16, 11.0, random);
      break;
    case 2:
      LayBricks(wall, 128, 64, 13.0, random);
      break;
    case 3:
      for (int y = 0; y < kSide; y += kCell) wall.rowRange(y, y + 46) += cv::Scalar(38.0);
      break;
    default:
      break;
  }
  return wall;
}

// Behind the glass: curtains, blinds, a lamp, or the reflection of the street.
void FillGlass(cv::Mat& image, const cv::Rect& glass, Sample& random) {
  const double dark = Between(random, 12.0, 40.0);
  cv::rectangle(image, glass, cv::Scalar(dark), cv::FILLED);
  const double kind = random.Uniform();
  if (kind < 0.35) {  // curtains to both sides
    const int width = IntBetween(random, glass.width / 8, glass.width * 2 / 5);
    const cv::Scalar cloth(Between(random, 70.0, 180.0));
    cv::rectangle(image, {glass.x, glass.y, width, glass.height}, cloth, cv::FILLED);
    cv::rectangle(image, {glass.br().x - width, glass.y, width, glass.height}, cloth, cv::FILLED);
  } else if (kind < 0.6) {  // a blind, part way down
    const int drop = IntBetween(random, glass.height / 5, glass.height);
    for (int y = 0; y < drop; y += 8) {
      cv::rectangle(image, {glass.x, glass.y + y, glass.width, 5},
                    cv::Scalar(Between(random, 110.0, 150.0)), cv::FILLED);
    }
  } else {  // the street's reflection: a few slabs of grey
    for (int i = 0; i < 4; ++i) {
      const int w = IntBetween(random, 6, glass.width / 2);
      const int h = IntBetween(random, 10, glass.height / 2);
      const cv::Rect slab(glass.x + IntBetween(random, 0, glass.width - w),
                          glass.y + IntBetween(random, 0, glass.height - h), w, h);
      cv::rectangle(image, slab, cv::Scalar(Between(random, 20.0, 95.0)), cv::FILLED);
    }
  }
}

struct WindowShape {
  int width, height, panes;
  double frame;
};

void DrawWindow(cv::Mat& image, const cv::Point& cell, const WindowShape& shape, Sample& random) {
  const cv::Rect hole(cell.x + (kCell - shape.width) / 2, cell.y + 48, shape.width, shape.height);
  cv::rectangle(image, hole + cv::Size(14, 14) - cv::Point(7, 7), cv::Scalar(shape.frame),
                cv::FILLED);
  FillGlass(image, hole, random);
  for (int i = 1; i < shape.panes; ++i) {
    const int x = hole.x + hole.width * i / shape.panes;
    cv::line(image, {x, hole.y}, {x, hole.br().y}, cv::Scalar(shape.frame), 6);
  }
  const int bar = hole.y + hole.height * 3 / 10;
  cv::line(image, {hole.x, bar}, {hole.br().x, bar}, cv::Scalar(shape.frame), 5);
  // The sill and its shade, and what the rain washed off it.
  cv::rectangle(image, {hole.x - 14, hole.br().y + 7, hole.width + 28, 9}, cv::Scalar(175),
                cv::FILLED);
  cv::rectangle(image, {hole.x - 14, hole.br().y + 16, hole.width + 28, 5}, cv::Scalar(38),
                cv::FILLED);
  const int streak = hole.x + IntBetween(random, 0, hole.width - 14);
  const cv::Rect wet(streak, hole.br().y + 21, 12, cell.y + kCell - hole.br().y - 22);
  image(wet) -= cv::Scalar(Between(random, 4.0, 26.0));
}

void DrawAirConditioner(cv::Mat& image, const cv::Point& cell, Sample& random) {
  const cv::Rect box(cell.x + IntBetween(random, 6, 150), cell.y + 196, 64, 46);
  cv::rectangle(image, box, cv::Scalar(185), cv::FILLED);
  cv::rectangle(image, box, cv::Scalar(50), 3);
  cv::circle(image, box.tl() + cv::Point(24, 23), 16, cv::Scalar(60), 4, cv::LINE_AA);
}

}  // namespace

cv::Mat FacadeTexture(int style, Sample& random) {
  cv::Mat image = Wall(style, random);
  const WindowShape shape{IntBetween(random, 96, 176), IntBetween(random, 100, 146),
                          IntBetween(random, 1, 3), random.Uniform() < 0.6 ? 190.0 : 45.0};
  for (int row = 0; row < kBaysPerTexture; ++row) {
    for (int col = 0; col < kBaysPerTexture; ++col) {
      const cv::Point cell(col * kCell, row * kCell);
      DrawWindow(image, cell, shape, random);
      if (random.Uniform() < 0.35) DrawAirConditioner(image, cell, random);
    }
  }
  const int pipe = kCell * IntBetween(random, 0, kBaysPerTexture - 1) + IntBetween(random, 4, 12);
  cv::rectangle(image, {pipe, 0, 9, kSide}, cv::Scalar(70), cv::FILLED);
  cv::Mat grey;
  image.convertTo(grey, CV_8UC1);
  return grey;
}

cv::Mat ShopTexture(Sample& random) {
  cv::Mat image = cv::Mat(Wall(0, random).rowRange(0, kCell)).clone();
  for (int shop = 0; shop < kBaysPerTexture; ++shop) {
    const int x = shop * kCell;
    const cv::Scalar board(Between(random, 20.0, 190.0));
    cv::rectangle(image, {x + 8, 8, kCell - 16, 50}, board, cv::FILLED);
    for (int i = 0; i < 7; ++i) {  // lettering
      const double ink = board[0] > 100.0 ? 25.0 : 200.0;
      const cv::Rect stroke(x + 24 + 30 * i + IntBetween(random, 0, 8),
                            16 + IntBetween(random, 0, 8), IntBetween(random, 5, 20),
                            IntBetween(random, 12, 26));
      cv::rectangle(image, stroke, cv::Scalar(ink), random.Uniform() < 0.5 ? cv::FILLED : 4);
    }
    const int door = IntBetween(random, 0, 1) == 0 ? x + 14 : x + kCell - 94;
    const int window = door == x + 14 ? x + 106 : x + 14;
    cv::rectangle(image, {door - 5, 66, 90, kCell - 66}, cv::Scalar(150), cv::FILLED);
    FillGlass(image, {door, 72, 80, kCell - 84}, random);
    cv::rectangle(image, {window - 5, 66, 146, 150}, cv::Scalar(150), cv::FILLED);
    FillGlass(image, {window, 72, 136, 138}, random);
    FillGlass(image, {window + 20, 120, 80, 80}, random);
  }
  cv::Mat grey;
  image.convertTo(grey, CV_8UC1);
  return grey;
}

}  // namespace polnav::sim
