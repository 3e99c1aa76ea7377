#include "tests/compass/sky_series.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/random.h"
#include "sky/sun.h"
#include "tools/testbed/calibration_turn.h"

namespace polnav {

sim::Truth StandingAt(double heading_rad, const nav::Tilt& tilt) {
  sim::Truth truth;
  truth.T_WB.q = nav::LevelAttitude(heading_rad) * nav::LevelFromBody(tilt);
  return truth;
}

SkyShot TakeShot(const SeriesOptions& options, std::uint64_t index) {
  sim::RandomStream::Sample draw = sim::RandomStream(options.seed, 0, "compass/protocol").At(index);
  SkyShot shot;
  shot.sun_elevation_rad = nav::DegToRad(10.0 + 50.0 * draw.Uniform());
  const double sun_azimuth = 2.0 * std::numbers::pi * draw.Uniform();
  shot.heading_rad = nav::WrapPi(2.0 * std::numbers::pi * draw.Uniform());
  const std::uint64_t clouds = (static_cast<std::uint64_t>(draw.Bits()) << 32U) | draw.Bits();
  shot.sun_W = sky::DirectionEnu(sun_azimuth, shot.sun_elevation_rad);
  const sky::WorldSky sky(options.sky, shot.sun_W, clouds);
  const std::uint64_t instrument =
      index / static_cast<std::uint64_t>(options.images_per_instrument);
  const sim::PolarizationCamera camera(options.camera, sky, options.seed, instrument);
  shot.image = camera.Take(StandingAt(shot.heading_rad), index);
  return shot;
}

std::vector<nav::TurnPicture> TakeTurn(const SeriesOptions& options, std::uint64_t instrument) {
  return testbed::TakeCalibrationTurn(options.camera, options.sky, options.seed, instrument);
}

void SeriesScore::Add(const nav::CompassReading& reading, double heading_rad) {
  ++images;
  if (reading.status == nav::CompassStatus::kNone) {
    ++refused;
    return;
  }
  double error = nav::WrapPi(reading.heading_rad - heading_rad);
  if (reading.status == nav::CompassStatus::kHalfTurn) {
    ++half_turns;
    error = nav::WrapHalfPi(error);
  } else {
    ++headings;
  }
  errors_deg_.push_back(nav::RadToDeg(error));
  sigmas_deg_.push_back(nav::RadToDeg(reading.sigma_rad));
}

void SeriesScore::Finish() {
  if (errors_deg_.empty()) return;
  const auto count = static_cast<double>(errors_deg_.size());
  for (std::size_t i = 0; i < errors_deg_.size(); ++i) {
    const double ratio = errors_deg_[i] / sigmas_deg_[i];
    mean_deg += errors_deg_[i] / count;
    rmse_deg += errors_deg_[i] * errors_deg_[i] / count;
    nees += ratio * ratio / count;
    if (std::abs(ratio) > 5.0) ++beyond_5_sigma;
    worst_deg = std::max(worst_deg, std::abs(errors_deg_[i]));
  }
  std_deg = std::sqrt(std::max(0.0, rmse_deg - mean_deg * mean_deg));
  rmse_deg = std::sqrt(rmse_deg);
  const auto middle = sigmas_deg_.begin() + static_cast<std::ptrdiff_t>(sigmas_deg_.size() / 2);
  std::nth_element(sigmas_deg_.begin(), middle, sigmas_deg_.end());
  median_sigma_deg = *middle;
}

}  // namespace polnav
