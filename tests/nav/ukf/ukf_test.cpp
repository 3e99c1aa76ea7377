// The walker's filter on streams made by hand: a robot that stands below a Rayleigh sky.
#include "nav/ukf/ukf.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "nav/inertial/options.h"
#include "nav/polarization/sky_heading.h"
#include "nav/ukf/paper_ukf.h"

namespace polnav::nav {
namespace {

constexpr TimeNs kMs = 1'000'000;
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

Eigen::Vector3d Sun(TimeNs) { return Eigen::Vector3d(-0.6, -0.5, 0.4).normalized(); }

ImuSample Imu(TimeNs stamp) {
  return {.stamp = stamp, .gyro_rad_s = {0.0, 0.0, 0.0}, .accel_m_s2 = {0.0, 0.0, kGravity_m_s2}};
}

OpticalFlowSample Flow(TimeNs stamp) {
  return {.stamp = stamp, .integration = 20 * kMs, .range_m = 0.4, .quality = 1.0};
}

// Heading north. The brightness changes a little, as it does: equal readings are a frozen driver.
PolarizationSample Light(TimeNs stamp, double dop) {
  const Eigen::Vector3d e_W = Sun(stamp).cross(Eigen::Vector3d::UnitZ()).normalized();
  const Eigen::Vector3d e_B = LevelAttitude(0.0).conjugate() * e_W;
  const double phi = std::atan2(e_B.y(), e_B.x());
  PolarizationSample sample{.stamp = stamp};
  constexpr std::array<double, 6> kAngles_deg = {0, 90, 60, 150, 120, 210};
  const double brightness = 0.5 + 1e-4 * static_cast<double>(stamp / kMs % 977) / 977.0;
  for (std::size_t i = 0; i < 6; ++i) {
    sample.channel[i] =
        brightness * (1.0 + dop * std::cos(2.0 * phi - 2.0 * DegToRad(kAngles_deg[i])));
  }
  return sample;
}

ImuCalibration ImuSheet() {
  return {.rate_hz = 100.0,
          .gyro_noise_rad_s_sqrt_hz = 7e-5,
          .accel_noise_m_s2_sqrt_hz = 1e-3,
          .gyro_bias_sigma_rad_s = 0.02,
          .accel_bias_sigma_m_s2 = 0.4,
          .gyro_bias_instability_rad_s = 4e-5,
          .accel_bias_instability_m_s2 = 5e-4};
}

OpticalFlowCalibration FlowSheet() {
  return {.T_BF = {Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0), {0.2, 0.0, 0.3}},
          .rate_hz = 50.0,
          .flow_noise_rad_s_sqrt_hz = 1.5e-4,
          .flow_scale_sigma = 0.01,
          .mount_sigma_rad = 0.005,
          .range_sigma_m = 0.003,
          .range_min_m = 0.3,
          .range_max_m = 5.0};
}

Ukf Filter() {
  return {UkfOptions{}, ImuSheet(), FlowSheet(),
          StartPrior{.position_sigma_m = 0.001,
                     .heading_rad = DegToRad(2.0),
                     .heading_sigma_rad = DegToRad(2.0),
                     .level_sigma_rad = DegToRad(1.0)},
          SkySource{PolarizationOptions{}, PolarimeterCalibration{}, Sun}};
}

// From one time to another; dop 0: without light. late: of flow and light.
void Stand(Ukf& ukf, TimeNs from, TimeNs to, double dop, TimeNs late = 0) {
  for (TimeNs t = from + 10 * kMs; t <= to; t += 10 * kMs) {
    (void)ukf.Process(Imu(t));
    const TimeNs seen = t - late;
    if (seen <= from) continue;
    if (seen % (20 * kMs) == 0) (void)ukf.Process(Flow(seen));
    if (dop > 0.0 && seen % (50 * kMs) == 0) (void)ukf.Process(Light(seen, dop));
  }
}

double HeadingSigmaOf(const Ukf& ukf) { return std::sqrt(ukf.Now()->covariance(5, 5)); }

TEST(Ukf, FindsTheHeadingWhereTheSkyIs) {
  Ukf ukf = Filter();
  Stand(ukf, 0, 5 * kNsPerSecond, 0.6);
  // The sky's own slow error of some half a degree stays.
  EXPECT_NEAR(CompassHeading(ukf.Now()->T_WB.q), 0.0, 3.0 * HeadingSigmaOf(ukf));
  EXPECT_LT(HeadingSigmaOf(ukf), DegToRad(1.0));
}

// What comes late by less than max_delay_s makes no difference once it has come.
TEST(Ukf, LateReadingsArePutWhereTheyBelong) {
  Ukf on_time = Filter();
  Ukf late = Filter();
  Stand(on_time, 0, 4 * kNsPerSecond, 0.6);
  Stand(late, 0, 4 * kNsPerSecond, 0.6, 60 * kMs);
  for (TimeNs t = 4 * kNsPerSecond - 50 * kMs; t <= 4 * kNsPerSecond; t += 10 * kMs) {
    if (t % (20 * kMs) == 0) {
      EXPECT_EQ(late.Process(Flow(t)).outcome, Outcome::kUsed);
    }
    if (t % (50 * kMs) == 0) {
      EXPECT_EQ(late.Process(Light(t, 0.6)).outcome, Outcome::kUsed);
    }
  }
  const Estimate a = *on_time.Now();
  const Estimate b = *late.Now();
  EXPECT_LT((a.T_WB.p - b.T_WB.p).norm(), 1e-6);
  EXPECT_LT(a.T_WB.q.angularDistance(b.T_WB.q), 1e-6);
  EXPECT_LT((a.covariance - b.covariance).norm(), 1e-6 * a.covariance.norm());
  EXPECT_EQ(late.Process(Flow(3 * kNsPerSecond)).outcome, Outcome::kUnusable);  // too late
}

TEST(Ukf, ReadingsThatAreNoNumbersChangeNothing) {
  Ukf ukf = Filter();
  Stand(ukf, 0, 2 * kNsPerSecond, 0.6);
  const Estimate before = *ukf.Now();
  const TimeNs next = 2 * kNsPerSecond + 10 * kMs;
  ImuSample imu = Imu(next);
  imu.gyro_rad_s.y() = kNan;
  EXPECT_EQ(ukf.Process(imu).outcome, Outcome::kUnusable);
  imu = Imu(next);
  imu.accel_m_s2.z() = std::numeric_limits<double>::infinity();
  EXPECT_EQ(ukf.Process(imu).outcome, Outcome::kUnusable);
  OpticalFlowSample flow = Flow(next);
  flow.flow_rad.x() = kNan;
  EXPECT_EQ(ukf.Process(flow).outcome, Outcome::kUnusable);
  flow = Flow(next);
  flow.range_m = kNan;
  EXPECT_EQ(ukf.Process(flow).outcome, Outcome::kUnusable);
  PolarizationSample light = Light(next, 0.6);
  light.channel[3] = kNan;
  EXPECT_EQ(ukf.Process(light).outcome, Outcome::kUnusable);
  EXPECT_EQ(ukf.Now()->T_WB.p, before.T_WB.p);
  EXPECT_EQ(ukf.Now()->covariance, before.covariance);
  Stand(ukf, 2 * kNsPerSecond, 3 * kNsPerSecond, 0.6);
  EXPECT_TRUE(ukf.Now()->T_WB.p.allFinite());
  EXPECT_TRUE(ukf.Now()->covariance.allFinite());
}

// The paper's filter on the same streams: no reading that is no number reaches what it answers.
TEST(PaperUkf, ReadingsThatAreNoNumbersChangeNothing) {
  const auto answer = [](bool nonsense) {
    PaperUkf ukf({}, ImuSheet(), FlowSheet(), StartPrior{.heading_sigma_rad = DegToRad(2.0)},
                 SkySource{PolarizationOptions{}, PolarimeterCalibration{}, Sun});
    std::optional<Estimate> last;
    for (TimeNs t = 10 * kMs; t <= 3 * kNsPerSecond; t += 10 * kMs) {
      if (nonsense && t % (70 * kMs) == 0) {
        ImuSample imu = Imu(t - kMs);
        imu.accel_m_s2.x() = kNan;
        EXPECT_EQ(ukf.Process(imu).outcome, Outcome::kUnusable);
        OpticalFlowSample flow = Flow(t - kMs);
        flow.flow_rad.y() = kNan;
        EXPECT_EQ(ukf.Process(flow).outcome, Outcome::kUnusable);
        PolarizationSample light = Light(t - kMs, 0.6);
        light.channel[0] = kNan;
        EXPECT_EQ(ukf.Process(light).outcome, Outcome::kUnusable);
      }
      const Report report = ukf.Process(Imu(t));
      if (report.estimate) last = report.estimate;
      if (t % (20 * kMs) == 0) (void)ukf.Process(Flow(t));
      if (t % (50 * kMs) == 0) (void)ukf.Process(Light(t, 0.6));
    }
    return last.value();
  };
  const Estimate sound = answer(false);
  const Estimate with = answer(true);
  EXPECT_TRUE(with.covariance.allFinite());
  EXPECT_EQ(with.T_WB.p, sound.T_WB.p);
  EXPECT_EQ(with.covariance, sound.covariance);
}

// Ten seconds below something that hides the sky: the heading becomes less certain, and finds back
// within five.
TEST(Ukf, WithoutTheSkyTheHeadingGetsDoubtfulAndComesBack) {
  Ukf ukf = Filter();
  Stand(ukf, 0, 10 * kNsPerSecond, 0.6);
  const double clear = HeadingSigmaOf(ukf);
  Stand(ukf, 10 * kNsPerSecond, 40 * kNsPerSecond, 0.02);  // no degree of polarization to speak of
  EXPECT_GT(HeadingSigmaOf(ukf), 1.01 * clear);
  Stand(ukf, 40 * kNsPerSecond, 45 * kNsPerSecond, 0.6);
  EXPECT_LT(HeadingSigmaOf(ukf), 1.1 * clear);
  EXPECT_NEAR(CompassHeading(ukf.Now()->T_WB.q), 0.0, 3.0 * HeadingSigmaOf(ukf));
}

TEST(Ukf, ANegativeSigmaIsNamed) {
  OpticalFlowCalibration flow = FlowSheet();
  flow.range_sigma_m = -0.003;
  try {
    const Ukf ukf(UkfOptions{}, ImuSheet(), flow, StartPrior{}, std::nullopt);
    FAIL();
  } catch (const std::invalid_argument& error) {
    EXPECT_NE(std::string(error.what()).find("range_sigma_m"), std::string::npos);
  }
}

}  // namespace
}  // namespace polnav::nav
