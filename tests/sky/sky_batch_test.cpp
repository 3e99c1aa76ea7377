#include "sky/sky_batch.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

#include "sky/sun.h"

namespace polnav::sky {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

struct Rays {
  std::vector<double> east, north, up;
  void Add(const Eigen::Vector3d& ray) {
    east.push_back(ray.x());
    north.push_back(ray.y());
    up.push_back(ray.z());
  }
  [[nodiscard]] Eigen::Vector3d At(std::size_t i) const { return {east[i], north[i], up[i]}; }
};

Rays Everywhere(const Eigen::Vector3d& sun_W) {
  Rays rays;
  for (double elevation = 0.0; elevation < 90.0; elevation += 4.0) {
    for (double azimuth = 0.0; azimuth < 360.0; azimuth += 13.0) {
      rays.Add(DirectionEnu(azimuth * kDegree, elevation * kDegree));
    }
  }
  rays.Add(Eigen::Vector3d::UnitZ());
  rays.Add(sun_W);
  return rays;
}

struct Answer {
  explicit Answer(std::size_t n) : radiance(n), q(n), u(n) {}
  std::vector<double> radiance, q, u;
};

Answer Batch(const ClearSky& sky, const Rays& rays) {
  Answer answer(rays.up.size());
  LookAlong(sky, {rays.east, rays.north, rays.up}, {answer.radiance, answer.q, answer.u});
  return answer;
}

TEST(LookAlong, IsTheScalarModel) {
  for (const char* model : {"rayleigh", "berry", "hazy"}) {
    for (const double elevation_deg : {-3.0, 8.0, 40.0, 89.0}) {
      const ClearSky sky({.model = model, .aot = 0.2}, DirectionEnu(2.0, elevation_deg * kDegree));
      const Rays rays = Everywhere(sky.sun_W());
      const Answer batch = Batch(sky, rays);
      for (std::size_t i = 0; i < rays.up.size(); ++i) {
        if (rays.up[i] < 0.0) continue;
        const SkyStokes<double> scalar = sky.Look(rays.At(i));
        EXPECT_NEAR(batch.radiance[i], scalar.radiance, 1e-6 * scalar.radiance) << model;
        EXPECT_NEAR(batch.q[i], scalar.q, 1e-12) << model;
        EXPECT_NEAR(batch.u[i], scalar.u, 1e-12) << model;
      }
    }
  }
}

// Vector code works on four or eight rays and plain code on what is left: the bytes are the same.
TEST(LookAlong, DoesNotDependOnTheNeighbours) {
  const ClearSky sky({.model = "hazy"}, DirectionEnu(2.0, 0.4));
  const Rays rays = Everywhere(sky.sun_W());
  const Answer together = Batch(sky, rays);
  for (std::size_t i = 0; i < rays.up.size(); i += 7) {
    Rays alone;
    alone.Add(rays.At(i));
    const Answer one = Batch(sky, alone);
    EXPECT_EQ(one.radiance[0], together.radiance[i]);
    EXPECT_EQ(one.q[0], together.q[i]);
    EXPECT_EQ(one.u[0], together.u[i]);
  }
}

TEST(LookAlong, RefusesArraysOfDifferentLengths) {
  const ClearSky sky({}, DirectionEnu(2.0, 0.4));
  std::vector<double> two(2), three(3);
  EXPECT_THROW(LookAlong(sky, {two, two, three}, {two, two, two}), std::logic_error);
}

}  // namespace
}  // namespace polnav::sky
