// How does a run become a dataset on disk?
//
// A folder in EuRoC's ASL layout [Burri2016], extended in its manner by pol0, polcam0, flow0 and
// ref0; docs/datasets.md has the whole layout. Everything is on disk as soon as Write returns: a
// run that breaks off leaves a dataset that is short, not broken. Pictures are lossless.
#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "nav/api/calibration.h"
#include "nav/api/measurements.h"
#include "sim/truth.h"
#include "tools/testbed/scenario.h"

namespace polnav::testbed {

class EurocWriter {
 public:
  // Takes the place of an earlier recording; refuses a folder that holds any other dataset. rig:
  // what the estimators are told, and nothing of what the sensors really are. Throws InputError
  // when the disk does not take it; so do the two below.
  EurocWriter(const std::filesystem::path& folder, const Scenario& scenario, const nav::Rig& rig);

  void Write(const sim::Truth& truth);
  void Write(const nav::Measurement& measurement);  // as the sensor said it, before any fault

 private:
  void AddTable(const std::string& sensor, const char* header);
  void AddRow(const std::string& sensor, const std::string& row);
  void AddPicture(const std::string& sensor, nav::TimeNs stamp, const cv::Mat& picture);

  std::filesystem::path mav0_;
  std::map<std::string, std::ofstream> tables_;  // data.csv by sensor folder
};

// The folder mav0 was made by an EurocWriter: stamps are the scenario's own time, and B is Polnav's
// body frame.
[[nodiscard]] bool IsOwnRecording(const std::filesystem::path& mav0);

inline constexpr const char* kTruthFolder = "state_groundtruth_estimate0";

}  // namespace polnav::testbed
