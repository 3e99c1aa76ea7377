#include "sim/sensors/lens_rain.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

namespace polnav::sim {
namespace {

using std::numbers::pi;

constexpr double kSmallest = 0.012;  // radii, as shares of the picture's width
constexpr double kSpread = 0.03;     // times the square of a uniform number
constexpr double kDefocus = 0.009;   // sigma of the blur inside, of the picture's width
constexpr double kMeanSquareRadius =
    kSmallest * kSmallest + 2.0 * kSmallest * kSpread / 3.0 + kSpread * kSpread / 5.0;

struct Drop {
  double u_px;
  double v_px;
  double radius_px;
  double oval;        // how far from round
  double turned_rad;  // which way
};

// The drop that is in this place of the list at an instant.
Drop DropAt(const RandomStream& stream, std::uint64_t place, double t_s, const cv::Size& size) {
  RandomStream::Sample rhythm = stream.At(place << 32U);
  const double life_s = 0.8 + 1.2 * rhythm.Uniform();
  const auto life = static_cast<std::uint64_t>(t_s / life_s + rhythm.Uniform());
  RandomStream::Sample draw = stream.At((place << 32U) + life + 1);
  Drop drop{};
  drop.u_px = size.width * draw.Uniform();
  drop.v_px = size.height * draw.Uniform();
  const double size_draw = draw.Uniform();
  drop.radius_px = size.width * (kSmallest + kSpread * size_draw * size_draw);
  drop.oval = 0.12 * draw.Uniform();
  drop.turned_rad = 2.0 * pi * draw.Uniform();
  return drop;
}

double SmoothStep(double x) {
  const double t = std::clamp(x, 0.0, 1.0);
  return t * t * (3.0 - 2.0 * t);
}

void Draw(const Drop& drop, const cv::Mat& defocused, cv::Mat& image) {
  const int reach = static_cast<int>(std::ceil(1.5 * drop.radius_px));
  const cv::Rect box(static_cast<int>(drop.u_px) - reach, static_cast<int>(drop.v_px) - reach,
                     2 * reach + 1, 2 * reach + 1);
  const cv::Rect inside = box & cv::Rect(0, 0, image.cols, image.rows);
  for (int row = inside.y; row < inside.y + inside.height; ++row) {
    for (int col = inside.x; col < inside.x + inside.width; ++col) {
      const double dx = col - drop.u_px;
      const double dy = row - drop.v_px;
      const double angle = std::atan2(dy, dx) - drop.turned_rad;
      const double outline =
          1.0 + drop.oval * (std::cos(2.0 * angle) + 0.5 * std::cos(3.0 * angle));
      const double rho = std::hypot(dx, dy) / (drop.radius_px * outline);
      const double cover = SmoothStep((1.0 - rho) / 0.5 + 0.5);
      if (cover == 0.0) continue;
      // Upside down, and wider towards the rim.
      const double wide = -(2.0 + 2.0 * rho * rho);
      const int u = std::clamp(static_cast<int>(drop.u_px + wide * dx), 0, image.cols - 1);
      const int v = std::clamp(static_cast<int>(drop.v_px + wide * dy), 0, image.rows - 1);
      const double through =
          defocused.at<std::uint8_t>(v, u) * (1.0 - 0.2 * SmoothStep((rho - 0.5) / 0.5));
      auto& pixel = image.at<std::uint8_t>(row, col);
      pixel = static_cast<std::uint8_t>(std::lround(pixel + cover * (through - pixel)));
    }
  }
}

}  // namespace

void LensRain::Apply(double rain_share, nav::TimeNs stamp, cv::Mat& image) const {
  // Discs thrown at random leave exp(-their area over the picture's) of it dry.
  const double wet = -std::log(1.0 - std::min(rain_share, 0.95));
  const double count = wet * image.rows / (pi * kMeanSquareRadius * image.cols);
  cv::Mat defocused;
  cv::GaussianBlur(image, defocused, {}, kDefocus * image.cols, 0.0, cv::BORDER_REPLICATE);
  for (std::uint64_t place = 0; place < static_cast<std::uint64_t>(std::lround(count)); ++place) {
    Draw(DropAt(stream_, place, nav::ToSeconds(stamp), image.size()), defocused, image);
  }
}

}  // namespace polnav::sim
