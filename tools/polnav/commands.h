// What does each command do, once its arguments are understood?
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/polnav/command_line.h"
#include "tools/polnav/console.h"

namespace polnav::testbed {

struct RunArguments {
  std::string scenario;
  std::string out;                  // empty: out/<scenario's file name>
  std::optional<std::string> seed;  // checked with the scenario, as every option is
  std::vector<std::string> set;
  std::vector<std::string> estimators;  // empty: as the scenario says
  std::optional<std::string> duration_s;
  std::string level = "image";
  int render_threads = 1;
  std::string record;  // folder; empty: nothing is recorded
  bool quiet = false;
  bool json = false;
  std::string command_line;  // as typed, for the report
};

struct ReplayArguments {
  std::string dataset;
  std::string out;  // empty: out/replay_<dataset>
  std::string rig;  // file; empty: as the dataset says
  std::optional<std::string> seed;
  std::vector<std::string> set;
  std::vector<std::string> estimators;
  std::string align;  // none, yaw, se3; empty: none with a scenario.yaml, else se3
  bool quiet = false;
  bool json = false;
  std::string command_line;
};

struct StudyArguments {
  std::string study;
  std::string out;                    // file; empty: out/<study's file name>.sqlite
  std::optional<std::string> trials;  // checked with the study, as every key is
  std::optional<std::string> level;
  std::optional<int> jobs;           // absent: as many as processors
  std::optional<std::string> shard;  // K/N; absent: as Slurm or Kubernetes say, or all
  std::optional<std::uint64_t> trial;
  bool retry_failed = false;
  bool mix_builds = false;
  bool quiet = false;
};

struct MergeArguments {
  std::string out;
  std::vector<std::string> inputs;
  bool mix_builds = false;
  bool quiet = false;
};

struct ReportArguments {
  std::string path;  // result file of a study, or folder of a run
  std::string out;   // HTML; empty: beside the result file
  std::string summary_csv;
  std::string csv;  // empty: none
  bool quiet = false;
  bool json = false;
};

struct EvaluateArguments {
  std::string truth;
  std::string estimate;
  std::string align = "none";
  bool json = false;
};

// The sun either by place and time or as it stands.
struct SkyArguments {
  std::optional<double> latitude_deg;
  std::optional<double> longitude_deg;
  std::optional<std::string> utc;
  std::optional<double> sun_elevation_deg;
  std::optional<double> sun_azimuth_deg;
  std::string model = "hazy";
  std::optional<double> aot;
  std::optional<double> wavelength_nm;
  std::optional<double> max_dop;
  std::string directions;  // empty: the whole sky
  std::string csv;
  std::string png;
};

// Angles as typed; absent: not given.
struct CompassArguments {
  std::vector<std::string> images;
  std::string layout = "90,45/135,0";
  std::string lens = "pinhole";
  std::optional<double> focal_px;  // absent: the longer side of the image
  std::vector<double> center_px;   // x, y; empty: the middle
  std::optional<double> radius_px;
  std::optional<double> min_elevation_deg;
  std::optional<int> bits;  // of 16-bit files; absent: 12
  std::string method = "stokes";
  std::optional<double> sun_elevation_deg;
  std::optional<double> sun_azimuth_deg;
  std::optional<double> lat_deg;
  std::optional<double> lon_deg;
  std::optional<std::string> utc;
  double roll_deg = 0.0;
  double pitch_deg = 0.0;
  std::string calibration;           // file to read
  std::string calibrate;             // file to write
  std::vector<double> headings_deg;  // of the turn's pictures
  std::string csv;
  std::string png;
  bool json = false;
};

// Simulate, estimate, score; write and print the results.
[[nodiscard]] int Run(const RunArguments& arguments, const Console& console,
                      const ClosedLoop& closed_loop);

// Recorded instead of simulated: estimate, score; write and print the results.
[[nodiscard]] int ReplayDataset(const ReplayArguments& arguments, const Console& console);

// Run what is missing of a study, or one of its trials again.
[[nodiscard]] int Study(const StudyArguments& arguments, const Console& console,
                        const ClosedLoop& closed_loop);

// Shards of a study into one file.
[[nodiscard]] int Merge(const MergeArguments& arguments, const Console& console);

// Compare two TUM files.
[[nodiscard]] int Evaluate(const EvaluateArguments& arguments, const Console& console);

// Where the sun is; the sky's light as a table, a picture or a summary.
[[nodiscard]] int Sky(const SkyArguments& arguments, const Console& console);

// Headings of raw polarization images, or a calibration from a turn of them.
[[nodiscard]] int CompassReadings(const CompassArguments& arguments, const Console& console);

// HTML, JUnit, table and verdict of a study; where those of a run are.
[[nodiscard]] int Report(const ReportArguments& arguments, const Console& console);

// Scenarios, studies, estimators, metrics.
[[nodiscard]] int List(const Console& console);

}  // namespace polnav::testbed
