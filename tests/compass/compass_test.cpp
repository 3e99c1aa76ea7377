// The compass against skies it knows and skies it does not, through the simulated camera.
#include "nav/polarization/compass.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "nav/polarization/turn_calibration.h"
#include "sim/sensors/polarization_camera.h"
#include "sky/sun.h"
#include "tests/compass/sky_series.h"

namespace polnav::nav {
namespace {

constexpr double kSunAzimuth = 1.1;

sim::PolarizationCameraOptions PerfectCamera() {
  sim::PolarizationCameraOptions camera;
  camera.width_px = 320;
  camera.height_px = 256;
  camera.lens = "equidistant";
  camera.focal_px = 115.0;
  camera.gain_sigma = 0.0;
  camera.offset_sigma = 0.0;
  camera.polarizer_angle_sigma_deg = 0.0;
  camera.focal_sigma = 0.0;
  camera.center_sigma_px = 0.0;
  camera.mount_error_sigma_deg = 0.0;
  camera.flare = 0.0;
  camera.sky_step_px = 2;
  return camera;
}

sky::SkyOptions RayleighSky() {
  sky::SkyOptions sky;
  sky.clear.model = "rayleigh";
  sky.clouds = "clear";
  return sky;
}

struct Scene {
  sim::PolarizationCameraOptions camera = PerfectCamera();
  sky::SkyOptions sky = RayleighSky();
  double sun_elevation_rad = DegToRad(30.0);

  [[nodiscard]] Eigen::Vector3d Sun() const {
    return sky::DirectionEnu(kSunAzimuth, sun_elevation_rad);
  }
  [[nodiscard]] cv::Mat Picture(double heading, const Tilt& tilt = {}) const {
    const sky::WorldSky world(sky, Sun(), 7);
    return sim::PolarizationCamera(camera, world, 1, 0).Take(StandingAt(heading, tilt), 0).mosaic;
  }
  [[nodiscard]] CompassReading Read(double heading, const Tilt& told = {},
                                    const Tilt& tilt = {}) const {
    return Compass({}, sim::NominalPolarizationCamera(camera))
        .Read(Picture(heading, tilt), Sun(), told);
  }
};

double ErrorDeg(const CompassReading& reading, double heading) {
  return RadToDeg(WrapPi(reading.heading_rad - heading));
}

// Pixel noise of 0.014 / sqrt(0.5) over 80,000 pixels is 0.01 degrees.
TEST(Compass, FindsEveryHeadingUnderRayleighsSky) {
  for (const double elevation_deg : {10.0, 35.0, 65.0}) {
    Scene scene;
    scene.sun_elevation_rad = DegToRad(elevation_deg);
    for (double heading = -3.0; heading < 3.1; heading += 0.9) {
      const CompassReading reading = scene.Read(heading);
      ASSERT_EQ(reading.status, CompassStatus::kHeading) << StatusText(reading);
      EXPECT_NEAR(ErrorDeg(reading, heading), 0.0, 0.05) << elevation_deg << " " << heading;
    }
  }
}

// Neglected, a tilt eps about the sun's direction turns the heading by eps tan(h); told, it does
// not. A degree is small enough for the law to hold within a tenth.
TEST(Compass, ATiltTurnsTheHeadingByEpsTanHUnlessItIsTold) {
  for (const double elevation_deg : {15.0, 30.0, 45.0}) {
    Scene scene;
    scene.camera.full_well_e = 1e6;  // the law, not the noise
    scene.sun_elevation_rad = DegToRad(elevation_deg);
    // Heading at the sun: a roll tilts about the sun's azimuth.
    const Tilt roll{.roll_rad = DegToRad(1.0)};
    const double expected = std::tan(scene.sun_elevation_rad);
    EXPECT_NEAR(std::abs(ErrorDeg(scene.Read(kSunAzimuth, {}, roll), kSunAzimuth)), expected,
                0.1 * expected + 0.03);
    for (double heading = -3.0; heading < 3.1; heading += 1.2) {
      const Tilt tilt{.roll_rad = DegToRad(4.0), .pitch_rad = DegToRad(-3.0)};
      EXPECT_NEAR(ErrorDeg(scene.Read(heading, tilt, tilt), heading), 0.0, 0.02) << heading;
    }
  }
}

TEST(Compass, WithoutASunGivesTheMeridianInTheImage) {
  Scene scene;
  for (double heading = -3.0; heading < 3.1; heading += 1.1) {
    const CompassReading reading = Compass({}, sim::NominalPolarizationCamera(scene.camera))
                                       .Read(scene.Picture(heading), std::nullopt);
    ASSERT_EQ(reading.status, CompassStatus::kAxis) << StatusText(reading);
    // Heading is the sun's azimuth plus the axis.
    EXPECT_NEAR(RadToDeg(WrapHalfPi(reading.axis_rad - (heading - kSunAzimuth))), 0.0, 0.1);
  }
}

// A sun at the horizon and a narrow view: E-vectors of both headings are the same.
TEST(Compass, SaysWhenThePictureDoesNotTellTheHalfTurn) {
  Scene scene;
  scene.sun_elevation_rad = DegToRad(0.5);
  scene.camera.lens = "pinhole";
  scene.camera.focal_px = 1200.0;
  const CompassReading reading = scene.Read(0.4);
  EXPECT_EQ(reading.status, CompassStatus::kHalfTurn) << StatusText(reading);
  EXPECT_NEAR(RadToDeg(WrapHalfPi(reading.heading_rad - 0.4)), 0.0, 0.2);
}

TEST(Compass, RefusesWhatIsNoSky) {
  Scene scene;
  const PolarizationCameraCalibration camera = sim::NominalPolarizationCamera(scene.camera);
  const Compass compass({}, camera);
  const auto flat = [&](int grey) {
    return cv::Mat(camera.height_px, camera.width_px, CV_16UC1, cv::Scalar(grey));
  };
  EXPECT_EQ(compass.Read(flat(4095), scene.Sun()).reason, NoHeading::kSaturated);
  EXPECT_EQ(compass.Read(flat(0), scene.Sun()).reason, NoHeading::kDark);
  EXPECT_EQ(compass.Read(flat(2000), scene.Sun()).reason, NoHeading::kUnpolarized);
  EXPECT_EQ(compass.Read(scene.Picture(0.0), -scene.Sun()).reason, NoHeading::kSunBelow);
  EXPECT_EQ(compass.Read(scene.Picture(0.0), Eigen::Vector3d::UnitZ()).reason,
            NoHeading::kSunOverhead);
  EXPECT_THROW(static_cast<void>(compass.Read(cv::Mat(256, 320, CV_8UC1), scene.Sun())),
               std::invalid_argument);
  EXPECT_THROW(static_cast<void>(compass.Read(cv::Mat(100, 320, CV_16UC1), scene.Sun())),
               std::invalid_argument);
}

// A wall up to 35 degrees and more on one side is unpolarized: its blocks must not pull.
TEST(Compass, WallsDoNotPullTheHeading) {
  Scene scene;
  scene.camera.obstacles.mean_deg = 30.0;
  scene.camera.obstacles.roughness_deg = 12.0;
  for (double heading = -3.0; heading < 3.1; heading += 1.5) {
    EXPECT_NEAR(ErrorDeg(scene.Read(heading), heading), 0.0, 0.1) << heading;
  }
}

TEST(Compass, TheSamePictureGivesTheSameBits) {
  Scene scene;
  scene.sky.clouds = "many_clouds";
  const cv::Mat picture = scene.Picture(0.3);
  for (const char* method : {"zenith", "lsq", "ransac_tls", "stokes"}) {
    CompassOptions options;
    options.method = method;
    const PolarizationCameraCalibration camera = sim::NominalPolarizationCamera(scene.camera);
    const CompassReading a = Compass(options, camera).Read(picture, scene.Sun());
    const CompassReading b = Compass(options, camera).Read(picture, scene.Sun());
    EXPECT_EQ(a.heading_rad, b.heading_rad) << method;
    EXPECT_EQ(a.sigma_rad, b.sigma_rad) << method;
  }
}

// Every method is exact where its sky is true; zenith, lsq and ransac_tls give axes [Fan2020, eq.
// 19]. The zenith's patch is three blocks wide here and not centred to better than half a block,
// which is 1.5 degrees, of which tan(h) leans.
TEST(Compass, AllMethodsAgreeUnderRayleighsSky) {
  Scene scene;
  for (const char* method : {"zenith", "lsq", "ransac_tls", "stokes"}) {
    CompassOptions options;
    options.method = method;
    const Compass compass(options, sim::NominalPolarizationCamera(scene.camera));
    const CompassReading reading = compass.Read(scene.Picture(-2.0), scene.Sun());
    EXPECT_NE(reading.status, CompassStatus::kNone) << method << StatusText(reading);
    EXPECT_NEAR(RadToDeg(WrapHalfPi(reading.heading_rad + 2.0)), 0.0,
                std::string(method) == "zenith" ? 0.9 : 0.1)
        << method;
  }
}

// Errors of the four channels stay with the camera, so that on a turntable the heading's error is
// a sum of harmonics of the heading: gains give the second, unequal polarizers the fourth.
struct Harmonics {
  double second_deg = 0.0;
  double fourth_deg = 0.0;
  double rest_deg = 0.0;
};

Harmonics HarmonicsOf(const Scene& scene) {
  constexpr int kHeadings = 16;
  std::array<double, kHeadings> error{};
  CompassOptions options;
  options.method = "zenith";  // no weights: linear in the errors
  const Compass compass(options, sim::NominalPolarizationCamera(scene.camera));
  for (std::size_t k = 0; k < error.size(); ++k) {
    const double heading = WrapPi(2.0 * std::numbers::pi * static_cast<double>(k) / kHeadings);
    const CompassReading reading = compass.Read(scene.Picture(heading), scene.Sun());
    error[k] = RadToDeg(WrapHalfPi(reading.heading_rad - heading));
  }
  Harmonics result;
  double total = 0.0;
  double mean = 0.0;
  for (const double e : error) mean += e / kHeadings;
  const auto amplitude = [&](int n) {
    double c = 0.0;
    double s = 0.0;
    for (std::size_t k = 0; k < error.size(); ++k) {
      const double phase = 2.0 * std::numbers::pi * n * static_cast<double>(k) / kHeadings;
      c += 2.0 * error[k] * std::cos(phase) / kHeadings;
      s += 2.0 * error[k] * std::sin(phase) / kHeadings;
    }
    return std::hypot(c, s);
  };
  for (const double e : error) total += std::pow(e - mean, 2) / kHeadings;
  result.second_deg = amplitude(2);
  result.fourth_deg = amplitude(4);
  result.rest_deg = std::sqrt(std::max(
      0.0, total - 0.5 * std::pow(result.second_deg, 2) - 0.5 * std::pow(result.fourth_deg, 2)));
  return result;
}

TEST(PolarizationCamera, GainErrorsMakeTheSecondHarmonicAndAnglesTheFourth) {
  Scene scene;
  scene.camera.lens = "pinhole";
  scene.camera.focal_px = 600.0;  // many blocks in the zenith's patch
  scene.camera.full_well_e = 1e7;
  scene.camera.gain_sigma = 0.02;
  const Harmonics gains = HarmonicsOf(scene);
  scene.camera.gain_sigma = 0.0;
  scene.camera.polarizer_angle_sigma_deg = 2.0;
  const Harmonics angles = HarmonicsOf(scene);
  EXPECT_GT(gains.second_deg, 0.2);
  EXPECT_LT(gains.fourth_deg, 0.1 * gains.second_deg);
  EXPECT_LT(gains.rest_deg, 0.1 * gains.second_deg);
  EXPECT_GT(angles.fourth_deg, 0.2);
  EXPECT_LT(angles.rest_deg, 0.15 * angles.fourth_deg);
}

TEST(CalibrateFromTurn, RemovesMostOfTheInstrumentsError) {
  SeriesOptions series;
  series.camera = PerfectCamera();
  series.camera.gain_sigma = 0.01;
  series.camera.polarizer_angle_sigma_deg = 0.5;
  series.camera.mount_error_sigma_deg = 0.3;
  series.sky.clouds = "clear";
  const TurnCalibration turn =
      CalibrateFromTurn({}, sim::NominalPolarizationCamera(series.camera), TakeTurn(series, 3));
  ASSERT_TRUE(turn.before.heading_rad && turn.after.heading_rad);
  EXPECT_LT(*turn.after.heading_rad, 0.3 * *turn.before.heading_rad);
  EXPECT_LT(RadToDeg(*turn.after.heading_rad), 0.1);
  EXPECT_LT(turn.after.pairs, turn.before.pairs);
}

// Over instruments, what is left of the mounting's turn and the polarizers' common turn moves all
// headings alike, by their sum: the covariance must know what that sum does. Four instruments know
// a mean square to 71 %; three sigma of that above, and no less than a tenth.
TEST(CalibrateFromTurn, ItsCovarianceIsWhatIsLeft) {
  constexpr int kInstruments = 4;
  SeriesOptions series;
  series.camera = PerfectCamera();
  series.camera.gain_sigma = 0.01;
  series.camera.offset_sigma = 0.001;
  series.camera.polarizer_angle_sigma_deg = 0.5;
  series.camera.mount_error_sigma_deg = 0.3;
  series.camera.width_px /= 2;
  series.camera.height_px /= 2;
  series.camera.focal_px /= 2.0;
  series.sky.clouds = "clear";
  series.images_per_instrument = 1;
  double square = 0.0;
  for (int k = 0; k < kInstruments; ++k) {
    const auto index = static_cast<std::uint64_t>(k);
    const TurnCalibration turn = CalibrateFromTurn(
        {}, sim::NominalPolarizationCamera(series.camera), TakeTurn(series, index));
    const SkyShot shot = TakeShot(series, index);
    const CompassReading reading =
        Compass({}, turn.calibration).Read(shot.image.mosaic, shot.sun_W);
    ASSERT_EQ(reading.status, CompassStatus::kHeading);
    square += std::pow(WrapPi(reading.heading_rad - shot.heading_rad) / reading.sigma_rad, 2);
    // Far surer than beforehand, though not of what no picture tells.
    EXPECT_LT(turn.calibration.mount_sigma_rad, 0.5 * DegToRad(0.3));
  }
  EXPECT_LT(square / kInstruments, 1.0 + 3.0 * 0.71);
  EXPECT_GT(square / kInstruments, 0.1);
}

TEST(CalibrateFromTurn, NeedsATurn) {
  EXPECT_THROW(
      static_cast<void>(CalibrateFromTurn({}, sim::NominalPolarizationCamera(PerfectCamera()), {})),
      std::invalid_argument);
}

}  // namespace
}  // namespace polnav::nav
