#include "sim/world/structures.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sim/world/occlusion.h"
#include "tests/sim/world/world_fixture.h"

namespace polnav::sim {
namespace {

using Eigen::Vector3d;

const SmallLoop& Loop() {
  static const SmallLoop loop;
  return loop;
}

Scene Build(const StructureOptions& structure) {
  SceneBuilder builder(32.0, false);
  AddStructures({structure}, Loop().street, 3, builder);
  return builder.Take();
}

double White(const Vector3d&) { return 1.0; }

// A grid of rays along the road, two metres each: whatever stands in the way of a bus is hit.
TEST(Structures, LeaveTheWholeRoadFreeUpToFourAndAHalfMetres) {
  for (const char* kind : {"bridge", "tunnel", "canopy", "plain_wall"}) {
    const Scene scene = Build({.kind = kind, .start_m = 40.0, .length_m = 30.0, .density = 1.0});
    const Occlusion occlusion(scene, White);
    for (double s = 34.0; s < 74.0; s += 1.0) {
      for (double offset = -3.9; offset < 4.0; offset += 0.39) {
        for (const double lift : {0.3, 1.2, 2.5, 3.5, 4.5}) {
          const Vector3d from = Loop().street.At(s, offset, lift);
          const Vector3d to = Loop().street.At(s + 2.0, offset, lift);
          const Vector3d ray = (to - from).normalized();
          const auto hit = occlusion.From(from, ray, 0.0, 0).Look(ray);
          EXPECT_TRUE(!hit || hit->distance_m > 1.9) << kind << " at " << s << ", " << offset;
        }
      }
    }
  }
}

// Share of the zenith over the road's middle that is hidden, along the structure.
double HiddenShare(const StructureOptions& structure, double cone_deg) {
  const Scene scene = Build(structure);
  const Occlusion occlusion(scene, White);
  int hidden = 0;
  int all = 0;
  for (double s = structure.start_m + 0.5; s < structure.start_m + structure.length_m; s += 0.5) {
    const Vector3d eye = Loop().street.At(s, 0.0, 1.8);
    const auto view = occlusion.From(eye, Vector3d::UnitZ(), nav::DegToRad(cone_deg), 0);
    for (int k = 0; k < 24; ++k) {
      const double off = nav::DegToRad(cone_deg) * std::sqrt((k % 4 + 0.5) / 4.0);
      const double around = 2.0 * M_PI * k / 24.0;
      const Vector3d ray(std::sin(off) * std::cos(around), std::sin(off) * std::sin(around),
                         std::cos(off));
      hidden += view.Look(ray).has_value();
      ++all;
    }
  }
  return static_cast<double>(hidden) / all;
}

TEST(Structures, HideTheSkyAsTheyShould) {
  EXPECT_EQ(HiddenShare({.kind = "tunnel", .start_m = 40.0, .length_m = 30.0}, 5.0), 1.0);
  EXPECT_GT(HiddenShare({.kind = "bridge", .start_m = 40.0, .length_m = 10.0}, 5.0), 0.9);
  EXPECT_EQ(HiddenShare({.kind = "plain_wall", .start_m = 40.0, .length_m = 30.0}, 5.0), 0.0);
  const double canopy = HiddenShare({.kind = "canopy", .start_m = 40.0, .length_m = 60.0}, 5.0);
  EXPECT_GT(canopy, 0.6);
  EXPECT_LT(canopy, 0.95);
  EXPECT_EQ(HiddenShare({.kind = "canopy", .start_m = 40.0, .length_m = 60.0, .density = 0.0}, 5.0),
            0.0);
}

TEST(Structures, AreDarkInsideAndBrightOutside) {
  const std::vector<StructureOptions> tunnel = {
      {.kind = "tunnel", .start_m = 40.0, .length_m = 60.0, .interior_light = 0.1}};
  EXPECT_EQ(DaylightAt(tunnel, 39.0, Loop().street), 1.0);
  EXPECT_NEAR(DaylightAt(tunnel, 40.0, Loop().street), 1.0, 1e-9);
  EXPECT_LT(DaylightAt(tunnel, 70.0, Loop().street), 0.15);
  EXPECT_EQ(DaylightAt(tunnel, 101.0, Loop().street), 1.0);
  // The same place a lap later.
  EXPECT_NEAR(DaylightAt(tunnel, 70.0, Loop().street),
              DaylightAt(tunnel, 70.0 + 377.0, Loop().street), 1e-9);
}

TEST(Structures, AreRefusedWhereTheyCannotStand) {
  const auto fault = [](const std::vector<StructureOptions>& structures) {
    const auto found = FindFault(structures, 377.0);
    return found ? std::to_string(found->index) + "." + found->key : "none";
  };
  EXPECT_EQ(fault({{.kind = "bridge", .start_m = 380.0}}), "0.start_m");
  EXPECT_EQ(fault({{.kind = "bridge", .start_m = 370.0, .length_m = 10.0}}), "0.length_m");
  EXPECT_EQ(fault({{.kind = "tunnel", .start_m = -10.0, .length_m = 20.0}}), "0.start_m");
  EXPECT_EQ(fault({{.kind = "tunnel", .start_m = 2.0, .length_m = 20.0}}), "0.start_m");
  EXPECT_EQ(fault({{.kind = "plain_wall", .start_m = 340.0, .length_m = 36.0}}), "0.start_m");
  EXPECT_EQ(fault({{.kind = "bridge", .start_m = -5.0, .length_m = 10.0}}), "none");
  EXPECT_EQ(fault({{.kind = "tunnel", .start_m = -50.0, .length_m = 30.0}}), "none");
  EXPECT_EQ(fault({{.kind = "tunnel", .start_m = 40.0, .length_m = 30.0},
                   {.kind = "bridge", .start_m = 60.0, .length_m = 10.0}}),
            "1.start_m");
  EXPECT_EQ(fault({{.kind = "plain_wall", .start_m = 40.0, .length_m = 30.0},
                   {.kind = "canopy", .start_m = 60.0, .length_m = 10.0}}),
            "none");
}

}  // namespace
}  // namespace polnav::sim
