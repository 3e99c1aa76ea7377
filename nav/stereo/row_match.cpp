#include "nav/stereo/row_match.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

namespace polnav::nav {
namespace {

using Vector5f = Eigen::Matrix<float, 5, 1>;
using Matrix5f = Eigen::Matrix<float, 5, 5>;

// Far points may come out slightly behind infinity; the noise of a match decides how much.
constexpr float kLeastDisparity_px = -1.5F;
// Half sides of the patches of the search, small at the coarse levels where a pixel spans more.
constexpr int kCoarseHalf = 3;
constexpr int kMiddleHalf = 4;
constexpr int kMaxIterations = 20;
constexpr float kEnough_px = 0.003F;
// Slopes of disparity beyond those of the ground and of walls seen at an angle are not expected:
// one sigma, against the noise of grey values.
constexpr float kSlopeSigma = 0.3F;
constexpr float kGreySigma = 3.0F;

float ScaleOf(int level) { return 1.0F / static_cast<float>(1 << level); }

// Pixel centres are integers and a pyramid keeps every other one, so coordinates just shrink.
cv::Point2f AtLevel(const cv::Point2f& p, int level) { return p * ScaleOf(level); }

}  // namespace

RowMatcher::RowMatcher(const TrackerOptions& options, const StereoRectifier& rectifier,
                       const std::vector<cv::Mat>& left, const std::vector<cv::Mat>& right)
    : options_(options),
      rectifier_(rectifier),
      left_(left),
      right_(right),
      half_(options.window_px / 2) {}

std::optional<float> RowMatcher::Match(const RowQuery& query) {
  const std::optional<float> coarse = Coarse(query);
  if (!coarse) return std::nullopt;
  const std::optional<float> fine = Refine(query, *coarse);
  if (!fine || !LeadsBack(query, *fine)) return std::nullopt;
  return fine;
}

RowMatcher::Curve RowMatcher::CurveAt(const RowQuery& query, float disparity_px) const {
  const cv::Point2f rectified = query.left_rectified - cv::Point2f(disparity_px, 0.0F);
  const cv::Point2f half_step(0.5F, 0.0F);
  const cv::Point2f nearer = rectifier_.RawRight(rectified - half_step);
  const cv::Point2f farther = rectifier_.RawRight(rectified + half_step);
  return {0.5F * (nearer + farther), nearer - farther};
}

// The best of the disparities first, first + step ... up to last.
std::optional<float> RowMatcher::Search(const RowQuery& query, int level, int half, float first,
                                        float last, float step) {
  const auto index = static_cast<std::size_t>(level);
  const cv::Point2f left = AtLevel(query.left_raw, level);
  if (!ReadPatch(left_[index], left, half, template_)) return std::nullopt;
  std::optional<float> best;
  float best_score = static_cast<float>(options_.stereo_correlation) - 0.2F;
  for (float d = first; d <= last; d += step) {
    const cv::Point2f raw = rectifier_.RawRight(query.left_rectified - cv::Point2f(d, 0.0F));
    if (!ReadPatch(right_[index], AtLevel(raw, level), half, candidate_)) continue;
    const float score = Correlation(template_, candidate_);
    if (score > best_score) {
      best_score = score;
      best = d;
    }
  }
  return best;
}

std::optional<float> RowMatcher::Coarse(const RowQuery& query) {
  const int top = std::min(2, static_cast<int>(std::min(left_.size(), right_.size())) - 1);
  std::optional<float> d = query.expected_px;
  if (!d) {
    const float step = 1.0F / ScaleOf(top);
    d = Search(query, top, kCoarseHalf, 0.0F, static_cast<float>(options_.max_disparity_px), step);
  }
  if (top > 0 && d) d = Search(query, 1, kMiddleHalf, *d - 6.0F, *d + 6.0F, 2.0F);
  if (d) d = Search(query, 0, half_, *d - 2.0F, *d + 2.0F, 1.0F);
  return d;
}

// Gauss-Newton with the slopes of the left patch, which stay: one factorization a point.
//   right(d, s) = gain left + offset,  unknowns (d, s_x, s_y, gain, offset)
std::optional<float> RowMatcher::Refine(const RowQuery& query, float disparity_px) {
  if (!ReadPatch(left_[0], query.left_raw, half_ + 1, template_)) return std::nullopt;
  const Curve start = CurveAt(query, disparity_px);
  FillRows(start.along);
  Matrix5f H = rows_ * rows_.transpose();
  if (H(0, 0) < static_cast<float>(rows_.cols())) return std::nullopt;  // a grey value per pixel
  const Vector5f by_gain = H.col(3);
  const Vector5f by_offset = H.col(4);
  const float ridge = kGreySigma * kGreySigma / (kSlopeSigma * kSlopeSigma);
  H(1, 1) += ridge;
  H(2, 2) += ridge;
  const Eigen::LDLT<Matrix5f> solver(H);
  Vector5f x(disparity_px, 0.0F, 0.0F, 1.0F, 0.0F);
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    const cv::Point2f at = start.at + (x(0) - disparity_px) * start.along;
    const cv::Matx22f stretch(1.0F + start.along.x * x(1), start.along.x * x(2),
                              start.along.y * x(1), 1.0F + start.along.y * x(2));
    if (!ReadWarped(right_[0], at, stretch, half_, candidate_)) return std::nullopt;
    const Eigen::Map<const Eigen::VectorXf> seen(candidate_.data(), std::ssize(candidate_));
    Vector5f g = rows_ * seen - x(3) * by_gain - x(4) * by_offset;
    g(1) += ridge * x(1);
    g(2) += ridge * x(2);
    Vector5f step = -solver.solve(g);
    step.tail<2>() *= -1.0F;  // the prediction, not what is seen, has these two
    x += step;
    const bool lost =
        !(std::abs(x(0) - disparity_px) < 2.5F) || std::abs(x(1)) > 0.6F || std::abs(x(2)) > 1.0F;
    if (lost) return std::nullopt;
    if (std::abs(step(0)) < kEnough_px) break;
  }
  const Eigen::VectorXf grey = rows_.row(3);
  template_.assign(grey.begin(), grey.end());
  const bool alike =
      Correlation(template_, candidate_) > static_cast<float>(options_.stereo_correlation);
  const bool plausible = x(0) > kLeastDisparity_px && x(0) < options_.max_disparity_px;
  return alike && plausible ? std::optional(x(0)) : std::nullopt;
}

// From the template, which is a pixel wider all around than what is compared.
void RowMatcher::FillRows(const cv::Point2f& along) {
  const int side = 2 * half_ + 1;
  rows_.resize(5, side * side);
  ForEachSlope(template_, half_, [&](int k, float i, float j, float grey, float x, float y) {
    const float slope = along.x * x + along.y * y;
    rows_.col(k) << slope, slope * i, slope * j, grey, 1.0F;
  });
}

// Half-size patches from the right, along the way back in the left image: best where they came
// from, among all within twelve pixels.
bool RowMatcher::LeadsBack(const RowQuery& query, float disparity_px) {
  const std::size_t level = std::min<std::size_t>(1, right_.size() - 1);
  const Curve curve = CurveAt(query, disparity_px);
  const auto at = [&](const cv::Point2f& p) { return AtLevel(p, static_cast<int>(level)); };
  if (!ReadPatch(right_[level], at(curve.at), kMiddleHalf, template_)) return false;
  constexpr int kReach = 6;
  int best = -kReach - 1;
  float best_score = 0.0F;
  for (int step = -kReach; step <= kReach; ++step) {
    const cv::Point2f there = at(query.left_raw) + static_cast<float>(step) * curve.along;
    if (!ReadPatch(left_[level], there, kMiddleHalf, candidate_)) continue;
    const float score = Correlation(template_, candidate_);
    if (score > best_score) {
      best_score = score;
      best = step;
    }
  }
  return std::abs(best) <= 1;
}

}  // namespace polnav::nav
