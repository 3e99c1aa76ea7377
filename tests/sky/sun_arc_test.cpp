#include "sky/sun_arc.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace polnav::sky {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

// What the arc leaves out: the declination's own motion, 0.017 degrees an hour at the equinoxes and
// none at the solstices, and refraction, which grows by 0.02 degrees in half an hour as the sun of
// a November afternoon sinks from 16 degrees to 12.
TEST(SunArc, KeepsToTheEphemeris) {
  const Site site = SiteOf(SiteOptions{});
  struct Drive {
    const char* utc;
    double hours, tolerance_deg;
  };
  for (const Drive& drive :
       {Drive{"2020-11-11T07:00:00Z", 0.5, 0.025}, Drive{"2020-06-21T04:00:00Z", 2.0, 0.02},
        Drive{"2020-03-20T04:00:00Z", 2.0, 0.04}}) {
    const UtcDate start = ParseUtc(drive.utc).value();
    const SunArc arc = ComputeSunArc(site, start);
    for (double t_s = 0.0; t_s <= 3600.0 * drive.hours; t_s += 300.0) {
      const SunPosition sun = ComputeSun(site, AddSeconds(start, t_s));
      const Eigen::Vector3d there = DirectionEnu(sun.azimuth_rad, sun.elevation_rad);
      EXPECT_LT(std::asin(arc.At(t_s).cross(there).norm()), drive.tolerance_deg * kDegree)
          << drive.utc << " + " << t_s << " s";
    }
  }
}

TEST(SunArc, WithoutATurnStandsStill) {
  const SunArc arc{.start_W = DirectionEnu(1.0, 0.5)};
  EXPECT_EQ(arc.At(1e4), arc.start_W);
}

}  // namespace
}  // namespace polnav::sky
