#include "nav/stereo/patch_align.h"

#include <cmath>

namespace polnav::nav {
namespace {

using Vector8f = Eigen::Matrix<float, 8, 1>;
using Matrix8f = Eigen::Matrix<float, 8, 8>;

constexpr int kMaxIterations = 15;
constexpr float kEnough_px = 0.003F;
// What a stretch may differ by from the guess, one sigma, against the noise of grey values: from
// one picture to the next the ground before a car is stretched by up to a third.
constexpr float kStretchSigma = 0.2F;
constexpr float kGreySigma = 3.0F;
constexpr float kRidge = kGreySigma * kGreySigma / (kStretchSigma * kStretchSigma);
// Beyond, from the guess, it has locked onto something else.
constexpr float kFarthest_px = 4.0F;
constexpr float kMostStretch = 1.0F;

// The smaller eigenvalue of the slopes' products.
float Contrast(const Matrix8f& products) {
  const float half_sum = 0.5F * (products(0, 0) + products(1, 1));
  const float half_difference = 0.5F * (products(0, 0) - products(1, 1));
  return half_sum - std::hypot(half_difference, products(0, 1));
}

}  // namespace

std::optional<PatchTemplate> CutTemplate(const cv::Mat& image, const cv::Point2f& middle,
                                         int half) {
  Patch wide;
  if (!ReadPatch(image, middle, half + 1, wide)) return std::nullopt;
  const int side = 2 * half + 1;
  PatchTemplate patch{.half = half};
  patch.rows.resize(8, side * side);
  ForEachSlope(wide, half, [&](int k, float i, float j, float grey, float x, float y) {
    patch.rows.col(k) << x, y, x * i, x * j, y * i, y * j, grey, 1.0F;
  });
  patch.rows.row(6).array() -= patch.rows.row(6).mean();
  Matrix8f products = patch.rows * patch.rows.transpose();
  // Less than a grey value a pixel is noise.
  if (Contrast(products) < static_cast<float>(patch.rows.cols())) return std::nullopt;
  patch.by_gain = products.col(6);
  patch.by_offset = products.col(7);
  products.diagonal().segment<4>(2).array() += kRidge;
  patch.information.compute(products);
  return patch;
}

std::optional<PatchPlace> AlignTemplate(const PatchTemplate& patch, const cv::Mat& image,
                                        const PatchPlace& guess, float least_correlation) {
  PatchPlace place = guess;
  float gain = 1.0F;
  float offset = 0.0F;
  Patch seen_patch;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    if (!ReadWarped(image, place.at, place.stretch, patch.half, seen_patch)) return std::nullopt;
    const Eigen::Map<const Eigen::VectorXf> seen(seen_patch.data(), std::ssize(seen_patch));
    if (iteration == 0) offset = seen.mean();
    Vector8f g = patch.rows * seen - gain * patch.by_gain - offset * patch.by_offset;
    for (int i = 0; i < 4; ++i) g(2 + i) += kRidge * (place.stretch.val[i] - guess.stretch.val[i]);
    const Vector8f step = patch.information.solve(g);
    // What moves the template one way moves the place the other.
    const cv::Matx22f back = cv::Matx22f(1.0F + step(2), step(3), step(4), 1.0F + step(5)).inv();
    place.stretch = place.stretch * back;
    const cv::Vec2f shift = place.stretch * cv::Vec2f(step(0), step(1));
    place.at -= cv::Point2f(shift[0], shift[1]);
    gain += step(6);
    offset += step(7);
    const cv::Point2f away = place.at - guess.at;
    const bool lost = !(away.dot(away) < kFarthest_px * kFarthest_px) ||
                      !(cv::norm(place.stretch - guess.stretch) < kMostStretch);
    if (lost) return std::nullopt;
    if (std::hypot(step(0), step(1)) < kEnough_px) break;
  }
  const Eigen::Map<const Eigen::VectorXf> seen(seen_patch.data(), std::ssize(seen_patch));
  const float contrast = (seen.array() - seen.mean()).matrix().norm() * std::sqrt(patch.by_gain(6));
  const float alike = patch.rows.row(6).dot(seen);
  return alike > least_correlation * contrast ? std::optional(place) : std::nullopt;
}

}  // namespace polnav::nav
