#include "nav/stereo/patch_align.h"

#include <Eigen/Cholesky>
#include <cmath>

namespace polnav::nav {
namespace {

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

}  // namespace

// Unknowns: place (2), stretch row by row (4), gain, offset.
bool PatchAligner::Prepare(const cv::Mat& from, const cv::Point2f& middle) {
  if (!ReadPatch(from, middle, half_ + 1, wide_)) return false;
  const int side = 2 * half_ + 1;
  const int wide = side + 2;
  template_.resize(static_cast<std::size_t>(side * side));
  rows_.resize(8, side * side);
  float mean = 0.0F;
  int k = 0;
  for (int j = -half_; j <= half_; ++j) {
    const float* here = wide_.data() + (j + half_ + 1) * wide + 1;
    for (int i = -half_; i <= half_; ++i, ++k, ++here) {
      const float x = 0.5F * (here[1] - here[-1]);
      const float y = 0.5F * (here[wide] - here[-wide]);
      const auto fi = static_cast<float>(i);
      const auto fj = static_cast<float>(j);
      rows_.col(k) << x, y, x * fi, x * fj, y * fi, y * fj, here[0], 1.0F;
      template_[static_cast<std::size_t>(k)] = here[0];
      mean += here[0];
    }
  }
  rows_.row(6).array() -= mean / static_cast<float>(k);
  information_.noalias() = rows_ * rows_.transpose();
  // Less than a grey value a pixel, whichever way it is looked at: noise.
  const float half_sum = 0.5F * (information_(0, 0) + information_(1, 1));
  const float half_difference = 0.5F * (information_(0, 0) - information_(1, 1));
  if (half_sum - std::hypot(half_difference, information_(0, 1)) < static_cast<float>(k)) {
    return false;
  }
  information_.diagonal().segment<4>(2).array() += kRidge;
  return true;
}

std::optional<PatchPlace> PatchAligner::Align(const cv::Mat& from, const cv::Point2f& middle,
                                              const cv::Mat& to, const PatchPlace& guess) {
  if (!Prepare(from, middle)) return std::nullopt;
  const Eigen::LDLT<Matrix8f> solver(information_);
  PatchPlace place = guess;
  float gain = 1.0F;
  float offset = 0.0F;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    if (!ReadWarped(to, place.at, place.stretch, half_, seen_)) return std::nullopt;
    const Eigen::Map<const Eigen::RowVectorXf> seen(seen_.data(), std::ssize(seen_));
    if (iteration == 0) offset = seen.mean();
    const Eigen::RowVectorXf residual = (seen - gain * rows_.row(6)).array() - offset;
    Vector8f g = rows_ * residual.transpose();
    for (int i = 0; i < 4; ++i) g(2 + i) += kRidge * (place.stretch.val[i] - guess.stretch.val[i]);
    const Vector8f step = solver.solve(g);
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
  if (!(Correlation(template_, seen_) > least_correlation_)) return std::nullopt;
  return place;
}

}  // namespace polnav::nav
