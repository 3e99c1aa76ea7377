#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <opencv2/imgcodecs.hpp>

#include "nav/polarization/compass.h"
#include "nav/polarization/turn_calibration.h"
#include "sky/mosaic.h"
#include "sky/sun.h"
#include "tools/polnav/commands.h"
#include "tools/testbed/camera_file.h"
#include "tools/testbed/compass_picture.h"
#include "tools/testbed/input_error.h"

namespace polnav::testbed {
namespace {

namespace fs = std::filesystem;
using nav::DegToRad;
using nav::RadToDeg;

constexpr const char* kHeader = "file,status,heading_deg,sigma_deg,axis_deg,dop,used_fraction,ms\n";

struct Row {
  std::string file;
  std::string status;
  std::optional<nav::CompassReading> reading;  // absent: the image is no mosaic of this camera
  double ms = 0.0;
};

std::optional<Eigen::Vector3d> SunOf(const CompassArguments& a) {
  const int placed = (a.lat_deg ? 1 : 0) + (a.lon_deg ? 1 : 0) + (a.utc ? 1 : 0);
  if (placed != 0 && placed != 3) {
    throw InputError("place and time need all of --lat, --lon and --utc");
  }
  if (a.sun_azimuth_deg.has_value() != a.sun_elevation_deg.has_value()) {
    throw InputError("the sun needs both --sun-elevation-deg and --sun-azimuth-deg");
  }
  if (placed != 0 && a.sun_azimuth_deg) throw InputError("the sun is given twice");
  if (placed == 0 && !a.sun_azimuth_deg) return std::nullopt;
  double azimuth = DegToRad(a.sun_azimuth_deg.value_or(0.0));
  double elevation = DegToRad(a.sun_elevation_deg.value_or(0.0));
  if (placed != 0) {
    const auto utc = sky::ParseUtc(*a.utc);
    if (!utc) throw InputError("", 0, "--utc " + *a.utc, "expected YYYY-MM-DDTHH:MM:SSZ");
    const sky::SunPosition sun = sky::ComputeSun(
        {.latitude_rad = DegToRad(*a.lat_deg), .longitude_rad = DegToRad(*a.lon_deg)}, *utc);
    azimuth = sun.azimuth_rad;
    elevation = sun.elevation_rad;
  }
  if (elevation < 0.0) {
    throw InputError(
        fmt::format("the sun is {:.2f} degrees below the horizon: no heading by "
                    "Rayleigh's sky",
                    -RadToDeg(elevation)));
  }
  return sky::DirectionEnu(azimuth, elevation);
}

cv::Mat ReadMosaic(const std::string& file) {
  if (!fs::is_regular_file(file)) throw InputError(file, 0, "", "no such file");
  cv::Mat image;
  try {
    image = cv::imread(file, cv::IMREAD_UNCHANGED);
  } catch (const cv::Exception&) {  // the same to a user as an empty one
  }
  if (image.empty()) throw InputError(file, 0, "", "no image that can be read");
  if (image.channels() != 1) {
    throw InputError(file, 0, "",
                     fmt::format("a raw mosaic has one channel; this has {}", image.channels()));
  }
  if (image.depth() != CV_8U && image.depth() != CV_16U) {
    throw InputError(file, 0, "", "a raw mosaic has 8 or 16 bits a pixel");
  }
  if (image.cols % 2 != 0 || image.rows % 2 != 0 || image.cols < 16 || image.rows < 16) {
    throw InputError(file, 0, "",
                     fmt::format("a mosaic has even sides of at least 16 pixels; this is {} x {}",
                                 image.cols, image.rows));
  }
  return image;
}

// As the options describe it, for pictures like the first that can be read.
nav::PolarizationCameraCalibration CameraOf(const CompassArguments& a) {
  if (!a.calibration.empty()) return ReadCameraFile(a.calibration);
  nav::PolarizationCameraCalibration camera;
  camera.polarizer_rad = sky::ParseLayout(a.layout);
  for (const std::string& file : a.images) {
    try {
      const cv::Mat image = ReadMosaic(file);
      camera.width_px = image.cols;
      camera.height_px = image.rows;
      camera.bits = image.depth() == CV_16U ? a.bits.value_or(12) : 8;
      break;
    } catch (const InputError&) {  // said when its row is made
    }
  }
  if (camera.width_px == 0) {
    static_cast<void>(ReadMosaic(a.images.front()));  // says why
  }
  camera.lens.model =
      a.lens == "equidistant" ? nav::LensModel::kEquidistant : nav::LensModel::kPinhole;
  camera.lens.focal_px = a.focal_px.value_or(std::max(camera.width_px, camera.height_px));
  camera.lens.center_px = {0.5 * (camera.width_px - 1), 0.5 * (camera.height_px - 1)};
  if (a.center_px.size() == 2) camera.lens.center_px = {a.center_px[0], a.center_px[1]};
  // What nobody calibrated may be off by this much.
  camera.gain_sigma = 0.005;
  camera.offset_sigma = 0.001;
  camera.polarizer_sigma_rad = DegToRad(0.2);
  camera.center_sigma_px = 2.0;
  return camera;
}

nav::CompassOptions OptionsOf(const CompassArguments& a) {
  nav::CompassOptions options;
  options.method = a.method;
  options.radius_px = a.radius_px.value_or(0.0);
  if (a.min_elevation_deg) options.min_elevation_deg = *a.min_elevation_deg;
  return options;
}

std::string NumberedPng(const std::string& png, std::size_t index, std::size_t count) {
  if (count == 1) return png;
  const fs::path path(png);
  return (path.parent_path() /
          fmt::format("{}_{:03d}{}", path.stem().string(), index, path.extension().string()))
      .string();
}

Row RowOf(const CompassArguments& a, const nav::Compass& compass,
          const nav::PolarizationCameraCalibration& camera,
          const std::optional<Eigen::Vector3d>& sun_W, std::size_t index) {
  Row row{.file = a.images[index]};
  try {
    const cv::Mat mosaic = ReadMosaic(row.file);
    const nav::Tilt tilt{.roll_rad = DegToRad(a.roll_deg), .pitch_rad = DegToRad(a.pitch_deg)};
    nav::CompassTrace trace;
    const auto start = std::chrono::steady_clock::now();
    row.reading = compass.Read(mosaic, sun_W, tilt, a.png.empty() ? nullptr : &trace);
    row.ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    row.status = StatusText(*row.reading);
    if (!a.png.empty()) {
      const std::string png = NumberedPng(a.png, index, a.images.size());
      if (!cv::imwrite(png, CompassPicture(trace, *row.reading, camera))) {
        throw InputError(png, 0, "", "cannot be written");
      }
    }
  } catch (const std::invalid_argument& error) {  // not as calibrated
    row.status = std::string("bad input: ") + error.what();
  } catch (const InputError& error) {
    row.status = std::string("bad input: ") + error.what();
  }
  return row;
}

// Empty where there is no such number.
std::vector<std::optional<double>> Numbers(const Row& row) {
  if (!row.reading) return std::vector<std::optional<double>>(6);
  const nav::CompassReading& r = *row.reading;
  const bool any = r.status != nav::CompassStatus::kNone;
  std::vector<std::optional<double>> numbers(6);
  if (r.status == nav::CompassStatus::kHeading) {
    const double degrees = RadToDeg(r.heading_rad);
    numbers[0] = degrees < 0.0 ? degrees + 360.0 : degrees;
  }
  if (r.status == nav::CompassStatus::kHalfTurn) {  // of the two, the one below half a turn
    numbers[0] = std::fmod(RadToDeg(r.heading_rad) + 360.0, 180.0);
  }
  if (any) numbers[1] = RadToDeg(r.sigma_rad);
  if (any) {
    const double degrees = RadToDeg(r.axis_rad);
    numbers[2] = degrees < 0.0 ? degrees + 180.0 : degrees;
  }
  numbers[3] = r.dop;
  numbers[4] = r.used_fraction;
  numbers[5] = row.ms;
  return numbers;
}

std::string Csv(const std::vector<Row>& rows) {
  std::string text = kHeader;
  for (const Row& row : rows) {
    std::string status = row.status;
    std::replace(status.begin(), status.end(), ',', ';');
    text += row.file + "," + status;
    for (const std::optional<double>& number : Numbers(row)) {
      text += number ? fmt::format(",{:.4f}", *number) : ",";
    }
    text += "\n";
  }
  return text;
}

Json ToJson(const std::vector<Row>& rows) {
  Json json = Json::array();
  const char* const names[] = {"heading_deg", "sigma_deg",     "axis_deg",
                               "dop",         "used_fraction", "ms"};
  for (const Row& row : rows) {
    Json object = {{"file", row.file}, {"status", row.status}};
    const auto numbers = Numbers(row);
    for (std::size_t k = 0; k < numbers.size(); ++k) {
      object[names[k]] = numbers[k] ? Json(*numbers[k]) : Json(nullptr);
    }
    json.push_back(object);
  }
  return json;
}

std::string HeldOutText(const char* when, const nav::HeldOut& held_out) {
  std::string text = fmt::format("  {}: opponent pairs {:.5f}, across Rayleigh {:.5f}", when,
                                 held_out.pairs, held_out.across);
  if (held_out.heading_rad) {
    text += fmt::format(", heading {:.4f} deg", RadToDeg(*held_out.heading_rad));
  }
  return text + "\n";
}

int Calibrate(const CompassArguments& a, const nav::PolarizationCameraCalibration& camera,
              const std::optional<Eigen::Vector3d>& sun_W, const Console& console) {
  if (!sun_W) throw InputError("--calibrate needs the sun");
  if (!a.headings_deg.empty() && a.headings_deg.size() != a.images.size()) {
    throw InputError(fmt::format("--headings-deg: {} headings for {} images", a.headings_deg.size(),
                                 a.images.size()));
  }
  std::vector<nav::TurnPicture> pictures;
  for (std::size_t i = 0; i < a.images.size(); ++i) {
    nav::TurnPicture picture{.mosaic = ReadMosaic(a.images[i]), .sun_W = *sun_W};
    if (!a.headings_deg.empty()) picture.heading_rad = DegToRad(a.headings_deg[i]);
    pictures.push_back(picture);
  }
  const nav::TurnCalibration turn = nav::CalibrateFromTurn(OptionsOf(a), camera, pictures);
  WriteCameraFile(a.calibrate, turn.calibration);
  console.out << fmt::format("{}: {} pictures, {} held out in turn; RMS on those\n", a.calibrate,
                             turn.pictures, turn.held_out)
              << HeldOutText("before", turn.before) << HeldOutText("after", turn.after);
  return kExitHolds;
}

}  // namespace

int CompassReadings(const CompassArguments& a, const Console& console) {
  const std::optional<Eigen::Vector3d> sun_W = SunOf(a);
  const nav::PolarizationCameraCalibration camera = CameraOf(a);
  if (!a.calibrate.empty()) return Calibrate(a, camera, sun_W, console);
  const nav::Compass compass(OptionsOf(a), camera);
  std::vector<Row> rows;
  bool bad = false;
  for (std::size_t i = 0; i < a.images.size(); ++i) {
    rows.push_back(RowOf(a, compass, camera, sun_W, i));
    if (rows.back().reading) continue;
    bad = true;
    console.err << "polnav: " << rows.back().file << ": " << rows.back().status << "\n";
  }
  if (!a.csv.empty()) {
    std::ofstream out(a.csv);
    out << Csv(rows);
    if (!out) throw InputError(a.csv, 0, "", "cannot be written");
  }
  if (a.json) {
    console.out << ToJson(rows).dump(2) << "\n";
  } else if (a.csv.empty()) {
    console.out << Csv(rows);
  }
  return bad ? kExitBadInput : kExitHolds;
}

}  // namespace polnav::testbed
