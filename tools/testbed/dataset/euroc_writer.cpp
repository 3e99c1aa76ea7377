#include "tools/testbed/dataset/euroc_writer.h"

#include <fmt/format.h>

#include <opencv2/imgcodecs.hpp>

#include "tools/testbed/dataset/calibration_yaml.h"
#include "tools/testbed/dataset/euroc_rows.h"
#include "tools/testbed/input_error.h"
#include "tools/testbed/option_tree.h"

namespace polnav::testbed {
namespace {

namespace fs = std::filesystem;

constexpr const char* kMark = "comment: recorded by Polnav";
constexpr int kPngLevel = 1;  // a third larger than the best, many times faster

[[noreturn]] void Fail(const fs::path& file) {
  throw InputError(file.string(), 0, "", "cannot be written; is the disk full?");
}

void WriteText(const fs::path& file, const std::string& text) {
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  stream << text << std::flush;
  if (!stream) Fail(file);
}

void MakeFolder(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(folder.string(), 0, "", "cannot be made: " + error.message());
}

void MakeRoom(const fs::path& folder) {
  const fs::path mav0 = folder / "mav0";
  if (!fs::exists(mav0)) return;
  if (!IsOwnRecording(mav0)) {
    throw InputError(mav0.string(), 0, "",
                     "is another dataset, not one of Polnav's recordings; record elsewhere");
  }
  std::error_code error;
  fs::remove_all(mav0, error);
  if (error) throw InputError(mav0.string(), 0, "", "cannot be replaced: " + error.message());
}

const char* HeaderOf(const std::string& sensor) {
  if (sensor == "imu0") return ImuHeader();
  if (sensor == "pol0") return PolarimeterHeader();
  if (sensor == "ref0") return ReferenceHeader();
  if (sensor == "flow0") return FlowHeader();
  return PictureHeader();
}

bool HasPictures(const std::string& sensor) { return HeaderOf(sensor) == PictureHeader(); }

Json TruthYaml() {
  return {{"sensor_type", "visual-inertial"},
          {"comment", "the simulator's own poses T_WB and the IMU's own biases"}};
}

}  // namespace

bool IsOwnRecording(const fs::path& mav0) {
  std::ifstream stream(mav0 / "body.yaml");
  std::string line;
  return std::getline(stream, line) && line.starts_with(kMark);
}

EurocWriter::EurocWriter(const fs::path& folder, const Scenario& scenario, const nav::Rig& rig)
    : mav0_(folder / "mav0") {
  MakeRoom(folder);
  MakeFolder(mav0_);
  WriteText(mav0_ / "body.yaml", std::string(kMark) + "; scenario.yaml beside mav0 says how\n");
  WriteText(folder / "scenario.yaml", ResolvedYaml(scenario));
  for (const SensorYaml& sensor : SensorYamls(rig, scenario.sensors)) {
    MakeFolder(HasPictures(sensor.folder) ? mav0_ / sensor.folder / "data" : mav0_ / sensor.folder);
    WriteText(mav0_ / sensor.folder / "sensor.yaml", ToYaml(sensor.yaml));
    AddTable(sensor.folder, HeaderOf(sensor.folder));
  }
  MakeFolder(mav0_ / kTruthFolder);
  WriteText(mav0_ / kTruthFolder / "sensor.yaml", ToYaml(TruthYaml()));
  AddTable(kTruthFolder, TruthHeader());
}

void EurocWriter::AddTable(const std::string& sensor, const char* header) {
  tables_[sensor].open(mav0_ / sensor / "data.csv", std::ios::binary | std::ios::trunc);
  AddRow(sensor, header);
}

void EurocWriter::AddRow(const std::string& sensor, const std::string& row) {
  std::ofstream& table = tables_.at(sensor);
  table << row << "\n" << std::flush;
  if (!table) Fail(mav0_ / sensor / "data.csv");
}

// The picture first: a row in the table means that its picture is complete.
void EurocWriter::AddPicture(const std::string& sensor, nav::TimeNs stamp, const cv::Mat& picture) {
  const std::string name = fmt::format("{}.png", stamp);
  const fs::path file = mav0_ / sensor / "data" / name;
  if (!cv::imwrite(file.string(), picture, {cv::IMWRITE_PNG_COMPRESSION, kPngLevel})) Fail(file);
  AddRow(sensor, fmt::format("{},{}", stamp, name));
}

void EurocWriter::Write(const sim::Truth& truth) { AddRow(kTruthFolder, RowOf(truth)); }

void EurocWriter::Write(const nav::Measurement& measurement) {
  if (const auto* imu = std::get_if<nav::ImuSample>(&measurement)) {
    AddRow("imu0", RowOf(*imu));
  } else if (const auto* light = std::get_if<nav::PolarizationSample>(&measurement)) {
    AddRow("pol0", RowOf(*light));
  } else if (const auto* reference = std::get_if<nav::ReferencePose>(&measurement)) {
    AddRow("ref0", RowOf(*reference));
  } else if (const auto* flow = std::get_if<nav::OpticalFlowSample>(&measurement)) {
    AddRow("flow0", RowOf(*flow));
  } else if (const auto* pair = std::get_if<nav::StereoImages>(&measurement)) {
    AddPicture("cam0", pair->stamp, pair->left);
    AddPicture("cam1", pair->stamp, pair->right);
  } else if (const auto* sky = std::get_if<nav::PolarizationImage>(&measurement)) {
    AddPicture("polcam0", sky->stamp, sky->mosaic);
  } else {
    throw std::logic_error(std::string("EurocWriter: no place for the stream ") +
                           nav::StreamName(measurement));
  }
}

}  // namespace polnav::testbed
