#include <fmt/format.h>

#include <cmath>
#include <filesystem>
#include <opencv2/imgcodecs.hpp>

#include "nav/api/geometry.h"
#include "sky/neutral_points.h"
#include "sky/sky_batch.h"
#include "sky/sun.h"
#include "tools/polnav/commands.h"
#include "tools/polnav/sky_directions.h"
#include "tools/polnav/sky_map.h"
#include "tools/testbed/input_error.h"
#include "tools/testbed/output_folder.h"

namespace polnav::testbed {
namespace {

namespace fs = std::filesystem;

void RequireInRange(const char* option, const std::optional<double>& value, double low,
                    double high) {
  if (value && !(*value >= low && *value <= high)) {  // not a number is in no range
    throw InputError(option, 0, "", fmt::format("{} is not in [{}, {}]", *value, low, high));
  }
}

void RequireSense(const SkyArguments& a) {
  RequireInRange("--lat", a.latitude_deg, -90.0, 90.0);
  RequireInRange("--lon", a.longitude_deg, -180.0, 180.0);
  RequireInRange("--sun-elevation-deg", a.sun_elevation_deg, -90.0, 90.0);
  RequireInRange("--sun-azimuth-deg", a.sun_azimuth_deg, -360.0, 360.0);
  RequireInRange("--aot", a.aot, 0.0, 1.0);
  RequireInRange("--wavelength-nm", a.wavelength_nm, 400.0, 700.0);
  RequireInRange("--max-dop", a.max_dop, 0.0, 1.0);
  const bool place = a.latitude_deg || a.longitude_deg || a.utc;
  const bool sun = a.sun_elevation_deg || a.sun_azimuth_deg;
  if (place && sun) {
    throw InputError("give either --lat, --lon and --utc or the sun's place, not both");
  }
  if (!place && !sun) {
    throw InputError(
        "where is the sun? Give --lat, --lon and --utc, or --sun-elevation-deg and "
        "--sun-azimuth-deg");
  }
  const auto require = [](bool given, const char* option) {
    if (!given) throw InputError(fmt::format("{} is missing", option));
  };
  if (place) {
    require(a.latitude_deg.has_value(), "--lat");
    require(a.longitude_deg.has_value(), "--lon");
    require(a.utc.has_value(), "--utc");
  } else {
    require(a.sun_elevation_deg.has_value(), "--sun-elevation-deg");
    require(a.sun_azimuth_deg.has_value(), "--sun-azimuth-deg");
  }
}

sky::SunPosition SunOf(const SkyArguments& a) {
  if (!a.utc) {
    const double elevation_rad = nav::DegToRad(*a.sun_elevation_deg);
    const double turn = std::fmod(*a.sun_azimuth_deg + 720.0, 360.0);
    return {nav::DegToRad(turn), elevation_rad, elevation_rad};
  }
  const std::optional<sky::UtcDate> utc = sky::ParseUtc(*a.utc);
  if (!utc) {
    throw InputError("--utc", 0, "",
                     fmt::format("'{}' is no time such as 2020-11-11T07:00:00Z", *a.utc));
  }
  return sky::ComputeSun({nav::DegToRad(*a.latitude_deg), nav::DegToRad(*a.longitude_deg), 0.0},
                         *utc);
}

sky::ClearSkyOptions OptionsOf(const SkyArguments& a, const Console& console) {
  sky::ClearSkyOptions options{.model = a.model};
  options.aot = a.aot.value_or(options.aot);
  options.wavelength_nm = a.wavelength_nm.value_or(options.wavelength_nm);
  options.max_dop = a.max_dop.value_or(options.max_dop);
  const auto note = [&](bool given, const char* option) {
    if (given) console.err << "polnav: note: " << option << " says nothing to " << a.model << "\n";
  };
  note(a.max_dop && a.model == "hazy", "--max-dop");
  note(a.aot && a.model == "rayleigh", "--aot");
  note(a.wavelength_nm && a.model != "hazy", "--wavelength-nm");
  return options;
}

std::string ModelText(const sky::ClearSkyOptions& options) {
  if (options.model == "rayleigh") return fmt::format("rayleigh, max. DoP {}", options.max_dop);
  if (options.model == "berry") {
    return fmt::format("berry, max. DoP {}, AOT {}", options.max_dop, options.aot);
  }
  return fmt::format("hazy, AOT {}, {} nm", options.aot, options.wavelength_nm);
}

std::string SunText(const sky::SunPosition& sun) {
  std::string text = fmt::format("azimuth {:.5f} deg, elevation {:.5f} deg",
                                 nav::RadToDeg(sun.azimuth_rad), nav::RadToDeg(sun.elevation_rad));
  if (sun.elevation_rad != sun.geometric_elevation_rad) {
    text += fmt::format(" ({:.5f} without refraction)", nav::RadToDeg(sun.geometric_elevation_rad));
  }
  return text;
}

double HighestDop(const sky::ClearSky& sky) {
  double highest = 0.0;
  for (const SkyDirection& d : WholeSky()) {
    const auto light =
        sky.Look(sky::DirectionEnu(nav::DegToRad(d.azimuth_deg), nav::DegToRad(d.elevation_deg)));
    highest = std::max(highest, std::hypot(light.q, light.u));
  }
  return highest;
}

std::string Summary(const sky::ClearSky& sky, const sky::ClearSkyOptions& options) {
  std::string text = fmt::format("sky: {}\nhighest degree of polarization: {:.3f}\n",
                                 ModelText(options), HighestDop(sky));
  text += "neutral points above the horizon:\n";
  for (const sky::NeutralPoint& point : sky::NeutralPoints(sky)) {
    if (point.ray_W.z() < 0.0) continue;
    const double elevation = std::atan2(point.ray_W.z(), point.ray_W.head<2>().norm());
    const double azimuth = std::atan2(point.ray_W.x(), point.ray_W.y());
    const double from_sun =
        std::atan2(point.ray_W.cross(sky.sun_W()).norm(), point.ray_W.dot(sky.sun_W()));
    text += fmt::format(
        "  {:<9} azimuth {:7.2f} deg, elevation {:6.2f} deg, {:6.2f} deg from the sun\n",
        point.name, std::fmod(nav::RadToDeg(azimuth) + 360.0, 360.0), nav::RadToDeg(elevation),
        nav::RadToDeg(from_sun));
  }
  return text;
}

OutputFolder FolderOf(const std::string& file) {
  const fs::path folder = fs::path(file).parent_path();
  if (fs::path(file).filename().empty() || fs::is_directory(file)) {
    throw InputError(file, 0, "", "is a folder, not a file");
  }
  return OutputFolder(folder.empty() ? fs::path(".") : folder);
}

void WriteAtOnce(OutputFolder& folder, const std::string& file, std::string content) {
  folder.Stage(fs::path(file).filename().string(), std::move(content));
  folder.Commit();
}

std::string PngOf(const cv::Mat& image) {
  std::vector<unsigned char> bytes;
  if (!cv::imencode(".png", image, bytes)) throw std::runtime_error("no PNG came out of OpenCV");
  return {bytes.begin(), bytes.end()};
}

}  // namespace

int Sky(const SkyArguments& a, const Console& console) {
  RequireSense(a);
  const sky::SunPosition sun = SunOf(a);
  if (sun.elevation_rad < 0.0) {
    throw InputError(fmt::format("the sun is below the horizon: {}", SunText(sun)));
  }
  const sky::ClearSkyOptions options = OptionsOf(a, console);
  const std::vector<SkyDirection> directions =
      a.directions.empty() ? WholeSky() : ReadDirections(a.directions);
  std::optional<OutputFolder> csv_folder, png_folder;
  if (!a.csv.empty()) csv_folder.emplace(FolderOf(a.csv));
  if (!a.png.empty()) png_folder.emplace(FolderOf(a.png));

  const sky::ClearSky clear(options, sky::DirectionEnu(sun.azimuth_rad, sun.elevation_rad));
  if (csv_folder) WriteAtOnce(*csv_folder, a.csv, SkyCsv(clear, directions));
  if (png_folder) {
    const std::string title = fmt::format("Clear sky: {}", ModelText(options));
    const std::string subtitle = fmt::format(
        "{}sun at {}; zenith in the middle, horizon around, north up, east right",
        a.utc ? fmt::format("{} N, {} E, {}; ", *a.latitude_deg, *a.longitude_deg, *a.utc)
              : std::string(),
        SunText(sun));
    WriteAtOnce(*png_folder, a.png, PngOf(DrawSky(clear, title, subtitle)));
  }
  if (!a.directions.empty() && a.csv.empty()) {
    console.out << SkyCsv(clear, directions);
  } else if (a.csv.empty() && a.png.empty()) {
    console.out << "sun: " << SunText(sun) << "\n" << Summary(clear, options);
  } else {
    console.out << "sun: " << SunText(sun) << "\n";
    for (const std::string& file : {a.csv, a.png}) {
      if (!file.empty()) console.out << "wrote " << file << "\n";
    }
  }
  return kExitHolds;
}

}  // namespace polnav::testbed
