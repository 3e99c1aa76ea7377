#include "tools/polnav/sky_directions.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <fstream>
#include <optional>

#include "nav/api/geometry.h"
#include "sky/sky_batch.h"
#include "sky/sun.h"
#include "tools/testbed/input_error.h"

namespace polnav::testbed {
namespace {

constexpr const char* kHeader = "azimuth_deg,elevation_deg";

std::string Trimmed(const std::string& text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string::npos) return "";
  return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

std::optional<double> ParseNumber(std::string text) {
  if (text.starts_with('+')) text.erase(0, 1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

SkyDirection ParseLine(const std::string& line, const std::string& file, int number) {
  const std::size_t comma = line.find(',');
  if (comma == std::string::npos || line.find(',', comma + 1) != std::string::npos) {
    throw InputError(file, number, "",
                     fmt::format("expected '{}', got '{}'", kHeader, line.substr(0, 80)));
  }
  const auto read = [&](const std::string& text, const char* what, double low, double high) {
    const std::optional<double> value = ParseNumber(Trimmed(text));
    if (!value) throw InputError(file, number, what, fmt::format("'{}' is no number", text));
    if (*value < low || *value > high) {
      throw InputError(file, number, what, fmt::format("{} is not in [{}, {}]", *value, low, high));
    }
    return *value;
  };
  return {read(line.substr(0, comma), "azimuth_deg", -360.0, 360.0),
          read(line.substr(comma + 1), "elevation_deg", 0.0, 90.0)};
}

}  // namespace

std::vector<SkyDirection> ReadDirections(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream || std::filesystem::is_directory(file)) {
    throw InputError(file.string(), 0, "", "cannot be read");
  }
  std::vector<SkyDirection> directions;
  bool may_be_header = true;
  std::string text;
  for (int number = 1; std::getline(stream, text); ++number) {
    const std::string line = Trimmed(text.substr(0, text.find('#')));
    if (line.empty()) continue;
    if (!may_be_header || line != kHeader) {
      directions.push_back(ParseLine(line, file.string(), number));
    }
    may_be_header = false;
  }
  if (directions.empty()) throw InputError(file.string(), 0, "", "holds no direction");
  return directions;
}

std::vector<SkyDirection> WholeSky() {
  std::vector<SkyDirection> directions;
  for (int ring = 0; ring < 36; ++ring) {
    for (int sector = 0; sector < 72; ++sector) directions.push_back({5.0 * sector, 2.5 * ring});
  }
  directions.push_back({0.0, 90.0});
  return directions;
}

std::string SkyCsv(const sky::ClearSky& sky, const std::vector<SkyDirection>& directions) {
  const std::size_t count = directions.size();
  std::vector<double> east(count), north(count), up(count), radiance(count), q(count), u(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double azimuth_rad = nav::DegToRad(directions[i].azimuth_deg);
    const double elevation_rad = nav::DegToRad(directions[i].elevation_deg);
    const Eigen::Vector3d ray = sky::DirectionEnu(azimuth_rad, elevation_rad);
    // At the zenith the axes are those of the azimuth that was asked for: a nanoradian off it.
    const double flat = std::max(std::cos(elevation_rad), 1e-9);
    east[i] = std::sin(azimuth_rad) * flat;
    north[i] = std::cos(azimuth_rad) * flat;
    up[i] = ray.z();
  }
  sky::LookAlong(sky, {east, north, up}, {radiance, q, u});
  std::string csv = std::string(kHeader) + ",I,Q,U,dop,aop_deg\n";
  for (std::size_t i = 0; i < count; ++i) {
    csv += fmt::format("{},{},{:.9g},{:.9g},{:.9g},{:.9f},{:.6f}\n", directions[i].azimuth_deg,
                       directions[i].elevation_deg, radiance[i], radiance[i] * q[i],
                       radiance[i] * u[i], std::hypot(q[i], u[i]),
                       nav::RadToDeg(0.5 * std::atan2(u[i], q[i])));
  }
  return csv;
}

}  // namespace polnav::testbed
