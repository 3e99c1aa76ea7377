#include "sim/sensors/block_matching.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <opencv2/imgproc.hpp>
#include <optional>
#include <stdexcept>
#include <vector>

namespace polnav::sim {
namespace {

constexpr int kBlock = 8;
constexpr int kPixels = kBlock * kBlock;
constexpr int kPitch = 9;                     // from block to block
constexpr int kMargin = kBlockSearch_px + 2;  // search, and a pixel for slopes and interpolation
// What slopes and interpolation are taken from: sharper pictures pull shifts towards whole pixels.
constexpr double kBlur_px = 1.0;
// Smallest eigenvalue of the sum of squared slopes: noise of one grey level makes some 2.5.
constexpr double kLeastTexture = 8.0;
constexpr double kUnlike = 0.5;     // unexplained share of the block's variance
constexpr double kApart_px = 0.5;   // from the blocks' median
constexpr double kAstray_px = 1.5;  // of the refinement, from the best whole pixel

int SumOfDifferences(const cv::Mat& a, const cv::Mat& b, const cv::Point& at_a,
                     const cv::Point& at_b) {
  int sum = 0;
  for (int row = 0; row < kBlock; ++row) {
    const std::uint8_t* const pa = a.ptr<std::uint8_t>(at_a.y + row) + at_a.x;
    const std::uint8_t* const pb = b.ptr<std::uint8_t>(at_b.y + row) + at_b.x;
    for (int col = 0; col < kBlock; ++col) sum += std::abs(pa[col] - pb[col]);
  }
  return sum;
}

cv::Point BestWholeShift(const cv::Mat& before, const cv::Mat& after, const cv::Point& at) {
  cv::Point best;
  int least = std::numeric_limits<int>::max();
  for (int dy = -kBlockSearch_px; dy <= kBlockSearch_px; ++dy) {
    for (int dx = -kBlockSearch_px; dx <= kBlockSearch_px; ++dx) {
      const int sum = SumOfDifferences(before, after, at, at + cv::Point(dx, dy));
      if (sum >= least) continue;
      least = sum;
      best = {dx, dy};
    }
  }
  return best;
}

using Values = Eigen::Matrix<double, kPixels, 1>;

// A block of the picture before: grey levels and their slopes, each less its mean.
struct Template {
  Values grey;
  Eigen::Matrix<double, kPixels, 2> slope;
  Eigen::Matrix2d texture;
};

Template TemplateAt(const cv::Mat& image, const cv::Point& at) {
  Template t;
  for (int row = 0; row < kBlock; ++row) {
    const float* const above = image.ptr<float>(at.y + row - 1) + at.x;
    const float* const here = image.ptr<float>(at.y + row) + at.x;
    const float* const below = image.ptr<float>(at.y + row + 1) + at.x;
    for (int col = 0; col < kBlock; ++col) {
      const int i = row * kBlock + col;
      t.grey[i] = here[col];
      t.slope(i, 0) = 0.5 * (here[col + 1] - here[col - 1]);
      t.slope(i, 1) = 0.5 * (below[col] - above[col]);
    }
  }
  t.grey.array() -= t.grey.mean();
  // A change of brightness is none of the shift's.
  t.slope.rowwise() -= t.slope.colwise().mean().eval();
  t.texture = t.slope.transpose() * t.slope;
  return t;
}

// Lagrange's weights of four samples for a place t behind the second: exact for cubics, where the
// usual cubic convolution is for squares only and, as straight lines do, pulls shifts by 0.01 px.
std::array<double, 4> CubicWeights(double t) {
  return {-t * (t - 1.0) * (t - 2.0) / 6.0, 0.5 * (t + 1.0) * (t - 1.0) * (t - 2.0),
          -0.5 * (t + 1.0) * t * (t - 2.0), (t + 1.0) * t * (t - 1.0) / 6.0};
}

// False: reaches beyond the picture.
bool SampleAt(const cv::Mat& image, const Eigen::Vector2d& at, Values& grey) {
  constexpr int kRows = kBlock + 3;
  const int x = static_cast<int>(std::floor(at.x()));
  const int y = static_cast<int>(std::floor(at.y()));
  if (x < 1 || y < 1 || x + kBlock + 1 >= image.cols || y + kBlock + 1 >= image.rows) return false;
  const std::array<double, 4> u = CubicWeights(at.x() - x);
  const std::array<double, 4> v = CubicWeights(at.y() - y);
  std::array<std::array<double, kBlock>, kRows> across;
  for (int row = 0; row < kRows; ++row) {
    const float* const p = image.ptr<float>(y + row - 1) + x - 1;
    for (int col = 0; col < kBlock; ++col) {
      across[row][col] = u[0] * p[col] + u[1] * p[col + 1] + u[2] * p[col + 2] + u[3] * p[col + 3];
    }
  }
  for (int row = 0; row < kBlock; ++row) {
    for (int col = 0; col < kBlock; ++col) {
      grey[row * kBlock + col] = v[0] * across[row][col] + v[1] * across[row + 1][col] +
                                 v[2] * across[row + 2][col] + v[3] * across[row + 3][col];
    }
  }
  return true;
}

double SmallestEigenvalue(const Eigen::Matrix2d& m) {
  const double half = 0.5 * m.trace();
  return half - std::sqrt(std::max(0.0, half * half - m.determinant()));
}

// As it came, and blurred.
struct Picture {
  explicit Picture(const cv::Mat& grey) : raw(grey) {
    grey.convertTo(smooth, CV_32F);
    cv::GaussianBlur(smooth, smooth, {7, 7}, kBlur_px);
  }
  cv::Mat raw;     // CV_8UC1
  cv::Mat smooth;  // CV_32FC1
};

std::optional<Eigen::Vector2d> ShiftOfBlock(const Picture& before, const Picture& after,
                                            const cv::Point& at) {
  const Template t = TemplateAt(before.smooth, at);
  if (SmallestEigenvalue(t.texture) < kLeastTexture) return std::nullopt;
  const cv::Point whole = BestWholeShift(before.raw, after.raw, at);
  const Eigen::Matrix2d inverse = t.texture.inverse();
  const Eigen::Vector2d start(whole.x, whole.y);
  Eigen::Vector2d shift = start;
  Values now;
  for (int i = 0; i < 6; ++i) {
    if (!SampleAt(after.smooth, Eigen::Vector2d(at.x, at.y) + shift, now)) return std::nullopt;
    now.array() -= now.mean();
    const Eigen::Vector2d step = inverse * (t.slope.transpose() * (t.grey - now));
    shift += step;
    if ((shift - start).cwiseAbs().maxCoeff() > kAstray_px) return std::nullopt;
    if (step.cwiseAbs().maxCoeff() < 2e-3) break;
  }
  if ((t.grey - now).squaredNorm() > kUnlike * t.grey.squaredNorm()) return std::nullopt;
  return shift;
}

double Median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

PictureShift MatchBlocks(const cv::Mat& before, const cv::Mat& after) {
  if (before.type() != CV_8UC1 || after.type() != CV_8UC1 || before.size() != after.size()) {
    throw std::logic_error("MatchBlocks needs two CV_8UC1 of one size");
  }
  // As many as fit, about the middle.
  const auto count = [](int side) { return (side - 2 * kMargin - kBlock) / kPitch + 1; };
  const auto first = [&](int side) { return (side - (count(side) - 1) * kPitch - kBlock) / 2; };
  const Picture here(before);
  const Picture there(after);
  PictureShift result{.blocks = count(before.cols) * count(before.rows)};
  std::vector<double> x, y;
  for (int row = 0; row < count(before.rows); ++row) {
    for (int col = 0; col < count(before.cols); ++col) {
      const cv::Point at(first(before.cols) + kPitch * col, first(before.rows) + kPitch * row);
      const auto shift = ShiftOfBlock(here, there, at);
      if (!shift) continue;
      x.push_back(shift->x());
      y.push_back(shift->y());
    }
  }
  if (x.empty()) return result;
  const Eigen::Vector2d median(Median(x), Median(y));
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Eigen::Vector2d shift(x[i], y[i]);
    if ((shift - median).cwiseAbs().maxCoeff() > kApart_px) continue;
    sum += shift;
    ++result.matched;
  }
  if (result.matched > 0) result.shift_px = sum / result.matched;
  return result;
}

}  // namespace polnav::sim
