#include "sim/sensors/feature_errors.h"

#include <gtest/gtest.h>

#include <bitset>
#include <cmath>

namespace polnav::sim {
namespace {

using Eigen::Vector2d;

constexpr int kCount = 20000;

FeatureOptions Faultless() {
  FeatureOptions options;
  options.pixel_sigma_px = 0.0;
  options.match_sigma_px = 0.0;
  options.patch_sigma_px = 0.0;
  options.right_loss_probability = 0.0;
  options.outlier_share = 0.0;
  options.false_match_share = 0.0;
  return options;
}

// A match is found against the left image: what is wrong there is wrong in the right one, too. A
// variance from n numbers is known to sqrt(2 / n) of itself.
TEST(FeatureErrors, AreWhiteAndCarriedOverToTheRightImage) {
  FeatureOptions options = Faultless();
  options.pixel_sigma_px = 0.5;
  options.match_sigma_px = 0.3;
  RandomStream::Sample draw = RandomStream(1, 0, "test").At(0);
  double left = 0.0;
  double right = 0.0;
  double both = 0.0;
  Vector2d mean = Vector2d::Zero();
  for (int i = 0; i < kCount; ++i) {
    const SightingErrors e = DrawSightingErrors(options, draw);
    left += e.left_px.squaredNorm() / (2.0 * kCount);
    right += e.right_px.squaredNorm() / (2.0 * kCount);
    both += e.left_px.dot(e.right_px) / (2.0 * kCount);
    mean += e.left_px / kCount;
  }
  const double relative = 3.0 * std::sqrt(2.0 / (2.0 * kCount));
  EXPECT_NEAR(left, 0.25, 0.25 * relative);
  EXPECT_NEAR(right, 0.25 + 0.09, 0.34 * relative);
  EXPECT_NEAR(both, 0.25, 0.34 * relative);
  EXPECT_LT(mean.norm(), 4.0 * 0.5 * std::sqrt(2.0 / kCount));
}

// Uniform over a disc: the mean radius is two thirds of the largest.
TEST(FeatureErrors, OutliersAreAsManyAsAskedForAndFillADisc) {
  FeatureOptions options = Faultless();
  options.outlier_share = 0.05;
  options.outlier_px = 8.0;
  RandomStream::Sample draw = RandomStream(1, 0, "test").At(0);
  double left = 0.0;
  double right = 0.0;
  double radius = 0.0;
  for (int i = 0; i < kCount; ++i) {
    const SightingErrors e = DrawSightingErrors(options, draw);
    if (e.left_px.norm() > 0.0) ++left;
    if (e.right_px.norm() > 0.0) ++right;
    radius += e.left_px.norm();
    EXPECT_LE(e.left_px.norm(), 8.0);
  }
  const double sigma = std::sqrt(0.05 * 0.95 / kCount);
  EXPECT_NEAR(left / kCount, 0.05, 3.0 * sigma);
  EXPECT_NEAR(right / kCount, 0.05, 3.0 * sigma);
  // The radius scatters by R / sqrt(18).
  EXPECT_NEAR(radius / left, 8.0 * 2.0 / 3.0, 3.0 * 8.0 / std::sqrt(18.0 * left));
}

TEST(FeatureErrors, FalseMatchesAreAsManyTracksAsAskedFor) {
  FeatureOptions options = Faultless();
  options.false_match_share = 0.1;
  options.outlier_px = 6.0;
  const RandomStream stream(1, 0, "test");
  double matches = 0.0;
  for (std::uint64_t id = 0; id < kCount; ++id) {
    const double off = DrawTrackErrors(options, stream.At(id)).false_match_px;
    EXPECT_LE(std::abs(off), 6.0);
    if (off != 0.0) ++matches;
  }
  EXPECT_NEAR(matches / kCount, 0.1, 3.0 * std::sqrt(0.1 * 0.9 / kCount));
}

// At half the distance a patch is twice as large: its middle has come away by once its offset.
TEST(FeatureErrors, ATrackSlipsAsItsPatchGrows) {
  FeatureOptions options = Faultless();
  options.patch_sigma_px = 3.0;
  const RandomStream stream(1, 0, "test");
  double squares = 0.0;
  for (std::uint64_t id = 0; id < kCount; ++id) {
    const TrackErrors errors = DrawTrackErrors(options, stream.At(id));
    squares += Slip(errors, 20.0, 10.0).squaredNorm() / (2.0 * kCount);
    EXPECT_NEAR((Slip(errors, 30.0, 10.0) - 2.0 * Slip(errors, 20.0, 10.0)).norm(), 0.0, 1e-12);
    EXPECT_EQ(Slip(errors, 10.0, 10.0).norm(), 0.0) << "turning on the spot grows nothing";
  }
  EXPECT_NEAR(squares, 9.0, 9.0 * 3.0 * std::sqrt(1.0 / kCount));
}

// Turning one kind of error off must not draw other numbers for the rest.
TEST(FeatureErrors, OneKindDoesNotShiftAnothersNumbers) {
  FeatureOptions options = Faultless();
  options.pixel_sigma_px = 1.0;
  FeatureOptions more = options;
  more.outlier_share = 1e-9;
  more.right_loss_probability = 0.5;
  RandomStream::Sample a = RandomStream(1, 0, "test").At(0);
  RandomStream::Sample b = RandomStream(1, 0, "test").At(0);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(DrawSightingErrors(options, a).left_px, DrawSightingErrors(more, b).left_px);
  }
}

int Distance(const Descriptor& a, const Descriptor& b) {
  int bits = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    bits += static_cast<int>(std::bitset<8>(a[i] ^ b[i]).count());
  }
  return bits;
}

// Strangers differ in 128 of 256 bits, give or take 8; two sightings of one point in 40 at most.
TEST(FeatureErrors, DescriptorsTellPointsApart) {
  const RandomStream own(1, 0, "descriptors");
  RandomStream::Sample flips = RandomStream(1, 0, "flips").At(0);
  EXPECT_EQ(Distance(DescriptorOf(own.At(7), 0, flips), DescriptorOf(own.At(7), 0, flips)), 0);
  double mean = 0.0;
  for (std::uint64_t i = 0; i < 200; ++i) {
    const Descriptor here = DescriptorOf(own.At(i), 20, flips);
    EXPECT_LE(Distance(here, DescriptorOf(own.At(i), 20, flips)), 40);
    EXPECT_GT(Distance(here, DescriptorOf(own.At(i + 1), 20, flips)), 128 - 6 * 8);
    mean += Distance(here, DescriptorOf(own.At(i), 0, flips)) / 200.0;
  }
  // 20 draws of 256 hit 256 (1 - (1 - 2/256)^20) / 2 = 18.6 bits an odd number of times.
  EXPECT_NEAR(mean, 18.6, 0.5);
}

}  // namespace
}  // namespace polnav::sim
