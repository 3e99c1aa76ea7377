#include "nav/inertial/imu_buffer.h"

#include <gtest/gtest.h>

namespace polnav::nav {
namespace {

constexpr TimeNs kMs = 1'000'000;

ImuNoise TestNoise() { return {.gyro_rad_s_sqrt_hz = 1e-4, .accel_m_s2_sqrt_hz = 1e-3}; }

// Reading k ends at 10 k ms and turns about z with k rad/s, so that a sum tells which were in it.
ImuSample Reading(int k) {
  ImuSample sample{.stamp = 10 * kMs * k};
  sample.gyro_rad_s.z() = k;
  return sample;
}

double TurnOf(const Preintegration& sum) { return 2.0 * std::atan2(sum.dq.z(), sum.dq.w()); }

class ImuBufferTest : public ::testing::Test {
 protected:
  void Fill(int first, int last) {
    for (int k = first; k <= last; ++k) EXPECT_EQ(buffer_.Add(Reading(k)), Outcome::kUsed);
  }
  ImuBuffer buffer_{100.0, TestNoise()};
  Preintegration sum_;
};

TEST_F(ImuBufferTest, ReadingsAtTheEndsCountInPart) {
  Fill(1, 10);
  ASSERT_TRUE(buffer_.Integrate(15 * kMs, 37 * kMs, sum_));
  EXPECT_NEAR(sum_.dt_s, 0.022, 1e-12);
  EXPECT_NEAR(TurnOf(sum_), 0.005 * 2 + 0.01 * 3 + 0.007 * 4, 1e-12);
  // The rest of reading 4 belongs to the next frame.
  Preintegration next;
  ASSERT_TRUE(buffer_.Integrate(37 * kMs, 50 * kMs, next));
  EXPECT_NEAR(TurnOf(next), 0.003 * 4 + 0.01 * 5, 1e-12);
}

TEST_F(ImuBufferTest, OneLostReadingIsBridgedAndAGapIsNot) {
  Fill(1, 3);
  Fill(5, 8);
  ASSERT_TRUE(buffer_.Integrate(10 * kMs, 80 * kMs, sum_));
  EXPECT_NEAR(TurnOf(sum_), 0.01 * (2 + 3 + 5 + 5 + 6 + 7 + 8), 1e-12);
  Fill(15, 20);
  EXPECT_FALSE(buffer_.Integrate(80 * kMs, 200 * kMs, sum_));
}

TEST_F(ImuBufferTest, TheLastReadingHoldsForAPictureThatComesFirst) {
  Fill(1, 4);
  ASSERT_TRUE(buffer_.Integrate(20 * kMs, 50 * kMs, sum_));
  EXPECT_NEAR(TurnOf(sum_), 0.01 * (3 + 4 + 4), 1e-12);
  EXPECT_FALSE(buffer_.Integrate(50 * kMs, 90 * kMs, sum_)) << "nothing has come since";
}

TEST_F(ImuBufferTest, LateAndRepeatedReadingsAreUnusable) {
  Fill(1, 4);
  EXPECT_EQ(buffer_.Add(Reading(4)), Outcome::kUnusable);
  EXPECT_EQ(buffer_.Add(Reading(2)), Outcome::kUnusable);
}

}  // namespace
}  // namespace polnav::nav
