// What arrives of a stream under each fault, and in which order. No simulator anywhere.
#include "sim/faults/fault_injector.h"

#include <gtest/gtest.h>

#include <cmath>
#include <opencv2/core.hpp>

namespace polnav::sim {
namespace {

using nav::ImuSample;
using nav::Measurement;
using nav::TimeNs;

constexpr TimeNs kStep = nav::kNsPerSecond / 10;

FaultOptions Fault(const std::string& sensor, double start_s, std::optional<double> duration_s) {
  FaultOptions fault;
  fault.sensor = sensor;
  fault.start_s = start_s;
  fault.duration_s = duration_s;
  return fault;
}

// Ten readings a second: the k-th IMU sample feels k m/s^2 ahead, the polarimeter reads 0.3.
std::vector<Measurement> Recording(int samples) {
  std::vector<Measurement> all;
  for (int k = 0; k < samples; ++k) {
    all.emplace_back(ImuSample{.stamp = k * kStep, .accel_m_s2 = {1.0 * k, 0.0, 9.8}});
    all.emplace_back(
        nav::PolarizationSample{.stamp = k * kStep, .channel = {0.3, 0.3, 0.3, 0.3, 0.3, 0.3}});
  }
  return all;
}

std::vector<Measurement> After(const std::vector<FaultOptions>& faults,
                               const std::vector<Measurement>& recording, std::uint64_t seed = 1) {
  nav::Rig rig;
  rig.imu = nav::ImuCalibration{
      .rate_hz = 10.0, .gyro_noise_rad_s_sqrt_hz = 1e-3, .accel_noise_m_s2_sqrt_hz = 1e-2};
  FaultInjector injector(faults, rig, seed, 0);
  std::vector<Measurement> arrived;
  for (const Measurement& m : recording) {
    for (const Measurement& a : injector.Take(m)) arrived.push_back(a);
  }
  for (const Measurement& a : injector.Flush()) arrived.push_back(a);
  return arrived;
}

template <typename T>
std::vector<T> Only(const std::vector<Measurement>& all) {
  std::vector<T> some;
  for (const Measurement& m : all) {
    if (const auto* wanted = std::get_if<T>(&m)) some.push_back(*wanted);
  }
  return some;
}

std::vector<int> Stamps(const std::vector<ImuSample>& samples) {
  std::vector<int> steps;
  for (const ImuSample& s : samples) steps.push_back(static_cast<int>(s.stamp / kStep));
  return steps;
}

std::vector<ImuSample> ImuAfter(const FaultOptions& fault, int samples, std::uint64_t seed = 1) {
  return Only<ImuSample>(After({fault}, Recording(samples), seed));
}

TEST(FaultInjector, WithoutFaultsIsTransparent) {
  const auto recording = Recording(20);
  const auto arrived = After({}, recording);
  ASSERT_EQ(arrived.size(), recording.size());
  for (std::size_t i = 0; i < arrived.size(); ++i) {
    EXPECT_EQ(arrived[i].index(), recording[i].index());
    EXPECT_EQ(nav::StampOf(arrived[i]), nav::StampOf(recording[i]));
  }
}

TEST(FaultInjector, OffLeavesAHoleFromStartToBeforeTheEnd) {
  FaultOptions fault = Fault("imu", 0.3, 0.4);
  fault.off.emplace();
  EXPECT_EQ(Stamps(ImuAfter(fault, 10)), (std::vector<int>{0, 1, 2, 7, 8, 9}));
  fault.duration_s.reset();
  EXPECT_EQ(Stamps(ImuAfter(fault, 10)), (std::vector<int>{0, 1, 2}));
}

TEST(FaultInjector, StuckRepeatsTheReadingBeforeWithNewStamps) {
  FaultOptions fault = Fault("imu", 0.3, 0.3);
  fault.stuck.emplace();
  const auto imu = ImuAfter(fault, 8);
  ASSERT_EQ(imu.size(), 8U);
  for (int k = 0; k < 8; ++k) {
    EXPECT_EQ(imu[static_cast<std::size_t>(k)].stamp, k * kStep);
    const double expected = k >= 3 && k < 6 ? 2.0 : k;
    EXPECT_EQ(imu[static_cast<std::size_t>(k)].accel_m_s2.x(), expected) << k;
  }
}

TEST(FaultInjector, BiasIsAStep) {
  FaultOptions fault = Fault("imu", 0.5, 0.2);
  fault.bias = BiasFault{.gyro_deg_s = {0.5, 0.0, 0.0}};
  const auto imu = ImuAfter(fault, 10);
  for (std::size_t k = 0; k < 10; ++k) {
    const double expected = k == 5 || k == 6 ? nav::DegToRad(0.5) : 0.0;
    EXPECT_NEAR(imu[k].gyro_rad_s.x(), expected, 1e-15) << k;
  }
}

TEST(FaultInjector, DriftHasItsSlope) {
  FaultOptions fault = Fault("imu", 1.0, std::nullopt);
  fault.drift.emplace();
  fault.drift->gyro_deg_s = {0.0, 2.0, 0.0};
  fault.drift->over_s = 4.0;
  const auto imu = ImuAfter(fault, 100);
  for (std::size_t k = 0; k < 100; ++k) {
    const double since_s = std::max(0.0, 0.1 * static_cast<double>(k) - 1.0);
    EXPECT_NEAR(imu[k].gyro_rad_s.y(), nav::DegToRad(0.5) * since_s, 1e-12) << k;
  }
}

TEST(FaultInjector, NoiseIsWhiteAndOnlyWhileItLasts) {
  FaultOptions fault = Fault("imu", 100.0, 1000.0);
  fault.noise.emplace();
  fault.noise->gyro_deg_s = {0.0, 0.0, 1.0};
  const auto imu = ImuAfter(fault, 12000);
  double squares = 0.0;
  double products = 0.0;
  for (std::size_t k = 0; k < imu.size(); ++k) {
    const double z = nav::RadToDeg(imu[k].gyro_rad_s.z());
    if (k < 1000 || k >= 11000) {
      EXPECT_EQ(z, 0.0);
      continue;
    }
    squares += z * z;
    products += z * nav::RadToDeg(imu[k - 1].gyro_rad_s.z());
  }
  constexpr double kN = 10000.0;
  EXPECT_NEAR(squares / kN, 1.0, 4.0 * std::sqrt(2.0 / kN));
  EXPECT_NEAR(products / kN, 0.0, 4.0 / std::sqrt(kN));
  EXPECT_EQ(imu[5000].gyro_rad_s.x(), 0.0);
}

TEST(FaultInjector, DropLosesItsShare) {
  FaultOptions fault = Fault("imu", 0.0, std::nullopt);
  fault.drop = DropFault{.probability = 0.3};
  const auto kept = static_cast<double>(ImuAfter(fault, 10000).size());
  EXPECT_NEAR(kept, 7000.0, 4.0 * std::sqrt(10000.0 * 0.3 * 0.7));
}

TEST(FaultInjector, DelayChangesTheOrderButNoStamp) {
  FaultOptions fault = Fault("imu", 0.0, std::nullopt);
  fault.delay = DelayFault{.delay_s = 0.25};
  const auto arrived = After({fault}, Recording(6));
  // IMU sample k arrives at (k + 2.5) steps: after polarimeter k + 2, before k + 3.
  std::vector<std::string> order;
  for (const Measurement& m : arrived) {
    order.push_back((std::holds_alternative<ImuSample>(m) ? "i" : "p") +
                    std::to_string(nav::StampOf(m) / kStep));
  }
  EXPECT_EQ(order, (std::vector<std::string>{"p0", "p1", "p2", "i0", "p3", "i1", "p4", "i2", "p5",
                                             "i3", "i4", "i5"}));
}

TEST(FaultInjector, WhenTheDelayEndsTheLateOnesAreOvertaken) {
  FaultOptions fault = Fault("imu", 0.0, 0.2);
  fault.delay = DelayFault{.delay_s = 0.35};
  EXPECT_EQ(Stamps(ImuAfter(fault, 6)), (std::vector<int>{2, 3, 0, 4, 1, 5}));
}

TEST(FaultInjector, ReorderHoldsSomeBackAndLosesNone) {
  FaultOptions fault = Fault("imu", 0.0, std::nullopt);
  fault.reorder = ReorderFault{.probability = 0.3, .hold_s = 0.25};
  const auto imu = ImuAfter(fault, 2000);
  ASSERT_EQ(imu.size(), 2000U);
  int late = 0;
  TimeNs newest = -1;
  for (const ImuSample& s : imu) {
    if (s.stamp < newest) ++late;
    newest = std::max(newest, s.stamp);
    EXPECT_EQ(s.accel_m_s2.x(), static_cast<double>(s.stamp / kStep));  // each keeps its own stamp
  }
  // Held and overtaken: itself held (0.3) and one of the next two not (1 - 0.09). Neighbours are
  // not independent; twice the binomial sigma allows for that.
  EXPECT_NEAR(late, 2000.0 * 0.3 * 0.91, 2.0 * 4.0 * std::sqrt(2000.0 * 0.273 * 0.727));
}

TEST(FaultInjector, DuplicatesFollowAtOnce) {
  FaultOptions fault = Fault("imu", 0.1, 0.2);
  fault.duplicate = DuplicateFault{.copies = 2};
  const auto imu = ImuAfter(fault, 4);
  EXPECT_EQ(Stamps(imu), (std::vector<int>{0, 1, 1, 1, 2, 2, 2, 3}));
  EXPECT_EQ(imu[1].accel_m_s2, imu[3].accel_m_s2);
}

TEST(FaultInjector, ClockErrorGrowsWithItsSkew) {
  FaultOptions fault = Fault("imu", 1.0, std::nullopt);
  fault.clock = ClockFault{.offset_s = -0.5, .skew_ppm = 200.0};
  const auto imu = ImuAfter(fault, 50);
  for (int k = 0; k < 50; ++k) {
    const TimeNs error = imu[static_cast<std::size_t>(k)].stamp - k * kStep;
    // 200 ppm of a tenth of a second are 20 us.
    EXPECT_EQ(error, k < 10 ? 0 : -nav::kNsPerSecond / 2 + (k - 10) * 20'000) << k;
    EXPECT_EQ(imu[static_cast<std::size_t>(k)].accel_m_s2.x(), k);
  }
}

TEST(FaultInjector, ADeadChannelReadsTheSameWhateverTheLight) {
  FaultOptions fault = Fault("polarimeter", 0.1, 0.1);
  fault.dead_channel = DeadChannelFault{.channel = 4, .level = 0.02};
  const auto light = Only<nav::PolarizationSample>(After({fault}, Recording(3)));
  EXPECT_EQ(light[0].channel[4], 0.3);
  EXPECT_EQ(light[1].channel[4], 0.02);
  EXPECT_EQ(light[1].channel[3], 0.3);
  EXPECT_EQ(light[2].channel[4], 0.3);
}

TEST(FaultInjector, ADeadPixelOfEachCell) {
  FaultOptions fault = Fault("polarization_camera", 0.0, std::nullopt);
  fault.dead_channel = DeadChannelFault{.channel = 3};
  const cv::Mat mosaic(4, 6, CV_8UC1, cv::Scalar(90));
  const auto sky =
      Only<nav::PolarizationImage>(After({fault}, {nav::PolarizationImage{0, mosaic}}));
  EXPECT_EQ(cv::countNonZero(sky[0].mosaic), 18);
  EXPECT_EQ(sky[0].mosaic.at<std::uint8_t>(3, 5), 0);
  EXPECT_EQ(cv::countNonZero(mosaic), 24);
}

TEST(FaultInjector, AFrozenPairAndABlackSide) {
  std::vector<Measurement> recording;
  for (int k = 0; k < 6; ++k) {
    const cv::Mat image(4, 4, CV_8UC1, cv::Scalar(10 + k));
    recording.push_back(nav::StereoImages{k * kStep, image, image});
  }
  FaultOptions stuck = Fault("stereo", 0.2, 0.2);
  stuck.stuck.emplace();
  FaultOptions black = Fault("stereo", 0.5, std::nullopt);
  black.corrupt = CorruptFault{.look = "black", .side = "right"};
  const auto pairs = Only<nav::StereoImages>(After({stuck, black}, recording));
  ASSERT_EQ(pairs.size(), 6U);
  EXPECT_EQ(pairs[3].stamp, 3 * kStep);
  EXPECT_EQ(pairs[3].left.at<std::uint8_t>(0, 0), 11);
  EXPECT_EQ(pairs[4].left.at<std::uint8_t>(0, 0), 14);
  EXPECT_EQ(pairs[5].left.at<std::uint8_t>(0, 0), 15);
  EXPECT_EQ(pairs[5].right.at<std::uint8_t>(0, 0), 0);
}

std::vector<FaultOptions> Everything() {
  std::vector<FaultOptions> faults(4, Fault("imu", 0.5, std::nullopt));
  faults[0].noise.emplace();
  faults[0].noise->times = 5.0;
  faults[1].drop = DropFault{.probability = 0.2};
  faults[2].reorder.emplace();
  faults[3].duplicate = DuplicateFault{.probability = 0.5};
  return faults;
}

TEST(FaultInjector, SameSeedSameBytesOtherSeedOthers) {
  const auto a = Only<ImuSample>(After(Everything(), Recording(200), 7));
  const auto b = Only<ImuSample>(After(Everything(), Recording(200), 7));
  const auto c = Only<ImuSample>(After(Everything(), Recording(200), 8));
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].stamp, b[i].stamp);
    EXPECT_EQ(a[i].accel_m_s2, b[i].accel_m_s2);
  }
  EXPECT_NE(Stamps(a), Stamps(c));
}

TEST(FaultInjector, OtherStreamsAreUntouched) {
  const auto with = Only<nav::PolarizationSample>(After(Everything(), Recording(200)));
  const auto without = Only<nav::PolarizationSample>(Recording(200));
  ASSERT_EQ(with.size(), without.size());
  for (std::size_t i = 0; i < with.size(); ++i) {
    EXPECT_EQ(with[i].stamp, without[i].stamp);
    EXPECT_EQ(with[i].channel, without[i].channel);
  }
}

// The draws are the sample's own: what other streams there are does not move them.
TEST(FaultInjector, DrawsDoNotDependOnOtherStreams) {
  std::vector<Measurement> alone;
  for (const ImuSample& s : Only<ImuSample>(Recording(200))) alone.emplace_back(s);
  const auto a = Only<ImuSample>(After(Everything(), alone));
  const auto b = Only<ImuSample>(After(Everything(), Recording(200)));
  ASSERT_EQ(Stamps(a), Stamps(b));
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].accel_m_s2, b[i].accel_m_s2);
}

TEST(FaultInjector, RefusesWhatMakesNoSense) {
  FaultOptions dead = Fault("imu", 0.0, std::nullopt);
  EXPECT_THROW(FaultInjector({dead}, {}, 1, 0), std::logic_error);  // no kind
  dead.dead_channel.emplace();
  EXPECT_THROW(FaultInjector({dead}, {}, 1, 0), std::logic_error);  // no channels
}

}  // namespace
}  // namespace polnav::sim
