// Under which skies is a compass tried, and how well did it do?
//
// The protocol of docs/compass.md, fixed before any compass was run: image k of a preset has its
// own clouds, sun and heading, all drawn from the stream "compass/protocol" at index k:
//   sun elevation uniform in 10 to 60 degrees, sun azimuth and heading uniform, camera level;
//   twenty images an instrument.
// The sky is the world's default one but for the preset.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "nav/polarization/compass.h"
#include "nav/polarization/turn_calibration.h"
#include "sim/sensors/polarization_camera.h"
#include "sim/truth.h"

namespace polnav {

struct SkyShot {
  nav::PolarizationImage image;
  Eigen::Vector3d sun_W;
  double heading_rad = 0.0;
  double sun_elevation_rad = 0.0;
};

struct SeriesOptions {
  sim::PolarizationCameraOptions camera;
  sky::SkyOptions sky;
  std::uint64_t seed = 2020;
  int images_per_instrument = 20;
};

[[nodiscard]] sim::Truth StandingAt(double heading_rad, const nav::Tilt& tilt = {});

[[nodiscard]] SkyShot TakeShot(const SeriesOptions& options, std::uint64_t index);

// What an instrument is calibrated by before its pictures count: 24 pictures of a full turn, level,
// with stated headings, under the sky of `options` and a sun 25 degrees high.
[[nodiscard]] std::vector<nav::TurnPicture> TakeTurn(const SeriesOptions& options,
                                                     std::uint64_t instrument);

struct SeriesScore {
  int images = 0;
  int headings = 0;    // whole circle
  int half_turns = 0;  // half turn unknown: scored as axes
  int refused = 0;
  double mean_deg = 0.0;
  double std_deg = 0.0;
  double rmse_deg = 0.0;
  double nees = 0.0;  // mean of (error / sigma)^2
  int beyond_5_sigma = 0;
  double median_sigma_deg = 0.0;
  double worst_deg = 0.0;

  void Add(const nav::CompassReading& reading, double heading_rad);
  void Finish();

 private:
  std::vector<double> errors_deg_;
  std::vector<double> sigmas_deg_;
};

}  // namespace polnav
