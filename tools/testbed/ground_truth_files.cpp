#include "tools/testbed/ground_truth_files.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>

#include "tools/testbed/camera_file.h"
#include "tools/testbed/input_error.h"

namespace polnav::testbed {
namespace {

constexpr float kFarthest = 65535.0F;

[[noreturn]] void Fail(const std::filesystem::path& file) {
  throw InputError(file.string(), 0, "", "cannot be written");
}

}  // namespace

cv::Mat DepthInMillimetres(const cv::Mat& depth_m) {
  cv::Mat mm(depth_m.size(), CV_16UC1);
  for (int row = 0; row < mm.rows; ++row) {
    for (int col = 0; col < mm.cols; ++col) {
      const float depth = depth_m.at<float>(row, col);
      const float value = std::isinf(depth) ? 0.0F : std::clamp(1000.0F * depth, 1.0F, kFarthest);
      mm.at<std::uint16_t>(row, col) = static_cast<std::uint16_t>(std::lround(value));
    }
  }
  return mm;
}

cv::Mat FlowAsInKitti(const cv::Mat& flow_px) {
  cv::Mat coded(flow_px.size(), CV_16UC3, cv::Scalar(0, 0, 0));
  for (int row = 0; row < coded.rows; ++row) {
    for (int col = 0; col < coded.cols; ++col) {
      const cv::Vec2f flow = flow_px.at<cv::Vec2f>(row, col);
      const float u = std::round(64.0F * flow[0]) + 32768.0F;
      const float v = std::round(64.0F * flow[1]) + 32768.0F;
      // Also false where there is no flow.
      const bool fits = u >= 0.0F && u <= 65535.0F && v >= 0.0F && v <= 65535.0F;
      if (!fits) continue;
      coded.at<cv::Vec3w>(row, col) = {1, static_cast<std::uint16_t>(v),
                                       static_cast<std::uint16_t>(u)};
    }
  }
  return coded;
}

GroundTruthFiles::GroundTruthFiles(std::filesystem::path folder,
                                   const nav::StereoCalibration& true_cameras)
    : folder_(std::move(folder)), partial_(folder_.string() + ".partial") {
  std::error_code error;
  std::filesystem::remove_all(partial_, error);
  for (const char* kind : {"depth", "instance", "flow", "moving"}) {
    std::filesystem::create_directories(partial_ / kind, error);
    if (error) Fail(partial_ / kind);
  }
  std::ofstream cameras(partial_ / "cameras.json");
  cameras << ToJson(true_cameras).dump(2) << "\n";
  if (!cameras) Fail(partial_ / "cameras.json");
  frames_.open(partial_ / "frames.csv");
  frames_ << "index,stamp_ns\n";
}

GroundTruthFiles::~GroundTruthFiles() {
  std::error_code ignored;
  std::filesystem::remove_all(partial_, ignored);
}

void GroundTruthFiles::WriteImage(const char* kind, std::uint64_t index,
                                  const cv::Mat& image) const {
  const std::filesystem::path file = partial_ / kind / fmt::format("{:06}.png", index);
  if (!cv::imwrite(file.string(), image)) Fail(file);
}

void GroundTruthFiles::Write(const sim::FrameTruth& truth) {
  WriteImage("depth", truth.index, DepthInMillimetres(truth.depth_m));
  WriteImage("instance", truth.index, truth.instance);
  WriteImage("flow", truth.index, FlowAsInKitti(truth.flow_px));
  WriteImage("moving", truth.index, truth.moving);
  frames_ << truth.index << "," << truth.stamp << "\n";
  if (!frames_) Fail(partial_ / "frames.csv");
}

void GroundTruthFiles::Commit() {
  frames_.close();
  std::error_code error;
  std::filesystem::remove_all(folder_, error);
  std::filesystem::rename(partial_, folder_, error);
  if (error) Fail(folder_);
}

}  // namespace polnav::testbed
