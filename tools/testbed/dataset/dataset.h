// What did the sensors of a recorded dataset say, in order?
//
// EuRoC ASL folders [Burri2016], Polnav's own recordings among them, and KITTI odometry sequences
// [Geiger2012]. All streams are merged by stamp; at equal stamps in the order in which the
// simulator emits them: truth, imu, polarimeter, reference, flow, stereo, polarization_camera.
// Pictures are loaded one at a time, when it is their turn; one that is missing, unreadable or of
// another size is noted and left out.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "nav/api/calibration.h"
#include "nav/api/measurements.h"
#include "sim/truth.h"
#include "tools/testbed/input_error.h"

namespace polnav::testbed {

struct DatasetInfo {
  std::string format;                   // "euroc", "kitti"
  std::string name;                     // the folder's
  std::filesystem::path scenario_file;  // empty: there is none
  nav::Rig rig;
  bool has_reference = false;
  bool has_truth = false;
  // Stamps in the files less this are what Next() hands out.
  nav::TimeNs epoch = 0;
  nav::TimeNs duration = 0;  // from the epoch to the last stamp
};

// Pictures on disk that belong to one stamp.
struct PairFiles {
  nav::TimeNs stamp = 0;
  std::filesystem::path left;
  std::filesystem::path right;
};
struct MosaicFile {
  nav::TimeNs stamp = 0;
  std::filesystem::path file;
};
// A frame that cannot be used, and why.
struct BrokenFrame {
  nav::TimeNs stamp = 0;
  std::string problem;
};

using DatasetEntry =
    std::variant<sim::Truth, nav::ImuSample, nav::PolarizationSample, nav::ReferencePose,
                 nav::OpticalFlowSample, PairFiles, MosaicFile, BrokenFrame>;

// One stream, in order of stamps; nothing at its end. Throws InputError for a broken line.
using EntrySource = std::function<std::optional<DatasetEntry>()>;

using DatasetItem = std::variant<sim::Truth, nav::Measurement>;

class Dataset {
 public:
  // sources: in the order in which they come at equal stamps.
  Dataset(DatasetInfo info, std::vector<EntrySource> sources);

  [[nodiscard]] const DatasetInfo& info() const { return info_; }

  // Nothing at the end. Throws InputError where a file is broken; what came before is good.
  [[nodiscard]] std::optional<DatasetItem> Next();

  // Frames left out so far, one reason each.
  [[nodiscard]] const std::vector<std::string>& problems() const { return problems_; }

 private:
  struct Stream {
    EntrySource next;
    std::optional<DatasetEntry> head;
  };

  void Advance(Stream& stream);

  [[nodiscard]] std::optional<DatasetEntry> TakeEarliest();
  [[nodiscard]] std::optional<DatasetItem> Load(const DatasetEntry& entry);
  [[nodiscard]] std::optional<DatasetItem> LoadPair(const PairFiles& files);
  [[nodiscard]] std::optional<DatasetItem> LoadSky(const MosaicFile& file);

  DatasetInfo info_;
  std::vector<Stream> streams_;
  // A broken line, and the stamp before it: what other streams say until then still comes out.
  std::optional<InputError> failure_;
  nav::TimeNs good_until_ = 0;
  std::vector<std::string> problems_;
};

[[nodiscard]] nav::TimeNs StampOf(const DatasetEntry& entry);

// A folder with mav0 in it, mav0 itself, or a KITTI odometry sequence. rig_file: calibrations that
// take the place of the dataset's; may be empty. Throws InputError: neither of these, a calibration
// or table that is missing or cannot be.
[[nodiscard]] Dataset OpenDataset(const std::filesystem::path& folder,
                                  const std::filesystem::path& rig_file);

}  // namespace polnav::testbed
