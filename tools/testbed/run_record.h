// What came out of one closed-loop run, before anybody judges it?
//
// Filled by the closed loop; read by the score, result.json and the report. Wall times are for
// reporting only.
#pragma once

#include <cstdint>
#include <map>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "nav/api/estimate.h"
#include "nav/api/time.h"
#include "sim/truth.h"
#include "tools/testbed/diagnostics.h"
#include "tools/testbed/force_spectrum.h"
#include "tools/testbed/pose_errors.h"

namespace polnav::testbed {

// What became of the measurements that an estimator was given.
struct OutcomeCounts {
  std::uint64_t used = 0;
  std::uint64_t gated = 0;
  std::uint64_t unusable = 0;
  std::uint64_t ignored = 0;
  std::uint64_t keyframes = 0;
  std::uint64_t features = 0;  // offered
  std::uint64_t inliers = 0;
  std::uint64_t flow_rejected = 0;   // moved otherwise than the scene [Chu2021, eq. 12]
  std::uint64_t pose_rejected = 0;   // outliers of the pose
  std::uint64_t map_rejected = 0;    // landmarks that the bundle adjustment took out
  std::uint64_t imu_wrong = 0;       // frames; see nav/stereo/pose_judge.h
  std::uint64_t pictures_wrong = 0;  // likewise
  std::uint64_t gated_readings = 0;
  std::uint64_t returns = 0;  // places recognized
  std::uint64_t failed_solves = 0;

  void Add(const nav::Report& report);
};

struct EstimatorRun {
  std::string name;
  bool heading_only = false;             // a compass: the rest of its poses means nothing
  std::vector<nav::Estimate> estimates;  // in order of stamps
  std::string sha256;                    // of the estimates
  OutcomeCounts counts;
  Diagnostics diagnostics;
  // How the estimates were moved onto the truth before they are judged; see AlignToTruth.
  Alignment alignment = Alignment::kNone;
};

struct StreamRecord {
  std::uint64_t count = 0;
  std::string sha256;
};

struct StageTiming {
  std::vector<double> ms;  // one entry a call
};

// As the sensor delivered it, CV_8UC1 or CV_8UC3.
struct SampleImage {
  std::string title;
  nav::TimeNs stamp = 0;
  cv::Mat image;
};

// The heading that one polarization sample alone would give, against the truth.
struct HeadingReading {
  double t_s = 0.0;
  double error_rad = 0.0;
};

// A part of the run.
struct Stretch {
  double begin_s = 0.0;
  double end_s = 0.0;
};

struct RunRecord {
  std::vector<sim::Truth> truth;   // at the cameras' rate
  std::vector<Stretch> disturbed;  // see disturbed_times.h
  std::vector<EstimatorRun> estimators;
  std::map<std::string, StreamRecord> streams;
  std::map<std::string, StageTiming> timing;
  std::vector<SampleImage> images;
  std::vector<HeadingReading> polarization_readings;
  std::optional<ForceLines> force;  // of the accelerometers; absent without, or too short
  double sim_duration_s = 0.0;
  double wall_s = 0.0;
  double peak_rss_mb = 0.0;
  std::vector<double> rss_mb;  // at equal intervals over the run
};

// The record with each estimator's poses moved onto the truth, for scores and charts of datasets
// whose world nobody told the estimators. A compass, or a path that does not determine the
// alignment, stays as it is.
[[nodiscard]] RunRecord AlignToTruth(RunRecord record, Alignment alignment);

// SHA-256 over every byte of every estimate, in order.
[[nodiscard]] std::string HashOf(const std::vector<nav::Estimate>& estimates);

}  // namespace polnav::testbed
