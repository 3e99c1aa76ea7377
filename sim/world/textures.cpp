#include "sim/world/textures.h"

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "sim/world/texture_noise.h"

namespace polnav::sim {
namespace {

constexpr int kSide = 1024;

cv::Mat ToGrey(const cv::Mat& reflectance) {
  cv::Mat grey;
  reflectance.convertTo(grey, CV_8UC1);
  return grey;
}

double Between(Sample& random, double low, double high) {
  return low + (high - low) * random.Uniform();
}

cv::Point2d PointIn(Sample& random, double margin, double side) {
  const double x = Between(random, margin, side - margin);
  return {x, Between(random, margin, side - margin)};
}

std::vector<cv::Point> ShiftedBy(std::vector<cv::Point> points, const cv::Point& shift) {
  for (cv::Point& p : points) p += shift;
  return points;
}

// A crack or a bitumen seam wanders; it stays off the tile's edge, where tiles meet.
void DrawCrack(cv::Mat& image, double grey, int thickness_px, Sample& random) {
  cv::Point2d p = PointIn(random, 80.0, kSide);
  double heading = Between(random, 0.0, 6.28);
  const int steps = static_cast<int>(Between(random, 8.0, 40.0));
  for (int i = 0; i < steps; ++i) {
    heading += 0.45 * random.Gaussian();
    const cv::Point2d q = p + 16.0 * cv::Point2d(std::cos(heading), std::sin(heading));
    if (std::min(q.x, q.y) < 20.0 || std::max(q.x, q.y) > kSide - 20.0) return;
    cv::line(image, p, q, cv::Scalar(grey), thickness_px, cv::LINE_AA);
    p = q;
  }
}

// Repaired asphalt: a rectangle of another grey with a dark seam.
void DrawPatch(cv::Mat& image, Sample& random) {
  const cv::Size2f size(static_cast<float>(Between(random, 50.0, 320.0)),
                        static_cast<float>(Between(random, 50.0, 380.0)));
  const cv::RotatedRect patch(PointIn(random, 250.0, kSide), size,
                              static_cast<float>(4.0 * random.Gaussian()));
  cv::Point2f corner[4];
  patch.points(corner);
  const std::vector<cv::Point> outline(corner, corner + 4);
  const cv::Rect around = patch.boundingRect() & cv::Rect(0, 0, kSide, kSide);
  cv::Mat mask = cv::Mat::zeros(around.size(), CV_8UC1);
  cv::fillConvexPoly(mask, ShiftedBy(outline, -around.tl()), cv::Scalar(255));
  cv::Mat inside = image(around);
  cv::add(inside, cv::Scalar(Between(random, -16.0, 18.0)), inside, mask);
  cv::polylines(image, outline, true, cv::Scalar(24), 3, cv::LINE_AA);
}

void DrawStain(cv::Mat& image, double change, Sample& random) {
  const cv::Size axes(static_cast<int>(Between(random, 6.0, 60.0)),
                      static_cast<int>(Between(random, 6.0, 60.0)));
  constexpr int kReach = 72;  // the longest axis and the blur
  const cv::Point center = PointIn(random, kReach + 8.0, kSide);
  const cv::Rect around(center.x - kReach, center.y - kReach, 2 * kReach, 2 * kReach);
  cv::Mat stain = cv::Mat::zeros(around.size(), CV_32FC1);
  cv::ellipse(stain, {kReach, kReach}, axes, Between(random, 0.0, 180.0), 0.0, 360.0,
              cv::Scalar(change), cv::FILLED, cv::LINE_AA);
  cv::blur(stain, stain, {7, 7});
  image(around) += stain;
}

void DrawManhole(cv::Mat& image, Sample& random) {
  const cv::Point2d center = PointIn(random, 150.0, kSide);
  cv::circle(image, center, 46, cv::Scalar(26), 5, cv::LINE_AA);
  cv::circle(image, center, 42, cv::Scalar(52), cv::FILLED, cv::LINE_AA);
  for (int i = -3; i <= 3; ++i) {
    for (int j = -3; j <= 3; ++j) {
      if (i * i + j * j > 10) continue;
      cv::circle(image, center + cv::Point2d(11.0 * i, 11.0 * j), 3, cv::Scalar(24), cv::FILLED,
                 cv::LINE_AA);
    }
  }
}

// Paint wears off where the asphalt is coarse.
void Paint(cv::Mat& image, const cv::Mat& wear, const cv::Rect& stripe) {
  for (int row = stripe.y; row < stripe.br().y; ++row) {
    for (int col = stripe.x; col < stripe.br().x; ++col) {
      const float worn = wear.at<float>(row, col);
      const float cover = std::clamp(0.95F - 0.9F * std::max(0.0F, worn), 0.1F, 0.95F);
      float& grey = image.at<float>(row, col);
      grey += cover * (168.0F - grey);
    }
  }
}

}  // namespace

cv::Mat RoadTexture(const cv::Mat& base, bool with_crossing, Sample& random) {
  cv::Mat image = 56.0 + 40.0 * base;
  for (int i = 0; i < 3; ++i) DrawPatch(image, random);
  for (int i = 0; i < 40; ++i) DrawStain(image, Between(random, -30.0, 26.0), random);
  for (int i = 0; i < 7; ++i)
    DrawCrack(image, 18.0, 2 + static_cast<int>(random.Bits() % 3), random);
  for (int i = 0; i < 140; ++i) {  // chewing gum, leaves, grit
    cv::circle(image, PointIn(random, 8.0, kSide), 1 + static_cast<int>(random.Bits() % 4),
               cv::Scalar(random.Uniform() < 0.6 ? Between(random, 90.0, 150.0) : 20.0), cv::FILLED,
               cv::LINE_AA);
  }
  if (random.Uniform() < 0.7) DrawManhole(image, random);
  Paint(image, base, {28, 0, 18, kSide});  // edge lines run through
  Paint(image, base, {kSide - 46, 0, 18, kSide});
  if (with_crossing) {
    for (int x = 90; x + 60 < kSide - 60; x += 112) Paint(image, base, {x, 260, 58, 480});
  } else {
    Paint(image, base, {kSide / 2 - 9, 120, 18, 330});  // lane divider: dashes
    Paint(image, base, {kSide / 2 - 9, 640, 18, 330});
  }
  return ToGrey(image);
}

cv::Mat PavingTexture(int slabs, double contrast, Sample& random) {
  cv::Mat image = 92.0 + 34.0 * contrast * FractalNoise(kSide, {4, 10, 0.95}, random);
  const int pitch = kSide / slabs;
  for (int row = 0; row < slabs; ++row) {
    for (int col = 0; col < slabs; ++col) {
      const cv::Rect slab(col * pitch, row * pitch, pitch, pitch);
      image(slab) += cv::Scalar(18.0 * contrast * random.Gaussian());
      cv::rectangle(image, slab, cv::Scalar(48), 2);
      if (random.Uniform() < 0.08) {  // broken: a dark wedge
        const cv::Point corner = slab.tl();
        const int bite = pitch / 2;
        cv::fillConvexPoly(image,
                           std::vector<cv::Point>{corner, corner + cv::Point(bite, 0),
                                                  corner + cv::Point(0, bite * 2 / 3)},
                           cv::Scalar(58), cv::LINE_AA);
      }
    }
  }
  for (int i = 0; i < 30; ++i) DrawStain(image, Between(random, -30.0, 14.0), random);
  for (int i = 0; i < 120; ++i) {
    cv::circle(image, PointIn(random, 8.0, kSide), 2 + static_cast<int>(random.Bits() % 4),
               cv::Scalar(Between(random, 30.0, 140.0)), cv::FILLED, cv::LINE_AA);
  }
  return ToGrey(image);
}

cv::Mat GrassTexture(Sample& random) {
  cv::Mat image = 50.0 + 52.0 * FractalNoise(kSide, {3, 10, 0.95}, random);
  for (int i = 0; i < 2600; ++i) {  // blades
    const cv::Point2d p = PointIn(random, 12.0, kSide);
    const double heading = Between(random, 0.0, 3.14);
    cv::line(image, p, p + 11.0 * cv::Point2d(std::cos(heading), std::sin(heading)),
             cv::Scalar(Between(random, 12.0, 110.0)), 1 + static_cast<int>(random.Bits() % 2),
             cv::LINE_AA);
  }
  for (int i = 0; i < 260; ++i) {  // fallen leaves, flowers, bare earth
    cv::ellipse(image, PointIn(random, 20.0, kSide),
                {2 + static_cast<int>(random.Bits() % 14), 2 + static_cast<int>(random.Bits() % 9)},
                Between(random, 0.0, 180.0), 0.0, 360.0, cv::Scalar(Between(random, 15.0, 190.0)),
                cv::FILLED, cv::LINE_AA);
  }
  return ToGrey(image);
}

cv::Mat FoliageTexture(Sample& random) {
  constexpr int kLeafSide = 512;
  cv::Mat image = 34.0 + 24.0 * FractalNoise(kLeafSide, {2, 8, 0.8}, random);
  for (int i = 0; i < 1500; ++i) {
    cv::ellipse(image, PointIn(random, 14.0, kLeafSide),
                {4 + static_cast<int>(random.Bits() % 9), 2 + static_cast<int>(random.Bits() % 4)},
                Between(random, 0.0, 180.0), 0.0, 360.0, cv::Scalar(Between(random, 4.0, 120.0)),
                cv::FILLED, cv::LINE_AA);
  }
  return ToGrey(image);
}

cv::Mat BarkTexture(Sample& random) {
  constexpr int kBarkSide = 256;
  cv::Mat coarse = FractalNoise(kBarkSide, {3, 8, 0.9}, random);
  cv::Mat stretched;  // furrows run up the trunk: repeat a quarter of the rows
  cv::resize(coarse(cv::Rect(0, 0, kBarkSide, kBarkSide / 4)), stretched, coarse.size(), 0, 0,
             cv::INTER_LINEAR);
  return ToGrey(60.0 + 60.0 * stretched);
}

cv::Mat PlainTexture(int side_px, double mean, double contrast, Sample& random) {
  const cv::Mat noise = FractalNoise(side_px, {1, 9, 0.75}, random);
  return ToGrey(mean * (1.0 + contrast * noise));
}

}  // namespace polnav::sim
