#include "sky/sun.h"

#include <erfa.h>
#include <erfam.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace polnav::sky {

namespace {

using std::numbers::pi;
using RowMatrix3d = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;  // ERFA's layout

constexpr double kDegree = pi / 180.0;
constexpr double kMetresPerAu = ERFA_DAU;
constexpr double kLightDaysPerAu = ERFA_AULT / ERFA_DAYSEC;

// The scales that the chain needs: TT for the orbit and the pole, UT1 for the earth's rotation.
struct Instant {
  double tt1, tt2;
  double ut1, ut2;
};

Instant InstantOf(const UtcDate& utc, double delta_ut1_s) {
  Instant t{};
  double tai1 = 0.0;
  double tai2 = 0.0;
  if (eraUtctai(utc.jd1, utc.jd2, &tai1, &tai2) < 0 || eraTaitt(tai1, tai2, &t.tt1, &t.tt2) < 0 ||
      eraUtcut1(utc.jd1, utc.jd2, delta_ut1_s, &t.ut1, &t.ut2) < 0) {
    throw std::invalid_argument("sun: the date lies outside the calendar that UTC knows");
  }
  return t;
}

struct EarthState {
  Eigen::Vector3d p_au;  // barycentric, BCRS axes
  Eigen::Vector3d v_au_d;
  Eigen::Vector3d sun_au;  // the sun's barycentric place at the same instant
};

EarthState EarthAt(double tdb1, double tdb2) {
  double heliocentric[2][3];
  double barycentric[2][3];
  // Its only warning, outside 1900 to 2100, costs arcseconds at worst. TT serves as TDB (2 ms).
  static_cast<void>(eraEpv00(tdb1, tdb2, heliocentric, barycentric));
  const Eigen::Map<const Eigen::Vector3d> p(barycentric[0]);
  const Eigen::Map<const Eigen::Vector3d> v(barycentric[1]);
  const Eigen::Map<const Eigen::Vector3d> from_sun(heliocentric[0]);
  return {p, v, p - from_sun};
}

// About the geocentre, along BCRS axes.
struct Observer {
  Eigen::Vector3d p_au = Eigen::Vector3d::Zero();
  Eigen::Vector3d v_au_d = Eigen::Vector3d::Zero();
};

RowMatrix3d CirsFromGcrs(const Instant& t) {
  double matrix[3][3];
  eraC2i06a(t.tt1, t.tt2, matrix);
  return Eigen::Map<const RowMatrix3d>(&matrix[0][0]);
}

Observer ObserverAt(const Site& site, const RowMatrix3d& cirs_from_gcrs, double rotation_rad) {
  double observer[2][3];  // about the geocentre, CIRS axes [m, m/s]
  eraPvtob(site.longitude_rad, site.latitude_rad, site.altitude_m, 0.0, 0.0, 0.0, rotation_rad,
           observer);
  const Eigen::Map<const Eigen::Vector3d> p(observer[0]);
  const Eigen::Map<const Eigen::Vector3d> v(observer[1]);
  return {cirs_from_gcrs.transpose() * p / kMetresPerAu,
          cirs_from_gcrs.transpose() * v * (ERFA_DAYSEC / kMetresPerAu)};
}

// Unit vector of the sun's apparent place, in the intermediate system of date (CIRS). Light time,
// annual aberration and the observer's parallax and diurnal aberration are in it.
Eigen::Vector3d ApparentSunCirs(const Observer& observer, const Instant& t,
                                const RowMatrix3d& cirs_from_gcrs) {
  const EarthState earth = EarthAt(t.tt1, t.tt2);
  const Eigen::Vector3d eye_au = earth.p_au + observer.p_au;
  const Eigen::Vector3d v_au_d = earth.v_au_d + observer.v_au_d;

  // The sun moves 13 m/s about the barycentre: one light-time step is plenty.
  const double light_days = (earth.sun_au - eye_au).norm() * kLightDaysPerAu;
  const Eigen::Vector3d to_sun = EarthAt(t.tt1, t.tt2 - light_days).sun_au - eye_au;

  std::array<double, 3> natural{};
  std::array<double, 3> velocity{};
  Eigen::Map<Eigen::Vector3d>(natural.data()) = to_sun.normalized();
  Eigen::Map<Eigen::Vector3d>(velocity.data()) = v_au_d * kLightDaysPerAu;  // in units of c
  const double beta2 = (v_au_d * kLightDaysPerAu).squaredNorm();
  std::array<double, 3> proper{};
  eraAb(natural.data(), velocity.data(), to_sun.norm(), std::sqrt(1.0 - beta2), proper.data());
  return cirs_from_gcrs * Eigen::Map<const Eigen::Vector3d>(proper.data());
}

// Lift of a ray by the air [rad], of the geometric elevation: Saemundsson's formula as NREL's SPA
// uses it, within 0.1' of the standard atmosphere down to the horizon. ERFA's A tan z + B tan^3 z
// is better high up, but diverges near the horizon. Below -0.575 degrees, where no sun is seen and
// Saemundsson's formula runs into its pole at -5.11 degrees, the lift dies away as 1 / tan, as in
// NOAA's solar calculator: the apparent elevation stays monotone.
double Refraction(double elevation_rad, const Air& air) {
  constexpr double kFloorDeg = -0.575;
  const double deg = elevation_rad / kDegree;
  const double high = std::max(deg, kFloorDeg);
  double lift_deg = 1.02 / 60.0 / std::tan((high + 10.3 / (high + 5.11)) * kDegree);
  if (deg < kFloorDeg) {
    lift_deg *= std::tan(kFloorDeg * kDegree) / std::tan(elevation_rad);
  }
  const double density = air.pressure_hpa / 1010.0 * 283.0 / (273.0 + air.temperature_c);
  return std::max(0.0, lift_deg) * density * kDegree;  // the formula crosses zero near the zenith
}

// The digits of text[at, at + count), or nothing.
std::optional<int> Digits(std::string_view text, std::size_t at, std::size_t count) {
  int value = 0;
  for (const char c : text.substr(at, count)) {
    if (c < '0' || c > '9') {
      return std::nullopt;
    }
    value = 10 * value + (c - '0');
  }
  return value;
}

// ".fff" of any length up to nanoseconds, or nothing at all.
std::optional<double> Fraction(std::string_view text) {
  if (text.empty()) {
    return 0.0;
  }
  if (text.size() < 2 || text.size() > 10 || text.front() != '.') {
    return std::nullopt;
  }
  const std::optional<int> digits = Digits(text, 1, text.size() - 1);
  if (!digits) {
    return std::nullopt;
  }
  return *digits * std::pow(10.0, 1.0 - static_cast<double>(text.size()));
}

}  // namespace

std::optional<UtcDate> ParseUtc(std::string_view text) {
  constexpr std::string_view kForm = "0000-00-00T00:00:00";
  if (text.size() <= kForm.size() || text.back() != 'Z') {
    return std::nullopt;
  }
  for (std::size_t i = 0; i < kForm.size(); ++i) {
    if (kForm[i] != '0' && text[i] != kForm[i]) {
      return std::nullopt;
    }
  }
  const auto year = Digits(text, 0, 4);
  const auto month = Digits(text, 5, 2);
  const auto day = Digits(text, 8, 2);
  const auto hour = Digits(text, 11, 2);
  const auto minute = Digits(text, 14, 2);
  const auto second = Digits(text, 17, 2);
  const auto fraction = Fraction(text.substr(kForm.size(), text.size() - kForm.size() - 1));
  if (!year || !month || !day || !hour || !minute || !second || !fraction || *year < 1960) {
    return std::nullopt;  // there was no UTC before 1960
  }
  UtcDate date;
  const int status = eraDtf2d("UTC", *year, *month, *day, *hour, *minute, *second + *fraction,
                              &date.jd1, &date.jd2);
  // Negative: no such date. 2 and 3: past the day's end, that is a second 60 without a leap second.
  // 1: a year whose leap seconds are not announced yet, which is no fault of the reader's.
  if (status < 0 || status > 1) {
    return std::nullopt;
  }
  return date;
}

// Through TAI, because a UTC day may hold a leap second.
UtcDate AddSeconds(const UtcDate& date, double seconds) {
  double tai1 = 0.0;
  double tai2 = 0.0;
  UtcDate sum;
  if (eraUtctai(date.jd1, date.jd2, &tai1, &tai2) < 0 ||
      eraTaiutc(tai1, tai2 + seconds / ERFA_DAYSEC, &sum.jd1, &sum.jd2) < 0) {
    throw std::invalid_argument("sun: the date lies outside the calendar that UTC knows");
  }
  return sum;
}

Site SiteOf(const SiteOptions& options) {
  return {options.latitude_deg * kDegree, options.longitude_deg * kDegree, options.altitude_m};
}

SunPosition ComputeSun(const Site& site, const UtcDate& utc, const Air& air, double delta_ut1_s) {
  const Instant t = InstantOf(utc, delta_ut1_s);
  const double rotation_rad = eraEra00(t.ut1, t.ut2);
  const RowMatrix3d cirs_from_gcrs = CirsFromGcrs(t);
  const Eigen::Vector3d sun_cirs =
      ApparentSunCirs(ObserverAt(site, cirs_from_gcrs, rotation_rad), t, cirs_from_gcrs);
  const double meridian_rad = rotation_rad + site.longitude_rad;
  // x: where the local meridian meets the equator, y: east, z: pole.
  const Eigen::Vector3d local =
      Eigen::AngleAxisd(-meridian_rad, Eigen::Vector3d::UnitZ()) * sun_cirs;
  const double sin_lat = std::sin(site.latitude_rad);
  const double cos_lat = std::cos(site.latitude_rad);
  const double east = local.y();
  const double north = -sin_lat * local.x() + cos_lat * local.z();
  const double up = cos_lat * local.x() + sin_lat * local.z();

  SunPosition sun;
  sun.azimuth_rad = eraAnp(std::atan2(east, north));
  sun.geometric_elevation_rad = std::atan2(up, std::hypot(east, north));
  sun.elevation_rad = sun.geometric_elevation_rad + Refraction(sun.geometric_elevation_rad, air);

  const Eigen::Vector3d geocentric = ApparentSunCirs({}, t, cirs_from_gcrs);
  const double intermediate_ra_rad = std::atan2(geocentric.y(), geocentric.x());
  sun.right_ascension_rad = eraAnp(intermediate_ra_rad - eraEo06a(t.tt1, t.tt2));
  sun.declination_rad = std::asin(std::clamp(geocentric.z(), -1.0, 1.0));
  sun.hour_angle_rad = eraAnp(meridian_rad - intermediate_ra_rad);
  return sun;
}

double AzimuthFromSouth(double compass_azimuth_rad) {
  const double wrapped = std::remainder(compass_azimuth_rad - pi, 2.0 * pi);
  return wrapped <= -pi ? pi : wrapped;
}

Eigen::Vector3d DirectionEnu(double azimuth_rad, double elevation_rad) {
  return {std::sin(azimuth_rad) * std::cos(elevation_rad),
          std::cos(azimuth_rad) * std::cos(elevation_rad), std::sin(elevation_rad)};
}

}  // namespace polnav::sky
