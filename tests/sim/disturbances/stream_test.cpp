// What disturbances do to the streams, beside the same run without them.
//
// A turntable that does not turn stands 10 m from the road and looks across it into the low sun:
// frame by frame, whatever differs is the disturbance.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "sim/measurement_stream.h"

namespace polnav::sim {
namespace {

constexpr double kPlace_m = 230.0;  // of the road, to the south-west
constexpr double kDuration_s = 15.0;
constexpr double kFrameRate_hz = 5.0;

struct Recording {
  std::vector<cv::Mat> left;
  std::vector<double> moving_share;  // of the pixels
  std::vector<double> dop;           // of the polarimeter's readings
};

DisturbanceOptions From(double start_s, double duration_s) {
  return {.start_s = start_s, .duration_s = duration_s};
}

SimulatorOptions Standing(const std::vector<DisturbanceOptions>& disturbances) {
  SimulatorOptions options;
  options.world.sky_view = "scene";
  const Track::Point road = Track(TrackOptions{}).At(kPlace_m);
  const Eigen::Vector2d outwards(road.tangent.y(), -road.tangent.x());
  const Eigen::Vector2d stand = road.p_m - 10.0 * outwards;
  options.vehicle.turntable =
      TurntableOptions{.position_m = {stand.x(), stand.y(), 1.2},
                       .start_heading_deg = nav::RadToDeg(std::atan2(outwards.x(), outwards.y())),
                       .dwell_s = 1000.0};
  options.sensors.stereo = StereoCameraOptions{
      .rate_hz = kFrameRate_hz, .width_px = 160, .height_px = 96, .focal_px = 90.0};
  options.sensors.polarimeter = PolarimeterOptions{};
  options.disturbances = disturbances;
  return options;
}

// Of three opponent pairs 60 degrees apart [Zeng2020, eqs 4-8].
double DopOf(const nav::PolarizationSample& light) {
  std::array<double, 3> pair{};
  for (std::size_t k = 0; k < 3; ++k) {
    const double a = light.channel[2 * k];
    const double b = light.channel[2 * k + 1];
    pair[k] = (a - b) / (a + b);
  }
  return std::hypot(2.0 * pair[0] - pair[1] - pair[2], std::sqrt(3.0) * (pair[1] - pair[2])) / 3.0;
}

Recording Record(const SimulatorOptions& options, double duration_s) {
  Recording recording;
  MeasurementStream stream(options, {1, 0}, nav::FromSeconds(duration_s), 1);
  while (const auto item = stream.Next()) {
    if (const auto* frame = std::get_if<FrameTruth>(&*item)) {
      recording.moving_share.push_back(cv::countNonZero(frame->moving) /
                                       static_cast<double>(frame->moving.total()));
    } else if (const auto* measurement = std::get_if<nav::Measurement>(&*item)) {
      if (const auto* images = std::get_if<nav::StereoImages>(measurement)) {
        recording.left.push_back(images->left.clone());
      } else if (const auto* light = std::get_if<nav::PolarizationSample>(measurement)) {
        recording.dop.push_back(DopOf(*light));
      }
    }
  }
  return recording;
}

// The suite runs in one process (CMakeLists.txt) and shares it.
const Recording& Clean() {
  static const Recording recording = Record(Standing({}), kDuration_s);
  return recording;
}

// One after the other, two seconds each, a second and more of peace in between.
const Recording& LensAndLight() {
  static const Recording recording = [] {
    std::vector<DisturbanceOptions> list;
    const auto add = [&](double start_s) -> DisturbanceOptions& {
      list.push_back(From(start_s, 2.0));
      return list.back();
    };
    add(1.0).darkness = DarknessOptions{.light_share = 0.03};
    add(4.0).overexposure = OverexposureOptions{.gain = 8.0};
    add(7.0).fog = FogOptions{.visibility_m = 15.0};
    add(10.0).rain = LensCoverOptions{.share = 0.4};
    add(12.6).dirt = LensCoverOptions{.share = 0.4};
    return Record(Standing(list), kDuration_s);
  }();
  return recording;
}

const cv::Mat& At(const Recording& recording, double t_s) {
  return recording.left.at(static_cast<std::size_t>(t_s * kFrameRate_hz + 0.5));
}

bool Same(const cv::Mat& a, const cv::Mat& b) { return cv::norm(a, b, cv::NORM_INF) == 0.0; }

double ShareAbove(const cv::Mat& image, double grey) {
  return cv::countNonZero(image >= grey) / static_cast<double>(image.total());
}

// Mean magnitude of what an edge detector sees.
double Texture(const cv::Mat& image) {
  cv::Mat edges;
  cv::Laplacian(image, edges, CV_32F);
  return cv::mean(cv::abs(edges))[0];
}

TEST(DisturbedStream, IsByteForByteTheSameOutsideTheDisturbances) {
  for (const double t_s : {0.0, 0.8, 3.2, 3.8, 6.2, 6.8, 9.2, 9.8, 12.2, 14.8}) {
    EXPECT_TRUE(Same(At(LensAndLight(), t_s), At(Clean(), t_s))) << t_s;
  }
  // The polarimeter has a lens of its own, but fog is above it too.
  for (const int t_s : {0, 2, 5, 11, 13}) {
    EXPECT_EQ(LensAndLight().dop[20 * t_s], Clean().dop[20 * t_s]) << t_s;
  }
}

TEST(DisturbedStream, DarknessLeavesTheShareOfLightThatItSays) {
  const double dark = cv::mean(At(LensAndLight(), 2.0))[0];
  EXPECT_LT(dark,
            0.06 * cv::mean(At(Clean(), 2.0))[0] + 1.0);  // dark current and noise: a grey level
}

// Whatever was brighter than 255 / 8 is white, less the noise.
TEST(DisturbedStream, OverexposureSaturatesWhatTheGainSays) {
  const double white = ShareAbove(At(LensAndLight(), 5.0), 220);
  EXPECT_NEAR(white, ShareAbove(At(Clean(), 5.0), 255.0 / 8.0), 0.03);
  EXPECT_GT(white, 2.0 * ShareAbove(At(Clean(), 5.0), 220));
}

// Whatever is 10 m away and more keeps at most exp(-3.912 * 10 / 15) = 7 % of its contrast.
TEST(DisturbedStream, FogTakesAwayTextureOfWhatIsFar) {
  const cv::Rect horizon(0, 30, 160, 20);
  EXPECT_LT(Texture(At(LensAndLight(), 8.0)(horizon)), 0.5 * Texture(At(Clean(), 8.0)(horizon)));
}

// 50 m of fog with a visibility of 15 m: an optical depth of 13 lets nothing through.
TEST(DisturbedStream, FogTakesThePolarizationAway) {
  EXPECT_LT(LensAndLight().dop[8 * 20], 0.02);
  EXPECT_GT(Clean().dop[8 * 20], 0.3);
}

TEST(DisturbedStream, RainAndDirtCoverAPartOfThePicture) {
  for (const double t_s : {11.0, 13.6}) {
    cv::Mat difference;
    cv::absdiff(At(LensAndLight(), t_s), At(Clean(), t_s), difference);
    const double changed = ShareAbove(difference, 8);
    EXPECT_GT(changed, 0.1) << t_s;
    EXPECT_LT(changed, 0.8) << t_s;
  }
}

// The sun stands beside the picture, which nothing hides: a veil lifts all of it.
TEST(DisturbedStream, GlareLiftsTheDarkestParts) {
  DisturbanceOptions glare = From(1.0, 4.0);
  glare.glare = GlareOptions{.strength = 2.0};
  SimulatorOptions options = Standing({glare});
  options.sensors.stereo->rate_hz = 1.0;
  const Eigen::Vector3d sun_W = Simulator(options, {1, 0}).sky().sun_W(0.0);
  options.vehicle.turntable->start_heading_deg =
      nav::RadToDeg(std::atan2(sun_W.x(), sun_W.y())) + 50.0;
  const Recording veiled = Record(options, 3.0);
  double darkest = 0.0;
  double before = 0.0;
  cv::minMaxLoc(veiled.left.at(3), &darkest);
  cv::minMaxLoc(veiled.left.at(1), &before);
  EXPECT_GT(darkest, before + 10.0);
}

// 12 x 3.2 m, 7.4 m away: 78 degrees of the picture's 83, and 0.36 of its area if all of its height
// were seen. It passes at 5 s; 15 m to the side are seen of the lane, 5 m/s: gone 5 s later.
TEST(DisturbedStream, ABusThatPassesFillsAThirdOfTheViewAndMoves) {
  DisturbanceOptions entry = From(4.0, 2.0);
  entry.passing = PassingOptions{.kind = "bus", .count = 1, .offset_m = 2.6, .speed_m_s = 5.0};
  SimulatorOptions options = Standing({entry});
  options.sensors.stereo->ground_truth = true;
  options.sensors.stereo->rate_hz = 1.0;
  const Recording passed = Record(options, 10.0);
  EXPECT_GT(passed.moving_share.at(5), 0.25);
  EXPECT_LT(passed.moving_share.at(9), 0.05);
  cv::Mat difference;
  cv::absdiff(passed.left.at(5), At(Clean(), 5.0), difference);
  EXPECT_GT(ShareAbove(difference, 8), 0.15) << "where the bus is, the picture is another";
}

// Optical depth 20 lets through no direct light: the zenith is grey. The cloud is
// 400 m long and moves by 8 m/s; the sensor's cone of 10 degrees is some 300 m wide up there.
TEST(DisturbedStream, ACloudThatPassesTakesThePolarizationAway) {
  DisturbanceOptions entry = From(30.0, 50.0);
  entry.cloud_passage = CloudPassageOptions{.optical_depth = 20.0};
  SimulatorOptions options = Standing({});
  options.sky.thin_cloud_cover = 0.0;
  options.sensors.stereo.reset();
  const std::vector<double> clear = Record(options, 110.0).dop;
  options.disturbances = {entry};
  const std::vector<double> passed = Record(options, 110.0).dop;
  EXPECT_LT(passed.at(55 * 20), 0.35 * clear.at(55 * 20));  // thick cloud keeps up to 0.16 of DoP
  EXPECT_NEAR(passed.at(110 * 20), clear.at(110 * 20), 0.02);
  EXPECT_NEAR(passed.at(0), clear.at(0), 0.02);
}

// A car drives due north from the start; what is over the road from 10 m on hides the sky.
TEST(DisturbedStream, WhatIsOverTheRoadTakesThePolarizationAway) {
  const auto drive = [](const DisturbanceOptions& entry) {
    SimulatorOptions options;
    options.vehicle.car = CarOptions{.start_delay_s = 0.0};
    options.sensors.polarimeter = PolarimeterOptions{};
    options.disturbances = {entry};
    return Record(options, 7.0).dop;
  };
  const std::vector<double> open = drive(From(0.0, 1.0));
  DisturbanceOptions tunnel;
  tunnel.tunnel = StretchOptions{.start_m = 10.0, .length_m = 12.0};
  DisturbanceOptions bridge;
  bridge.bridge = tunnel.tunnel;
  DisturbanceOptions canopy;
  canopy.canopy = tunnel.tunnel;
  for (const auto& entry : {tunnel, bridge, canopy}) {
    const std::vector<double> hidden = drive(entry);
    ASSERT_EQ(hidden.size(), open.size());
    double least = 1.0;
    for (std::size_t i = 0; i < open.size(); ++i) least = std::min(least, hidden[i] / open[i]);
    EXPECT_LT(least, 0.5);
    EXPECT_EQ(hidden.front(), open.front());
    EXPECT_NEAR(hidden.back(), open.back(), 0.05);
  }
}

TEST(DisturbedStream, AStretchOfWallsLeavesLittleTexture) {
  SimulatorOptions options = Standing({});
  options.vehicle.turntable.reset();
  options.vehicle.car = CarOptions{.start_delay_s = 0.0};
  options.sensors.stereo->rate_hz = 0.2;  // the last picture is all that matters
  const double busy = Texture(Record(options, 5.0).left.at(1));
  DisturbanceOptions walls;
  walls.low_features = StretchOptions{.start_m = 6.0, .length_m = 80.0};
  options.disturbances = {walls};
  EXPECT_LT(Texture(Record(options, 5.0).left.at(1)), 0.5 * busy);
}

}  // namespace
}  // namespace polnav::sim
