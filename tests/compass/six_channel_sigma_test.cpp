// How well does the six-channel sensor know the angle of polarization?
//
// For polarizers evenly spaced over half a turn, a fit's Q and U carry sqrt(2) times the noise of
// its intensity, and the angle half of theirs over the degree d: sigma_angle = sigma / (sqrt(2) d),
// sigma being the intensity's noise over the intensity, however many channels there are. Both
// sides are taken here from the same readings of the simulated sensor.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "nav/polarization/six_channel.h"
#include "sim/sensors/polarimeter.h"
#include "sky/sun.h"
#include "tests/compass/sky_series.h"

namespace polnav {
namespace {

struct Spread {
  double intensity = 0.0;  // over the intensity
  double angle_rad = 0.0;
  double dop = 0.0;  // mean
};

Spread SpreadUnder(double max_dop, double heading_rad) {
  constexpr int kReadings = 50000;
  sky::SkyOptions options;
  options.clouds = "clear";
  options.clear.max_dop = max_dop;
  const sky::WorldSky world(options, sky::DirectionEnu(1.0, nav::DegToRad(10.0)), 1);
  sim::PolarimeterOptions sensor;
  sensor.channel_sigma = 0.004;
  sensor.bits = 24;  // steps of a converter are no white noise
  sensor.gain_sigma = 0.0;
  sensor.polarizer_angle_sigma_deg = 0.0;
  sensor.mount_error_sigma_deg = 0.0;
  const sim::Polarimeter polarimeter(sensor, world, 7, 0);
  sensor.channel_sigma = 0.0;
  const sim::Truth standing = StandingAt(heading_rad);
  const auto truth =
      nav::DecodeSixChannels(sim::Polarimeter(sensor, world, 7, 0).Sample(standing, 0));
  Spread spread;
  double sum = 0.0;
  double squares = 0.0;
  for (int i = 0; i < kReadings; ++i) {
    const auto sample = polarimeter.Sample(standing, static_cast<std::uint64_t>(i));
    double intensity = 0.0;
    for (const double channel : sample.channel) intensity += channel / 6.0;
    sum += intensity;
    squares += intensity * intensity;
    const auto light = nav::DecodeSixChannels(sample);
    spread.dop += light->dop / kReadings;
    spread.angle_rad += std::pow(nav::WrapHalfPi(light->axis_rad - truth->axis_rad), 2) / kReadings;
  }
  const double mean = sum / kReadings;
  spread.intensity = std::sqrt(squares / kReadings - mean * mean) / mean;
  spread.angle_rad = std::sqrt(spread.angle_rad);
  return spread;
}

// 50,000 readings know each deviation to 0.32 %. That noise grows with a channel's reading, and
// that the sensor divides pairs, adds d^2 / 4 at most: 0.6 % at the greater degree.
TEST(SixChannelSensor, SigmaOfTheAngleIsTheIntensitysOverRootTwoAndTheDegree) {
  for (const double max_dop : {0.08, 0.16}) {
    for (const double heading_rad : {0.3, 1.2}) {
      const Spread spread = SpreadUnder(max_dop, heading_rad);
      const double expected = spread.intensity / (std::sqrt(2.0) * spread.dop);
      EXPECT_NEAR(spread.angle_rad, expected, 0.02 * expected) << max_dop << ' ' << heading_rad;
    }
  }
}

}  // namespace
}  // namespace polnav
