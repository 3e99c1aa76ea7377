#include "sim/world/track.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace polnav::sim {
namespace {

TEST(Track, StartsAtTheOriginHeadingNorthWithTheCentreToTheWest) {
  const Track track(TrackOptions{});
  const Track::Point start = track.At(0.0);
  EXPECT_LT(start.p_m.norm(), 1e-9);
  EXPECT_LT((start.tangent - Eigen::Vector2d(0.0, 1.0)).norm(), 1e-12);
  EXPECT_GT(start.curvature_1_m, 0.0);
  EXPECT_LT(track.center_m().x(), -50.0);
  EXPECT_NEAR(track.center_m().y(), 0.0, 1e-12);
}

// A chord of 1 cm at curvature 1/40 m is shorter than its arc by (0.01 / 40)^2 / 24 = 3e-9.
TEST(Track, ArcLengthIsTheDistanceAlongTheCurve) {
  const Track track(TrackOptions{});
  const double step = 0.01;
  double walked = 0.0;
  double worst_chord = 0.0;
  for (int i = 0; i < 37700; ++i) {
    const double chord = (track.At(step * (i + 1)).p_m - track.At(step * i).p_m).norm();
    worst_chord = std::max(worst_chord, std::abs(chord / step - 1.0));
    walked += chord;
  }
  EXPECT_LT(worst_chord, 1e-6);
  EXPECT_NEAR(walked, track.length_m(), 1e-5);  // 377 m * 3e-9, and rounding
}

TEST(Track, ClosesAfterAnyNumberOfLaps) {
  const Track track(TrackOptions{});
  for (const double s : {0.0, 1.5, 200.0, 376.9}) {
    for (const double laps : {-2.0, 1.0, 5.0}) {
      const Track::Point once = track.At(s);
      const Track::Point again = track.At(s + laps * track.length_m());
      EXPECT_LT((once.p_m - again.p_m).norm(), 1e-9) << s;
      EXPECT_LT((once.tangent - again.tangent).norm(), 1e-10) << s;
    }
  }
}

// Total curvature of a simple closed curve is one turn; and the tangent's rate is the curvature.
TEST(Track, TurnsLeftOncePerLap) {
  const Track track(TrackOptions{});
  const int n = 2000;
  const double step = track.length_m() / n;
  double turned = 0.0;
  for (int i = 0; i < n; ++i) {
    const Track::Point here = track.At(step * i);
    const Eigen::Vector2d ahead = track.At(step * i + 1e-4).tangent;
    const Eigen::Vector2d behind = track.At(step * i - 1e-4).tangent;
    const Eigen::Vector2d left(-here.tangent.y(), here.tangent.x());
    // Rounding of two unit vectors over 2e-4 m: 1e-12 at most; truncation is smaller.
    EXPECT_NEAR((ahead - behind).dot(left) / 2e-4, here.curvature_1_m, 1e-8);
    EXPECT_GT(here.curvature_1_m, 0.0);  // convex
    turned += here.curvature_1_m * step;
  }
  EXPECT_NEAR(turned, 2.0 * std::numbers::pi, 1e-9);
}

TEST(Track, IsNearlyButNotQuiteACircle) {
  const Track track(TrackOptions{});
  double nearest = 1e9;
  double farthest = 0.0;
  for (int i = 0; i < 377; ++i) {
    const double r = (track.At(i).p_m - track.center_m()).norm();
    nearest = std::min(nearest, r);
    farthest = std::max(farthest, r);
  }
  EXPECT_GT(farthest / nearest, 1.04);
  EXPECT_LT(farthest / nearest, 1.0 + 2.0 * 0.06 / (1.0 - 0.06));
}

TEST(Track, WithoutHarmonicsIsTheCircleOfThatCircumference) {
  const Track track({.length_m = 377.0, .noncircularity = 0.0});
  EXPECT_NEAR(track.mean_radius_m(), 377.0 / (2.0 * std::numbers::pi), 1e-10);
  EXPECT_NEAR(track.At(100.0).curvature_1_m, 2.0 * std::numbers::pi / 377.0, 1e-12);
}

TEST(Track, ProjectionUndoesAnOffsetFromTheCentreLine) {
  for (const double noncircularity : {0.0, 0.06, 0.2}) {
    const Track track({.length_m = 377.0, .noncircularity = noncircularity});
    for (double s = 0.25; s < 377.0; s += 7.3) {
      for (const double offset : {-15.0, -3.0, 0.0, 0.5, 12.0}) {
        const Track::Point on_line = track.At(s);
        const Eigen::Vector2d left(-on_line.tangent.y(), on_line.tangent.x());
        const Eigen::Vector2d beside = on_line.p_m + offset * left;
        const Track::Projection found = track.Project(beside);
        EXPECT_NEAR(found.s_m, s, 1e-7);
        EXPECT_NEAR(found.offset_m, offset, 1e-9);
        EXPECT_LT((found.tangent - on_line.tangent).norm(), 1e-9);
        EXPECT_LE(track.RadialDistance(beside), 1.2 * std::abs(offset) + 1e-7);
      }
    }
  }
}

TEST(Track, ProjectionIsDefinedAtTheVeryCentre) {
  const Track track(TrackOptions{});
  const Track::Projection found = track.Project(track.center_m());
  EXPECT_TRUE(std::isfinite(found.s_m));
  EXPECT_GT(found.offset_m, 40.0);
}

TEST(Track, RefusesARoadWiderThanItsLoop) {
  EXPECT_THROW(Track({.length_m = 60.0, .road_width_m = 30.0}), std::invalid_argument);
}

}  // namespace
}  // namespace polnav::sim
