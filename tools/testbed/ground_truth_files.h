// Where does the ground truth of the left camera's frames go?
//
// One folder a run, docs/ground_truth.md says what is in it. Frames are written while the run goes
// on (a minute of them is a gigabyte in memory), under a temporary name; Commit gives the folder
// its own, and takes the place of one from an earlier run. Without Commit nothing is left behind.
#pragma once

#include <filesystem>
#include <fstream>

#include "nav/api/calibration.h"
#include "sim/sensors/frame_truth.h"

namespace polnav::testbed {

class GroundTruthFiles {
 public:
  // Both throw InputError when the disk does not take it.
  GroundTruthFiles(std::filesystem::path folder, const nav::StereoCalibration& true_cameras);
  void Write(const sim::FrameTruth& truth);

  void Commit();
  ~GroundTruthFiles();
  GroundTruthFiles(const GroundTruthFiles&) = delete;
  GroundTruthFiles& operator=(const GroundTruthFiles&) = delete;

 private:
  void WriteImage(const char* kind, std::uint64_t index, const cv::Mat& image) const;

  std::filesystem::path folder_;
  std::filesystem::path partial_;
  std::ofstream frames_;
};

// As 16-bit PNGs hold them.
// Depth in millimetres: 0 is the sky, 65535 anything beyond 65.534 m.
[[nodiscard]] cv::Mat DepthInMillimetres(const cv::Mat& depth_m);
// KITTI's [Geiger2012]: OpenCV's channels B G R are valid, v, u; flow = (value - 32768) / 64 px.
[[nodiscard]] cv::Mat FlowAsInKitti(const cv::Mat& flow_px);

}  // namespace polnav::testbed
