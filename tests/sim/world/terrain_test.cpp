#include "sim/world/terrain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "nav/api/geometry.h"
#include "sim/world/track.h"

namespace polnav::sim {
namespace {

constexpr TerrainOptions kFlat{
    .slope_deg = 0.0, .camber_deg = 0.0, .undulation_m = 0.0, .bump_m = 0.0};

// Across road, shoulder and plaza. Central differences over 2 h err by h^2 / 6 times the third
// derivative: bumps have 0.008 sqrt(2 / 10) (2 pi / 2 m)^3 each, below 0.5 / m^2 in all.
TEST(Terrain, GradientIsTheSlopeOfTheHeight) {
  const Track track(TrackOptions{});
  const Terrain terrain(TerrainOptions{}, track, 1);
  const double h = 1e-4;
  for (double x = -140.0; x < 30.0; x += 3.1) {
    for (double y = -80.0; y < 80.0; y += 3.7) {
      const Eigen::Vector2d g = terrain.At(x, y).gradient;
      const double gx = (terrain.Height(x + h, y) - terrain.Height(x - h, y)) / (2.0 * h);
      const double gy = (terrain.Height(x, y + h) - terrain.Height(x, y - h)) / (2.0 * h);
      ASSERT_NEAR(g.x(), gx, 1e-8) << x << " " << y;
      ASSERT_NEAR(g.y(), gy, 1e-8) << x << " " << y;
      const Eigen::Vector3d n = terrain.Normal(x, y);
      ASSERT_NEAR(n.norm(), 1.0, 1e-12);
      ASSERT_NEAR(n.dot(Eigen::Vector3d(1.0, 0.0, g.x())), 0.0, 1e-12);
      ASSERT_NEAR(n.dot(Eigen::Vector3d(0.0, 1.0, g.y())), 0.0, 1e-12);
    }
  }
}

// Curvature steps would kick the suspension. Walking outwards over road, edge and shoulder in
// steps of 1 mm, the second difference changes by no more than the third derivative's 1 mm.
TEST(Terrain, CurvatureIsContinuousAcrossTheRoadsEdges) {
  const Track track(TrackOptions{});
  const Terrain terrain(TerrainOptions{}, track, 1);
  const double h = 1e-3;
  double last = 0.0;
  for (int i = 0; i < 40000; ++i) {
    const double x = -20.0 + h * i;  // due east through the start: from inside to outside
    const double slope_change =
        terrain.At(x + h, 0.0).gradient.x() - terrain.At(x - h, 0.0).gradient.x();
    const double curvature = slope_change / (2.0 * h);
    if (i > 0) {
      ASSERT_NEAR(curvature, last, 1e-3) << x;
    }
    last = curvature;
  }
}

TEST(Terrain, LeansTowardsTheGivenAzimuth) {
  const Track track(TrackOptions{});
  TerrainOptions options = kFlat;
  options.slope_deg = 2.0;
  options.slope_towards_deg = 90.0;  // falls to the east
  const Terrain terrain(options, track, 1);
  const double fall = std::tan(nav::DegToRad(2.0));
  EXPECT_NEAR(terrain.Height(10.0, 3.0) - terrain.Height(0.0, 3.0), -10.0 * fall, 1e-12);
  EXPECT_NEAR(terrain.Height(0.0, 10.0) - terrain.Height(0.0, 0.0), 0.0, 1e-12);
}

TEST(Terrain, CamberFallsOutwardsOnTheRoadAndEndsBesideIt) {
  const Track track(TrackOptions{});
  TerrainOptions options = kFlat;
  options.camber_deg = 1.5;
  const Terrain terrain(options, track, 1);
  const double fall = std::tan(nav::DegToRad(1.5));
  EXPECT_NEAR(terrain.Height(1.0, 0.0), -fall, 1e-4);  // east of the start: outside
  EXPECT_NEAR(terrain.Height(-1.0, 0.0), fall, 1e-4);
  EXPECT_EQ(terrain.Height(30.0, 0.0), 0.0);
  EXPECT_EQ(terrain.Height(track.center_m().x(), 0.0), 0.0);
}

// Sampled over 300 m x 300 m, much more than the longest hill: a mean square of amplitude^2 / 2,
// within the 20 % that some 30 independent hills allow.
TEST(Terrain, AmplitudeIsThatOfTheWaveWithTheSameMeanSquare) {
  const Track track(TrackOptions{});
  TerrainOptions options = kFlat;
  options.undulation_m = 0.25;
  const Terrain terrain(options, track, 5);
  double sum_sq = 0.0;
  int n = 0;
  for (double x = -200.0; x < 100.0; x += 3.0) {
    for (double y = -150.0; y < 150.0; y += 3.0) {
      sum_sq += std::pow(terrain.Height(x, y), 2);
      ++n;
    }
  }
  EXPECT_NEAR(std::sqrt(2.0 * sum_sq / n), 0.25, 0.05);
}

TEST(Terrain, IsTheSameForTheSameSeedOnly) {
  const Track track(TrackOptions{});
  const Terrain a(TerrainOptions{}, track, 1);
  const Terrain b(TerrainOptions{}, track, 1);
  const Terrain c(TerrainOptions{}, track, 2);
  EXPECT_EQ(a.Height(3.0, 4.0), b.Height(3.0, 4.0));
  EXPECT_NE(a.Height(3.0, 4.0), c.Height(3.0, 4.0));
}

}  // namespace
}  // namespace polnav::sim
