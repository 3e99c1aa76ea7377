// Where is the sun?
//
// Through ERFA (the IAU's SOFA routines): apparent topocentric place with refraction.
// A compass azimuth counts from north, clockwise; Chu2021 counts from south, positive west.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <string_view>

namespace polnav::sky {

// Where and when. YAML keys = field names.
struct SiteOptions {
  double latitude_deg = 38.832;              // positive north
  double longitude_deg = 121.503;            // positive east
  double altitude_m = 20.0;                  // above the WGS84 ellipsoid
  std::string utc = "2020-11-11T07:00:00Z";  // of the scenario's start, ISO 8601

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("latitude_deg", latitude_deg, {.min = -90.0, .max = 90.0});
    v("longitude_deg", longitude_deg, {.min = -180.0, .max = 180.0});
    v("altitude_m", altitude_m, {.min = -500.0, .max = 9000.0});
    v("utc", utc);
  }
};

// A UTC instant as a two-part Julian date, kept apart so that no nanosecond is lost.
struct UtcDate {
  double jd1 = 0.0;
  double jd2 = 0.0;
};

// Reads "YYYY-MM-DDTHH:MM:SS[.fff]Z". Nothing when the text is no such date.
[[nodiscard]] std::optional<UtcDate> ParseUtc(std::string_view text);

[[nodiscard]] UtcDate AddSeconds(const UtcDate& date, double seconds);

// Air that bends the sun's light. Zero pressure means no refraction.
struct Air {
  double pressure_hpa = 1013.25;
  double temperature_c = 10.0;
};

struct SunPosition {
  double azimuth_rad = 0.0;              // compass: from north, clockwise, [0, 2 pi)
  double elevation_rad = 0.0;            // apparent: with refraction
  double geometric_elevation_rad = 0.0;  // without

  // As almanacs have it: apparent, seen from the centre of the earth.
  double right_ascension_rad = 0.0;  // from the true equinox of date, [0, 2 pi)
  double declination_rad = 0.0;
  double hour_angle_rad = 0.0;  // from the site's meridian, westward, [0, 2 pi)
};

struct Site {
  double latitude_rad = 0.0;
  double longitude_rad = 0.0;
  double altitude_m = 0.0;
};

[[nodiscard]] Site SiteOf(const SiteOptions& options);

// delta_ut1_s is UT1 - UTC, published by the IERS; at most 0.9 s, that is 0.004 degrees.
[[nodiscard]] SunPosition ComputeSun(const Site& site, const UtcDate& utc, const Air& air = {},
                                     double delta_ut1_s = 0.0);

// Azimuth as Chu2021 prints it: from south, positive west [rad], in (-pi, pi].
[[nodiscard]] double AzimuthFromSouth(double compass_azimuth_rad);

// Unit vector in ENU of a compass azimuth and an elevation [rad].
[[nodiscard]] Eigen::Vector3d DirectionEnu(double azimuth_rad, double elevation_rad);

}  // namespace polnav::sky
