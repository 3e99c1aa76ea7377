#include "nav/stereo/corners.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace polnav::nav {
namespace {

// Over which the slopes are gathered, at the size they are taken from: as wide as the patch.
constexpr int kHalf = 2;

struct Corner {
  float strength;
  cv::Point at;  // of the level
};

// Of equals, the earlier stays first.
void SortByStrength(std::vector<Corner>& corners) {
  std::stable_sort(corners.begin(), corners.end(),
                   [](const Corner& a, const Corner& b) { return a.strength > b.strength; });
}

// Local maxima of a cell above the threshold, strongest first.
std::vector<Corner> CornersIn(const cv::Mat& strength, const cv::Rect& cell, float threshold) {
  std::vector<Corner> corners;
  for (int y = std::max(cell.y, 1); y < std::min(cell.br().y, strength.rows - 1); ++y) {
    const float* above = strength.ptr<float>(y - 1);
    const float* here = strength.ptr<float>(y);
    const float* below = strength.ptr<float>(y + 1);
    for (int x = std::max(cell.x, 1); x < std::min(cell.br().x, strength.cols - 1); ++x) {
      const float s = here[x];
      if (s <= threshold) continue;
      const bool highest = s > here[x - 1] && s >= here[x + 1] && s > above[x - 1] &&
                           s > above[x] && s > above[x + 1] && s >= below[x - 1] && s >= below[x] &&
                           s >= below[x + 1];
      if (highest) corners.push_back({s, {x, y}});
    }
  }
  SortByStrength(corners);
  return corners;
}

class Grid {
 public:
  Grid(const cv::Size& size, const TrackerOptions& options)
      : size_(size), columns_(options.grid_columns), rows_(options.grid_rows) {}

  [[nodiscard]] int cells() const { return columns_ * rows_; }

  [[nodiscard]] int CellOf(const cv::Point2f& p) const {
    const int column = std::clamp(static_cast<int>(p.x) * columns_ / size_.width, 0, columns_ - 1);
    const int row = std::clamp(static_cast<int>(p.y) * rows_ / size_.height, 0, rows_ - 1);
    return row * columns_ + column;
  }

  [[nodiscard]] cv::Rect Pixels(int cell) const {
    const int column = cell % columns_;
    const int row = cell / columns_;
    const cv::Point first(column * size_.width / columns_, row * size_.height / rows_);
    const cv::Point last((column + 1) * size_.width / columns_, (row + 1) * size_.height / rows_);
    return {first, last};
  }

 private:
  cv::Size size_;
  int columns_;
  int rows_;
};

}  // namespace

cv::Mat SmallerEigenvalue(const cv::Mat& slopes, int half) {
  const int rows = slopes.rows;
  const int cols = slopes.cols;
  cv::Mat strength = cv::Mat::zeros(rows, cols, CV_32FC1);
  const auto width = static_cast<std::size_t>(cols);
  // Column sums of the products over the rows that are gathered, moved down one row at a time.
  std::array<std::vector<std::int32_t>, 3> sums;
  for (auto& sum : sums) sum.assign(width, 0);
  const auto add = [&](int row, std::int32_t sign) {
    const std::int16_t* g = slopes.ptr<std::int16_t>(row);
    for (std::size_t x = 0; x < width; ++x) {
      // An eighth: slopes of Scharr's operator are up to 4080, and the sums stay below 2^31.
      const std::int32_t gx = g[2 * x] / 8;
      const std::int32_t gy = g[2 * x + 1] / 8;
      sums[0][x] += sign * gx * gx;
      sums[1][x] += sign * gx * gy;
      sums[2][x] += sign * gy * gy;
    }
  };
  for (int row = 0; row < std::min(2 * half, rows); ++row) add(row, 1);
  for (int y = half; y + half < rows; ++y) {
    add(y + half, 1);
    float* out = strength.ptr<float>(y);
    std::array<std::int32_t, 3> box{};
    for (int x = 0; x < std::min(2 * half, cols); ++x) {
      for (std::size_t k = 0; k < 3; ++k) box[k] += sums[k][static_cast<std::size_t>(x)];
    }
    for (int x = half; x + half < cols; ++x) {
      for (std::size_t k = 0; k < 3; ++k) box[k] += sums[k][static_cast<std::size_t>(x + half)];
      const auto a = static_cast<float>(box[0]);
      const auto b = static_cast<float>(box[1]);
      const auto c = static_cast<float>(box[2]);
      out[x] = 0.5F * (a + c - std::sqrt((a - c) * (a - c) + 4.0F * b * b));
      for (std::size_t k = 0; k < 3; ++k) box[k] -= sums[k][static_cast<std::size_t>(x - half)];
    }
    add(y - half, -1);
  }
  return strength;
}

std::vector<cv::Point2f> FindCorners(const Pyramid& pyramid,
                                     const std::vector<cv::Point2f>& followed,
                                     const TrackerOptions& options) {
  std::vector<cv::Point2f> fresh;
  const int room = options.max_features - static_cast<int>(followed.size());
  if (room <= 0) return fresh;
  // Slopes follow their image; half size where there is one.
  const std::size_t level = pyramid.size() >= 4 ? 2 : 0;
  const auto scale = static_cast<float>(level == 2 ? 2 : 1);
  const cv::Mat strength = SmallerEigenvalue(pyramid[level + 1], kHalf);
  double best = 0.0;
  cv::minMaxLoc(strength, nullptr, &best);
  const auto threshold = std::max(static_cast<float>(options.corner_quality * best), 1.0F);

  const Grid grid(strength.size(), options);
  const int per_cell = std::max(1, options.max_features / grid.cells());
  std::vector<int> filled(static_cast<std::size_t>(grid.cells()), 0);
  cv::Mat taken = cv::Mat::zeros(strength.size(), CV_8UC1);
  const int radius = std::max(
      1, static_cast<int>(std::lround(static_cast<float>(options.min_distance_px) / scale)));
  for (const cv::Point2f& p : followed) {
    ++filled[static_cast<std::size_t>(grid.CellOf(p / scale))];
    cv::circle(taken, p / scale, radius, cv::Scalar(1), cv::FILLED);
  }
  std::vector<Corner> found;
  for (int cell = 0; cell < grid.cells(); ++cell) {
    int& count = filled[static_cast<std::size_t>(cell)];
    if (count >= per_cell) continue;
    for (const Corner& corner : CornersIn(strength, grid.Pixels(cell), threshold)) {
      if (count >= per_cell) break;
      if (taken.at<std::uint8_t>(corner.at) != 0) continue;
      ++count;
      found.push_back(corner);
      cv::circle(taken, corner.at, radius, cv::Scalar(1), cv::FILLED);
    }
  }
  SortByStrength(found);
  if (static_cast<int>(found.size()) > room) found.resize(static_cast<std::size_t>(room));
  for (const Corner& corner : found) fresh.push_back(cv::Point2f(corner.at) * scale);
  return fresh;
}

}  // namespace polnav::nav
