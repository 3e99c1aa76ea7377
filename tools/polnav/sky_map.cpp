#include "tools/polnav/sky_map.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "nav/api/geometry.h"
#include "sky/neutral_points.h"
#include "sky/sky_batch.h"
#include "sky/sun.h"

namespace polnav::testbed {
namespace {

using std::numbers::pi;

constexpr int kRadius = 250;  // of the horizon [px]
constexpr int kPanel = 620;   // width
constexpr int kTop = 110;     // of the panels, below the titles
constexpr int kHeight = 740;
const cv::Scalar kInk(40, 40, 40);
const cv::Scalar kFaint(120, 120, 120);

// One quantity: its values over a square about the zenith, not a number beyond the horizon.
struct Panel {
  std::string title;
  cv::Mat values;  // CV_64F
  double low, high;
  int colors;
  std::vector<std::pair<double, std::string>> ticks;
};

void Write(cv::Mat& image, const std::string& text, cv::Point center, double scale,
           const cv::Scalar& color, int face = cv::FONT_HERSHEY_SIMPLEX) {
  int below = 0;
  const cv::Size size = cv::getTextSize(text, face, scale, 1, &below);
  cv::putText(image, text, {center.x - size.width / 2, center.y + size.height / 2}, face, scale,
              color, 1, cv::LINE_AA);
}

// Light text with a dark rim, to be read on any color.
void WriteOnMap(cv::Mat& image, const std::string& text, cv::Point left) {
  cv::putText(image, text, left, cv::FONT_HERSHEY_SIMPLEX, 0.45, {0, 0, 0}, 3, cv::LINE_AA);
  cv::putText(image, text, left, cv::FONT_HERSHEY_SIMPLEX, 0.45, {255, 255, 255}, 1, cv::LINE_AA);
}

cv::Point2d OnMap(const Eigen::Vector3d& ray_W) {
  const double from_zenith = std::atan2(ray_W.head<2>().norm(), ray_W.z());
  const Eigen::Vector2d along = ray_W.head<2>().stableNormalized();
  const double radius = kRadius * from_zenith / (0.5 * pi);
  return {radius * along.x(), -radius * along.y()};
}

struct SkyGrid {
  cv::Mat aop_deg, dop, log_radiance;
};

SkyGrid LookAround(const sky::ClearSky& sky) {
  constexpr int kSide = 2 * kRadius + 1;
  std::vector<double> east, north, up;
  std::vector<cv::Point> pixels;
  for (int row = 0; row < kSide; ++row) {
    for (int col = 0; col < kSide; ++col) {
      const double x = col - kRadius;
      const double y = kRadius - row;
      const double radius = std::hypot(x, y);
      if (radius > kRadius) continue;
      const double elevation_rad = 0.5 * pi * (1.0 - radius / kRadius);
      const Eigen::Vector3d ray = sky::DirectionEnu(std::atan2(x, y), elevation_rad);
      east.push_back(ray.x());
      north.push_back(ray.y());
      up.push_back(std::max(0.0, ray.z()));
      pixels.emplace_back(col, row);
    }
  }
  std::vector<double> radiance(up.size()), q(up.size()), u(up.size());
  sky::LookAlong(sky, {east, north, up}, {radiance, q, u});
  const cv::Mat nothing(kSide, kSide, CV_64F, cv::Scalar(std::nan("")));
  SkyGrid grid{nothing.clone(), nothing.clone(), nothing.clone()};
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    grid.aop_deg.at<double>(pixels[i]) = nav::RadToDeg(0.5 * std::atan2(u[i], q[i]));
    grid.dop.at<double>(pixels[i]) = std::hypot(q[i], u[i]);
    grid.log_radiance.at<double>(pixels[i]) = std::log10(radiance[i]);
  }
  return grid;
}

cv::Mat Colored(const cv::Mat& values, double low, double high, int colors) {
  cv::Mat scaled;
  values.convertTo(scaled, CV_8U, 255.0 / (high - low), -255.0 * low / (high - low));
  cv::Mat colored;
  cv::applyColorMap(scaled, colored, colors);
  return colored;
}

void DrawBar(cv::Mat& image, const Panel& panel, int center_x) {
  constexpr int kWidth = 400;
  constexpr int kThick = 16;
  const cv::Rect place(center_x - kWidth / 2, kTop + 2 * kRadius + 80, kWidth, kThick);
  cv::Mat ramp(1, kWidth, CV_64F);
  for (int i = 0; i < kWidth; ++i) {
    ramp.at<double>(i) = panel.low + (panel.high - panel.low) * i / (kWidth - 1);
  }
  cv::Mat bar;
  cv::resize(Colored(ramp, panel.low, panel.high, panel.colors), bar, place.size(), 0, 0,
             cv::INTER_NEAREST);
  bar.copyTo(image(place));
  cv::rectangle(image, place, kInk, 1, cv::LINE_AA);
  for (const auto& [value, label] : panel.ticks) {
    const int x = place.x + static_cast<int>(std::lround((kWidth - 1) * (value - panel.low) /
                                                         (panel.high - panel.low)));
    cv::line(image, {x, place.y + kThick}, {x, place.y + kThick + 5}, kInk, 1, cv::LINE_AA);
    Write(image, label, {x, place.y + kThick + 16}, 0.45, kInk);
  }
}

void Mark(cv::Mat& image, const sky::ClearSky& sky, const cv::Point& center) {
  for (const double elevation_deg : {30.0, 60.0}) {
    const int radius = static_cast<int>(std::lround(kRadius * (90.0 - elevation_deg) / 90.0));
    cv::circle(image, center, radius, {200, 200, 200}, 1, cv::LINE_AA);
  }
  for (const sky::NeutralPoint& point : sky::NeutralPoints(sky)) {
    if (point.ray_W.z() < 0.0 || point.name == "sun") continue;
    const cv::Point at = center + cv::Point(OnMap(point.ray_W));
    cv::circle(image, at, 5, {0, 0, 0}, 3, cv::LINE_AA);
    cv::circle(image, at, 5, {255, 255, 255}, 1, cv::LINE_AA);
    // Above, below or beside the point, so that names about the sun do not meet.
    const bool above = point.name == "Babinet" || point.name == "Arago";
    WriteOnMap(image, point.name, at + cv::Point(9, above ? -6 : 17));
  }
  const cv::Point sun = center + cv::Point(OnMap(sky.sun_W()));
  cv::circle(image, sun, 8, {0, 0, 0}, cv::FILLED, cv::LINE_AA);
  cv::circle(image, sun, 6, {60, 220, 255}, cv::FILLED, cv::LINE_AA);
  WriteOnMap(image, "sun", sun - cv::Point(38, -5));
}

void Draw(cv::Mat& image, const Panel& panel, const sky::ClearSky& sky, int index) {
  const cv::Point center(index * kPanel + kPanel / 2, kTop + kRadius + 40);
  Write(image, panel.title, {center.x, kTop}, 0.6, kInk);
  const cv::Mat inside = panel.values == panel.values;  // not a number is not itself
  cv::Mat place =
      image({center.x - kRadius, center.y - kRadius, panel.values.cols, panel.values.rows});
  Colored(panel.values, panel.low, panel.high, panel.colors).copyTo(place, inside);
  Mark(image, sky, center);
  cv::circle(image, center, kRadius, kInk, 2, cv::LINE_AA);
  const int out = kRadius + 14;
  Write(image, "N", center + cv::Point(0, -out), 0.55, kInk);
  Write(image, "S", center + cv::Point(0, out), 0.55, kInk);
  Write(image, "E", center + cv::Point(out, 0), 0.55, kInk);
  Write(image, "W", center + cv::Point(-out, 0), 0.55, kInk);
  DrawBar(image, panel, center.x);
}

Panel RadiancePanel(const cv::Mat& log_radiance) {
  double low = 0.0;
  double high = 0.0;
  cv::minMaxLoc(log_radiance, &low, &high, nullptr, nullptr, log_radiance == log_radiance);
  Panel panel{"Radiance over the zenith's", log_radiance, low, high, cv::COLORMAP_INFERNO, {}};
  for (const double value : {0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 100.0}) {
    const double place = std::log10(value);
    if (place >= low && place <= high) panel.ticks.emplace_back(place, fmt::format("{}", value));
  }
  return panel;
}

Panel DopPanel(const cv::Mat& dop) {
  double highest = 0.0;
  cv::minMaxLoc(dop, nullptr, &highest, nullptr, nullptr, dop == dop);
  const int tenths = std::clamp(static_cast<int>(std::ceil(10.0 * highest)), 1, 10);
  Panel panel{"Degree of polarization", dop, 0.0, 0.1 * tenths, cv::COLORMAP_VIRIDIS, {}};
  for (int i = 0; i <= tenths; ++i)
    panel.ticks.emplace_back(0.1 * i, fmt::format("{:.1f}", 0.1 * i));
  return panel;
}

}  // namespace

cv::Mat DrawSky(const sky::ClearSky& sky, const std::string& title, const std::string& subtitle) {
  const SkyGrid grid = LookAround(sky);
  const Panel aop{"Angle of polarization from the vertical plane [deg]",
                  grid.aop_deg,
                  -90.0,
                  90.0,
                  cv::COLORMAP_TWILIGHT_SHIFTED,
                  {{-90, "-90"}, {-45, "-45"}, {0, "0"}, {45, "45"}, {90, "90"}}};
  cv::Mat image(kHeight, 3 * kPanel, CV_8UC3, cv::Scalar(255, 255, 255));
  Write(image, title, {image.cols / 2, 32}, 0.9, kInk, cv::FONT_HERSHEY_DUPLEX);
  Write(image, subtitle, {image.cols / 2, 66}, 0.5, kFaint);
  Draw(image, aop, sky, 0);
  Draw(image, DopPanel(grid.dop), sky, 1);
  Draw(image, RadiancePanel(grid.log_radiance), sky, 2);
  return image;
}

}  // namespace polnav::testbed
