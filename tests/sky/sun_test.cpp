#include "sky/sun.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace polnav::sky {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

UtcDate Utc(std::string_view text) {
  const std::optional<UtcDate> date = ParseUtc(text);
  EXPECT_TRUE(date.has_value()) << text;
  return date.value_or(UtcDate{});
}

// The worked example of NREL's SPA report [Reda2008, table A5.1]. Its clock time is UT1, and TT is
// 67 s ahead of it; UTC was then 64.184 s behind TT, so UT1 - UTC = -2.816 s.
SunPosition SpaExample() {
  const Site golden{39.742476 * kDegree, -105.1786 * kDegree, 1830.14};
  const UtcDate utc = AddSeconds(Utc("2003-10-17T19:30:30Z"), 2.816);
  return ComputeSun(golden, utc, {.pressure_hpa = 820.0, .temperature_c = 11.0}, -2.816);
}

// SPA claims 3e-4 degrees. It lacks diurnal aberration: 0.32" cos(latitude) eastward, which is
// 9e-5 degrees of azimuth here, and its sun is 0.11" behind ERFA's, another 4e-5.
TEST(ComputeSun, AgreesWithTheSpaExample) {
  const SunPosition sun = SpaExample();
  EXPECT_NEAR(sun.azimuth_rad / kDegree, 194.340241, 1.5e-4);
  EXPECT_NEAR(sun.geometric_elevation_rad / kDegree, 39.872046, 5e-5);
  EXPECT_NEAR(sun.elevation_rad / kDegree, 39.888378, 5e-5);
}

// Its intermediate values. Declination is printed to 1e-5 degrees and agrees to that. Along the
// ecliptic SPA's sun, from a shortened series, is 0.13" behind ERFA's: 4e-5 degrees of right
// ascension and hour angle, a tenth of what SPA claims for itself.
TEST(ComputeSun, AgreesWithTheIntermediateValuesOfTheSpaExample) {
  const SunPosition sun = SpaExample();
  EXPECT_NEAR(sun.declination_rad / kDegree, -9.31434, 1e-5);
  EXPECT_NEAR(sun.right_ascension_rad / kDegree, 202.227408, 4e-5);
  EXPECT_NEAR(sun.hour_angle_rad / kDegree, 11.105900, 4e-5);
}

// The lift itself is the same formula at nearly the same elevation.
TEST(ComputeSun, RefractsAsTheSpaExample) {
  const SunPosition sun = SpaExample();
  EXPECT_NEAR((sun.elevation_rad - sun.geometric_elevation_rad) / kDegree, 39.888378 - 39.872046,
              1e-6);
}

// Printed to 0.01 degrees in [Chu2021], from south, positive west. Elevations were computed with
// another ephemeris and air that is not stated: refraction differs by up to 2 % of 0.09 degrees.
TEST(ComputeSun, FindsTheSunsOfChu2021) {
  const SunPosition turntable =
      ComputeSun(SiteOf({.latitude_deg = 38.880383, .longitude_deg = 121.532249}),
                 Utc("2020-11-26T07:30:00Z"));
  EXPECT_NEAR(AzimuthFromSouth(turntable.azimuth_rad) / kDegree, 52.73, 0.005);
  EXPECT_NEAR(turntable.azimuth_rad / kDegree, 232.729, 0.005);
  EXPECT_NEAR(turntable.geometric_elevation_rad / kDegree, 9.693, 0.005);
  EXPECT_NEAR(turntable.elevation_rad / kDegree, 9.784, 0.005);

  const SunPosition car = ComputeSun(SiteOf(SiteOptions{}), Utc("2020-11-11T07:00:00Z"));
  EXPECT_NEAR(AzimuthFromSouth(car.azimuth_rad) / kDegree, 50.09, 0.005);
  EXPECT_NEAR(car.azimuth_rad / kDegree, 230.090, 0.005);
  EXPECT_NEAR(car.geometric_elevation_rad / kDegree, 16.451, 0.005);
  EXPECT_NEAR(car.elevation_rad / kDegree, 16.505, 0.005);
}

// SPA's table of sunrise and sunset: the upper limb on the horizon is -0.8333 degrees geometric.
// Times are given to the second, in which the sun climbs at most 15" = 0.0042 degrees.
TEST(ComputeSun, RisesAndSetsOnTimeAt35South) {
  const Site site{-35.0 * kDegree, 0.0, 0.0};
  for (const char* text : {"1996-07-05T07:08:15Z", "1996-07-05T17:01:04Z", "2004-12-04T04:38:57Z",
                           "2004-12-04T19:02:03Z"}) {
    EXPECT_NEAR(ComputeSun(site, Utc(text)).geometric_elevation_rad / kDegree, -0.8333, 0.0042)
        << text;
  }
}

TEST(ComputeSun, AnswersAtNight) {
  const SunPosition sun = ComputeSun(SiteOf(SiteOptions{}), Utc("2020-11-11T16:00:00Z"));
  EXPECT_LT(sun.elevation_rad, -60.0 * kDegree);
  EXPECT_TRUE(std::isfinite(sun.azimuth_rad));
}

TEST(ComputeSun, IsAsHighAsItIsLowAcrossTheEarth) {
  const UtcDate utc = Utc("2021-03-20T12:00:00Z");
  const SunPosition here = ComputeSun({0.4, 1.1, 0.0}, utc);
  const SunPosition there = ComputeSun({-0.4, 1.1 - std::numbers::pi, 0.0}, utc);
  // Diurnal parallax lowers both by up to 8.8"; diurnal aberration adds 0.3", and geodetic
  // verticals are opposite on the ellipsoid.
  EXPECT_NEAR((here.geometric_elevation_rad + there.geometric_elevation_rad) / kDegree, 0.0,
              2.0 * 9.2 / 3600.0);
  EXPECT_LT(here.geometric_elevation_rad + there.geometric_elevation_rad, 0.0);
}

// A whole day over the tropics, through the zenith's neighbourhood and the nadir's.
TEST(ComputeSun, IsLiftedMonotonicallyAtEveryElevation) {
  const Site site{20.0 * kDegree, 0.0, 0.0};
  const UtcDate start = Utc("2021-05-21T12:00:00Z");
  double last_geometric = 2.0;
  double last_apparent = 2.0;
  for (int minute = 0; minute < 700; ++minute) {
    const SunPosition sun = ComputeSun(site, AddSeconds(start, 60.0 * minute));
    ASSERT_LT(sun.geometric_elevation_rad, last_geometric);
    EXPECT_LT(sun.elevation_rad, last_apparent) << minute;
    EXPECT_GE(sun.elevation_rad, sun.geometric_elevation_rad) << minute;
    EXPECT_LT(sun.elevation_rad - sun.geometric_elevation_rad, 0.6 * kDegree) << minute;
    last_geometric = sun.geometric_elevation_rad;
    last_apparent = sun.elevation_rad;
  }
  EXPECT_LT(last_geometric, -45.0 * kDegree);
}

TEST(ComputeSun, GoesStraightInAVacuum) {
  const SunPosition sun =
      ComputeSun(SiteOf(SiteOptions{}), Utc("2020-11-11T07:00:00Z"), {.pressure_hpa = 0.0});
  EXPECT_EQ(sun.elevation_rad, sun.geometric_elevation_rad);
}

TEST(ParseUtc, RejectsWhatIsNoUtcDate) {
  for (const char* text :
       {"", "2020-11-11", "2020-11-11T07:00:00", "2020-11-11T07:00:00+08:00",
        "2020-13-11T07:00:00Z", "2020-00-11T07:00:00Z", "2020-02-30T07:00:00Z",
        "2019-02-29T07:00:00Z", "2020-11-11T24:00:00Z", "2020-11-11T07:60:00Z",
        "2020-11-11T07:00:61Z", "2020-11-11 07:00:00Z", "2020-11-11T07:00:00.Z",
        "2020-11-11T07:00:00,5Z", "2020-11-11T07:00:-1Z", "2020-11-11T07:00:0 Z",
        "1959-11-11T07:00:00Z", "2020-11-11T07:00:00ZZ", "2020-11-11T7:00:00Z"}) {
    EXPECT_FALSE(ParseUtc(text).has_value()) << text;
  }
}

TEST(ParseUtc, KnowsWhereLeapSecondsAre) {
  EXPECT_TRUE(ParseUtc("2016-12-31T23:59:60.5Z").has_value());
  EXPECT_FALSE(ParseUtc("2017-12-31T23:59:60Z").has_value());
  EXPECT_FALSE(ParseUtc("2016-12-31T12:00:60Z").has_value());
}

TEST(AddSeconds, CountsTheLeapSecond) {
  const UtcDate after = AddSeconds(Utc("2016-12-31T23:59:59Z"), 2.0);
  const UtcDate midnight = Utc("2017-01-01T00:00:00Z");
  // Double days resolve 1e-11 of a day in jd2 near one day; far below a microsecond.
  EXPECT_NEAR((after.jd1 - midnight.jd1) + (after.jd2 - midnight.jd2), 0.0, 1e-11);
}

TEST(AddSeconds, KeepsMicroseconds) {
  const UtcDate sum = AddSeconds(Utc("2020-11-11T07:00:00Z"), 12.000001);
  const UtcDate text = Utc("2020-11-11T07:00:12.000001Z");
  EXPECT_NEAR(((sum.jd1 - text.jd1) + (sum.jd2 - text.jd2)) * 86400.0, 0.0, 1e-8);
}

TEST(AzimuthFromSouth, IsPositiveWestAndHalfATurnAtNorth) {
  EXPECT_NEAR(AzimuthFromSouth(270.0 * kDegree), 90.0 * kDegree, 1e-15);
  EXPECT_NEAR(AzimuthFromSouth(90.0 * kDegree), -90.0 * kDegree, 1e-15);
  EXPECT_EQ(AzimuthFromSouth(0.0), std::numbers::pi);
}

TEST(DirectionEnu, TurnsFromNorthToEast) {
  EXPECT_LT((DirectionEnu(0.0, 0.0) - Eigen::Vector3d::UnitY()).norm(), 1e-15);
  EXPECT_LT((DirectionEnu(90.0 * kDegree, 0.0) - Eigen::Vector3d::UnitX()).norm(), 1e-15);
  EXPECT_LT((DirectionEnu(1.0, 90.0 * kDegree) - Eigen::Vector3d::UnitZ()).norm(), 1e-15);
}

}  // namespace
}  // namespace polnav::sky
