// The Allan deviation of every preset is that of its parameters, within 5 percent.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "sim/sensors/imu.h"
#include "tests/sim/sensors/allan_deviation.h"

namespace polnav::sim {
namespace {

constexpr std::size_t kSamples = 100'000;
constexpr std::array kPresets = {"adis16475_2", "icm20602", "span_cpt", "hg4930"};

// In degrees per second and in milli-g.
struct Parameters {
  AllanParameters gyro;
  AllanParameters accel;
};

Parameters Of(const ImuOptions& o) {
  return {{o.gyro_noise_deg_s_sqrt_hz, o.gyro_bias_instability_deg_h / 3600.0,
           o.gyro_bias_walk_deg_s_sqrt_s, o.gyro_resolution_deg_s},
          {o.accel_noise_mg_sqrt_hz, o.accel_bias_instability_mg, o.accel_bias_walk_mg_sqrt_s,
           o.accel_resolution_mg}};
}

// At rest: three axes of the gyroscopes, three of the accelerometers.
std::array<std::vector<double>, 6> RecordAtRest(const ImuOptions& options,
                                                std::size_t samples = kSamples) {
  Imu imu(options, 1, 0);
  std::array<std::vector<double>, 6> axes;
  const nav::TimeNs step = nav::FromSeconds(1.0 / options.rate_hz);
  Truth begin;
  Truth end;
  for (std::size_t k = 0; k < samples; ++k) {
    begin.stamp = static_cast<nav::TimeNs>(k) * step;
    end.stamp = begin.stamp + step;
    const nav::ImuSample sample = imu.Sample(begin, end, k);
    for (std::size_t i = 0; i < 3; ++i) {
      const auto axis = static_cast<Eigen::Index>(i);
      axes[i].push_back(nav::RadToDeg(sample.gyro_rad_s[axis]));
      axes[i + 3].push_back(sample.accel_m_s2[axis] / (1e-3 * kGravity_m_s2));
    }
  }
  return axes;
}

double DeviationOfThree(const std::vector<double>* axes, std::size_t m) {
  double variance = 0.0;
  for (int i = 0; i < 3; ++i) variance += AllanVariance(axes[i], m) / 3.0;
  return std::sqrt(variance);
}

// Means over m of 100 000 samples, three axes: some 300 000 / m independent differences, a
// deviation to the root of m / 600 000; tolerance four of these, and 1 percent for neighbours that
// overlap. Three rates take the curve from 10 ms to 3000 s: white noise, floor and beyond. The slow
// ones are without the converter's steps, which then would be larger than the noise.
void ExpectTheCurve(const std::string& preset) {
  for (const double rate_hz : {100.0, 1.0, 0.01}) {
    ImuOptions options = ImuPreset(preset);
    options.rate_hz = rate_hz;
    if (rate_hz < 100.0) options.gyro_resolution_deg_s = options.accel_resolution_mg = 0.0;
    const Parameters parameters = Of(options);
    const auto axes = RecordAtRest(options);
    for (const std::size_t m : {1U, 3U, 10U, 30U}) {
      const double gyro = ModelAllanDeviation(parameters.gyro, 1.0 / rate_hz, m);
      const double accel = ModelAllanDeviation(parameters.accel, 1.0 / rate_hz, m);
      const double tolerance = 0.01 + 4.0 * std::sqrt(static_cast<double>(m) / 600'000.0);
      EXPECT_NEAR(DeviationOfThree(&axes[0], m) / gyro, 1.0, tolerance) << rate_hz << " Hz " << m;
      EXPECT_NEAR(DeviationOfThree(&axes[3], m) / accel, 1.0, tolerance) << rate_hz << " Hz " << m;
    }
  }
}

TEST(ImuAllan, Adis16475) { ExpectTheCurve("adis16475_2"); }
TEST(ImuAllan, Icm20602) { ExpectTheCurve("icm20602"); }
TEST(ImuAllan, SpanCpt) { ExpectTheCurve("span_cpt"); }
TEST(ImuAllan, Hg4930) { ExpectTheCurve("hg4930"); }

// The walk alone, where nothing else hides it; 0.5 percent of m = 10 is the discrete walk's own.
TEST(ImuAllan, TheBiasWalksAsFastAsAsked) {
  for (const char* preset : kPresets) {
    ImuOptions options = ImuPreset(preset);
    options.rate_hz = 0.001;
    options.gyro_resolution_deg_s = options.accel_resolution_mg = 0.0;
    options.gyro_noise_deg_s_sqrt_hz = options.accel_noise_mg_sqrt_hz = 0.0;
    options.gyro_bias_instability_deg_h = options.accel_bias_instability_mg = 0.0;
    const auto axes = RecordAtRest(options);
    const double root_tau_3 = std::sqrt(10.0 / options.rate_hz / 3.0);
    EXPECT_NEAR(DeviationOfThree(&axes[0], 10) / root_tau_3 / options.gyro_bias_walk_deg_s_sqrt_s,
                1.0, 0.05);
    EXPECT_NEAR(DeviationOfThree(&axes[3], 10) / root_tau_3 / options.accel_bias_walk_mg_sqrt_s,
                1.0, 0.05);
  }
}

// What a user would do: record 4000 s at 100 Hz, and hold the curve against the textbook's lines.
// 12 000 differences at 1 s: a deviation to 0.7 percent. The 16-bit steps of adis16475_2 add 4.1
// percent to its accelerometers' noise.
TEST(ImuAllan, ARecordingIsWithinFivePercentOfTheParameters) {
  for (const char* preset : kPresets) {
    const Parameters parameters = Of(ImuPreset(preset));
    const auto axes = RecordAtRest(ImuPreset(preset), 400'000);
    for (const std::size_t m : {1U, 3U, 10U, 30U, 100U}) {
      const double tau_s = 0.01 * static_cast<double>(m);
      EXPECT_NEAR(DeviationOfThree(&axes[0], m) / parameters.gyro.TextbookDeviation(tau_s), 1.0,
                  0.05)
          << preset << " " << tau_s << " s";
      EXPECT_NEAR(DeviationOfThree(&axes[3], m) / parameters.accel.TextbookDeviation(tau_s), 1.0,
                  0.05)
          << preset << " " << tau_s << " s";
    }
  }
}

// Without a sample: the model's curve against the textbook's three lines, from 10 ms to a day.
TEST(ImuAllan, TheModelIsTheTextbooksLines) {
  for (const char* preset : kPresets) {
    const Parameters parameters = Of(ImuPreset(preset));
    for (const AllanParameters& p : {parameters.gyro, parameters.accel}) {
      for (double tau_s = 0.01; tau_s < 1e5; tau_s *= 1.2) {
        EXPECT_NEAR(ModelAllanDeviation(p, tau_s) / p.TextbookDeviation(tau_s), 1.0, 0.05)
            << preset << " " << tau_s << " s";
      }
    }
  }
}

// So that the two say the same at the rate people use, converter's steps included.
TEST(ImuAllan, AHundredSamplesASecondAreEnough) {
  for (const char* preset : kPresets) {
    const Parameters parameters = Of(ImuPreset(preset));
    for (const AllanParameters& p : {parameters.gyro, parameters.accel}) {
      for (const std::size_t m : {1U, 10U, 100U, 1000U, 10000U}) {
        const double tau_s = 0.01 * static_cast<double>(m);
        EXPECT_NEAR(ModelAllanDeviation(p, 0.01, m) / ModelAllanDeviation(p, tau_s), 1.0, 0.05)
            << preset << " " << tau_s << " s";
      }
    }
  }
}

TEST(ImuAllan, TheLowestPointIsTheDataSheetsInRunBiasStability) {
  const auto lowest = [](const AllanParameters& p) {
    double least = 1e9;
    for (double tau_s = 1.0; tau_s < 1e5; tau_s *= 1.1) {
      least = std::min(least, ModelAllanDeviation(p, tau_s));
    }
    return least;
  };
  const Parameters adis = Of(ImuPreset("adis16475_2"));
  EXPECT_NEAR(lowest(adis.gyro) * 3600.0, 2.5, 0.05 * 2.5);
  EXPECT_NEAR(lowest(adis.accel), 0.0036, 0.05 * 0.0036);
  const Parameters hg4930 = Of(ImuPreset("hg4930"));
  EXPECT_NEAR(lowest(hg4930.gyro) * 3600.0, 0.25, 0.05 * 0.25);
  EXPECT_NEAR(lowest(hg4930.accel), 0.025, 0.05 * 0.025);
}

}  // namespace
}  // namespace polnav::sim
