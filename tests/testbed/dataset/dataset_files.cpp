#include "tests/testbed/dataset/dataset_files.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "tools/testbed/dataset/euroc_writer.h"

namespace polnav::testbed {
namespace {

namespace fs = std::filesystem;

cv::Mat Noise(const cv::Size& size, int type, int seed) {
  cv::Mat image(size, type);
  cv::RNG random(static_cast<std::uint64_t>(seed) + 1);
  random.fill(image, cv::RNG::UNIFORM, 0, type == CV_16UC1 ? 4096 : 256);
  return image;
}

// No short decimal, different for every k.
double Odd(int k) { return std::sin(1.0 + k) / 3.0; }

Eigen::Vector3d OddVector(int k) { return {Odd(k), -Odd(k + 7), 1e-9 * Odd(k + 13)}; }

nav::Pose OddPose(int k) {
  return {Eigen::Quaterniond(1.0, Odd(k), Odd(k + 1), Odd(k + 2)).normalized(), OddVector(k)};
}

void AddDue(int t_ms, const sim::SensorOptions& sensors, std::vector<DatasetItem>& items) {
  const nav::TimeNs stamp = t_ms * 1'000'000LL;
  const auto say = [&](const nav::Measurement& m) { items.emplace_back(m); };
  if (t_ms % 100 == 0) {
    sim::Truth truth{stamp, OddPose(t_ms), OddVector(t_ms + 1), OddVector(t_ms + 2)};
    truth.imu_bias = sim::ImuBias{OddVector(t_ms + 3), OddVector(t_ms + 4)};
    items.emplace_back(truth);
  }
  if (t_ms > 0) say(nav::ImuSample{stamp, OddVector(t_ms), OddVector(t_ms + 3)});
  if (t_ms % 50 == 0) {
    nav::PolarizationSample light{.stamp = stamp};
    for (int i = 0; i < 6; ++i) light.channel[static_cast<std::size_t>(i)] = Odd(t_ms + i);
    say(light);
    say(nav::ReferencePose{stamp, OddPose(t_ms + 5), OddVector(t_ms), t_ms % 100 == 0});
  }
  if (t_ms > 0 && t_ms % 20 == 0) {
    nav::OpticalFlowSample flow{.stamp = stamp, .integration = 20'000'000 - t_ms};
    flow.flow_rad = {Odd(t_ms), Odd(t_ms + 1)};
    flow.gyro_rad = OddVector(t_ms + 2);
    if (t_ms % 40 == 0) flow.range_m = 0.4 + Odd(t_ms + 3);
    flow.quality = 0.5 + Odd(t_ms + 4);
    say(flow);
  }
  if (t_ms % 100 == 0) {
    const cv::Size pair(sensors.stereo->width_px, sensors.stereo->height_px);
    say(nav::StereoImages{stamp, Noise(pair, CV_8UC1, t_ms), Noise(pair, CV_8UC1, t_ms + 1)});
    const cv::Size sky(sensors.polarization_camera->width_px,
                       sensors.polarization_camera->height_px);
    say(nav::PolarizationImage{stamp, Noise(sky, CV_16UC1, t_ms)});
  }
}

}  // namespace

Scenario SmallScenario() {
  return ParseScenario(R"(name: small
duration_s: 0.5
seed: 5
site: {latitude_deg: 38.832, longitude_deg: 121.503, utc: 2020-11-11T07:00:00Z}
sensors:
  stereo: {width_px: 160, height_px: 120, focal_px: 100}
  imu: {rate_hz: 100}
  polarimeter: {rate_hz: 20}
  polarization_camera: {width_px: 32, height_px: 24, bits: 12}
  reference: {rate_hz: 20}
  optical_flow: {rate_hz: 50}
estimators: {run: [stereo]}
)",
                       "small.yaml");
}

std::vector<DatasetItem> SmallRecording(const Scenario& scenario) {
  std::vector<DatasetItem> items;
  for (int t_ms = 0; t_ms <= 500; t_ms += 10) AddDue(t_ms, scenario.sensors, items);
  return items;
}

void WriteRecording(const fs::path& folder, const Scenario& scenario,
                    const std::vector<DatasetItem>& items) {
  EurocWriter writer(folder, scenario, sim::NominalRig(scenario.sensors));
  for (const DatasetItem& item : items) {
    std::visit([&](const auto& said) { writer.Write(said); }, item);
  }
}

void MakeForeign(const fs::path& folder) {
  fs::remove(folder / "scenario.yaml");
  fs::remove(folder / "mav0" / "body.yaml");
}

std::vector<DatasetItem> ReadAll(Dataset& dataset) {
  std::vector<DatasetItem> items;
  while (const auto item = dataset.Next()) items.push_back(*item);
  return items;
}

void WriteKitti(const fs::path& folder, int frames, bool with_truth) {
  fs::create_directories(folder / "image_0");
  fs::create_directories(folder / "image_1");
  // 10 px of disparity are 20 m with f = 200 px and a baseline of 1 m.
  WriteText(folder / "calib.txt",
            "P0: 2e2 0 160 0 0 2e2 80 0 0 0 1 0\nP1: 2e2 0 160 -2e2 0 2e2 80 0 0 0 1 0\n");
  std::string times;
  std::string poses;
  cv::Mat wall = Noise({340, 160}, CV_8UC1, 1);
  cv::GaussianBlur(wall, wall, {5, 5}, 1.5);
  cv::normalize(wall, wall, 0, 240, cv::NORM_MINMAX);
  for (int i = 0; i < frames; ++i) {
    times += fmt::format("{:e}\n", 0.1 * i);
    poses += "1 0 0 0 0 1 0 0 0 0 1 0\n";
    const cv::Mat seen = wall + Noise(wall.size(), CV_8UC1, i) / 64;  // no two frames are equal
    const std::string name = fmt::format("{:06}.png", i);
    cv::imwrite((folder / "image_0" / name).string(), seen.colRange(0, 320));
    cv::imwrite((folder / "image_1" / name).string(), seen.colRange(10, 330));
  }
  WriteText(folder / "times.txt", times);
  if (with_truth) WriteText(folder / "poses.txt", poses);
}

std::string ReadText(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void WriteText(const fs::path& file, const std::string& text) {
  std::ofstream(file, std::ios::binary | std::ios::trunc) << text;
}

void Replace(const fs::path& file, const std::string& what, const std::string& with) {
  std::string text = ReadText(file);
  const std::size_t at = text.find(what);
  if (at == std::string::npos) throw std::logic_error(what + " is not in " + file.string());
  WriteText(file, text.replace(at, what.size(), with));
}

}  // namespace polnav::testbed
