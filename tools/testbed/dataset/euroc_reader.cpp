#include "tools/testbed/dataset/euroc_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <memory>

#include "tools/testbed/dataset/body_axes.h"
#include "tools/testbed/dataset/calibration_yaml.h"
#include "tools/testbed/dataset/euroc_rows.h"
#include "tools/testbed/dataset/euroc_writer.h"
#include "tools/testbed/dataset/table_reader.h"
#include "tools/testbed/input_error.h"

namespace polnav::testbed {
namespace {

namespace fs = std::filesystem;

bool Has(const fs::path& mav0, const std::string& sensor) {
  return fs::is_directory(mav0 / sensor);
}

bool HasRows(const fs::path& mav0, const std::string& sensor) {
  return TableReader(mav0 / sensor / "data.csv", TableKind::kStampedCsv).Next().has_value();
}

nav::Rig ReadRig(const fs::path& mav0, const std::optional<RigFile>& file) {
  const auto section = [&](const std::string& sensor) {
    return SectionOf(file, sensor, mav0 / sensor / "sensor.yaml");
  };
  for (const char* sensor : {"cam0", "cam1", "imu0", "pol0", "polcam0", "flow0"}) {
    if (HasSection(file, sensor) && !Has(mav0, sensor)) {
      FailAt(*file, sensor, "the dataset has no such sensor");
    }
  }
  nav::Rig rig;
  if (Has(mav0, "cam0") && Has(mav0, "cam1")) {
    rig.stereo = {CameraFrom(section("cam0")), CameraFrom(section("cam1"))};
    CheckPair(*rig.stereo, section("cam1"));
  }
  if (Has(mav0, "imu0")) rig.imu = ImuFrom(section("imu0"));
  if (Has(mav0, "pol0")) rig.polarimeter = PolarimeterFrom(section("pol0"));
  if (Has(mav0, "polcam0")) rig.polarization_camera = PolarizationCameraFrom(section("polcam0"));
  if (Has(mav0, "flow0")) rig.optical_flow = OpticalFlowFrom(section("flow0"));
  return rig;
}

// One data.csv whose rows are readings, each turned into an entry by `parse`.
template <typename Parse>
EntrySource RowSource(const fs::path& folder, Parse parse) {
  auto reader = std::make_shared<TableReader>(folder / "data.csv", TableKind::kStampedCsv);
  return [reader, parse]() -> std::optional<DatasetEntry> {
    const std::optional<TableRow> row = reader->Next();
    if (!row) return std::nullopt;
    return parse(*reader, *row);
  };
}

// The pictures of one camera: stamp and file.
class PictureTable {
 public:
  explicit PictureTable(const fs::path& folder)
      : folder_(folder), reader_(folder / "data.csv", TableKind::kStampedCsv) {
    Advance();
  }
  void Advance() {
    next_ = reader_.Next();
    if (!next_) return;
    reader_.ExpectFields(*next_, {1});
    const std::string& name = next_->fields[0];
    if (name.empty()) reader_.Fail("expected a file's name");
  }
  [[nodiscard]] bool AtEnd() const { return !next_; }
  [[nodiscard]] nav::TimeNs stamp() const { return next_->stamp; }
  [[nodiscard]] fs::path file() const { return folder_ / "data" / next_->fields[0]; }
  [[nodiscard]] const fs::path& folder() const { return folder_; }

 private:
  fs::path folder_;
  TableReader reader_;
  std::optional<TableRow> next_;
};

// A picture without the other one of its pair is no frame.
DatasetEntry Alone(PictureTable& here, const PictureTable& other) {
  BrokenFrame frame{here.stamp(), fmt::format("{}: its pair is not in {}", here.file().string(),
                                              (other.folder() / "data.csv").string())};
  here.Advance();
  return frame;
}

std::optional<DatasetEntry> NextPair(PictureTable& left, PictureTable& right) {
  if (left.AtEnd() && right.AtEnd()) return std::nullopt;
  if (right.AtEnd() || (!left.AtEnd() && left.stamp() < right.stamp())) return Alone(left, right);
  if (left.AtEnd() || right.stamp() < left.stamp()) return Alone(right, left);
  PairFiles pair{left.stamp(), left.file(), right.file()};
  left.Advance();
  right.Advance();
  return pair;
}

EntrySource PairSource(const fs::path& mav0) {
  auto left = std::make_shared<PictureTable>(mav0 / "cam0");
  auto right = std::make_shared<PictureTable>(mav0 / "cam1");
  return [left, right] { return NextPair(*left, *right); };
}

EntrySource MosaicSource(const fs::path& folder) {
  auto table = std::make_shared<PictureTable>(folder);
  return [table]() -> std::optional<DatasetEntry> {
    if (table->AtEnd()) return std::nullopt;
    MosaicFile entry{table->stamp(), table->file()};
    table->Advance();
    return entry;
  };
}

BodyAxes AxesOf(const fs::path& mav0, const nav::Rig& rig) {
  if (IsOwnRecording(mav0)) return {};
  nav::Pose T_BS;  // of what the truth is about
  const fs::path truth_yaml = mav0 / kTruthFolder / "sensor.yaml";
  if (fs::exists(truth_yaml)) {
    const SensorSection section(ReadYaml(truth_yaml), "");
    if (section.Has("T_BS")) T_BS = section.MountPose();
  }
  return BodyAxes(rig, T_BS);
}

std::vector<EntrySource> Sources(const fs::path& mav0, const DatasetInfo& info,
                                 const BodyAxes& axes) {
  std::vector<EntrySource> sources;
  if (info.has_truth) {
    sources.push_back(RowSource(mav0 / kTruthFolder, [axes](const auto& reader, auto& row) {
      return axes.Of(TruthFrom(reader, row));
    }));
  }
  if (info.rig.imu) {
    sources.push_back(RowSource(
        mav0 / "imu0", [](const auto& reader, const auto& row) { return ImuFrom(reader, row); }));
  }
  if (info.rig.polarimeter) {
    sources.push_back(RowSource(mav0 / "pol0", [](const auto& reader, const auto& row) {
      return PolarimeterFrom(reader, row);
    }));
  }
  if (info.has_reference) {
    sources.push_back(RowSource(mav0 / "ref0", [axes](const auto& reader, const auto& row) {
      return axes.Of(ReferenceFrom(reader, row));
    }));
  }
  if (info.rig.optical_flow) {
    sources.push_back(RowSource(
        mav0 / "flow0", [](const auto& reader, const auto& row) { return FlowFrom(reader, row); }));
  }
  if (info.rig.stereo) sources.push_back(PairSource(mav0));
  if (info.rig.polarization_camera) sources.push_back(MosaicSource(mav0 / "polcam0"));
  return sources;
}

std::vector<std::string> TablesOf(const DatasetInfo& info) {
  std::vector<std::string> tables;
  if (info.has_truth) tables.emplace_back(kTruthFolder);
  if (info.rig.imu) tables.emplace_back("imu0");
  if (info.rig.polarimeter) tables.emplace_back("pol0");
  if (info.has_reference) tables.emplace_back("ref0");
  if (info.rig.optical_flow) tables.emplace_back("flow0");
  if (info.rig.stereo) tables.insert(tables.end(), {"cam0", "cam1"});
  if (info.rig.polarization_camera) tables.emplace_back("polcam0");
  return tables;
}

// A recording counts from its scenario's start; anything else from its first stamp.
void FindTimes(const fs::path& mav0, DatasetInfo& info) {
  std::optional<nav::TimeNs> first;
  std::optional<nav::TimeNs> last;
  for (const std::string& table : TablesOf(info)) {
    const fs::path file = mav0 / table / "data.csv";
    const std::optional<TableRow> row = TableReader(file, TableKind::kStampedCsv).Next();
    if (!row) continue;
    first = std::min(first.value_or(row->stamp), row->stamp);
    const nav::TimeNs end = LastStamp(file, TableKind::kStampedCsv).value_or(row->stamp);
    last = std::max(last.value_or(end), end);
  }
  if (!first) throw InputError(mav0.string(), 0, "", "holds no measurement");
  info.epoch = IsOwnRecording(mav0) ? 0 : *first;
  info.duration = *last - info.epoch;
}

}  // namespace

fs::path FindMav0(const fs::path& folder) {
  if (fs::is_directory(folder / "mav0")) return folder / "mav0";
  for (const char* sensor : {"cam0", "imu0", "pol0", "polcam0", "flow0"}) {
    if (Has(folder, sensor)) return folder;
  }
  return {};
}

Dataset OpenEuroc(const fs::path& mav0, const std::optional<RigFile>& rig_file) {
  const fs::path root = (fs::absolute(mav0) / "").lexically_normal().parent_path().parent_path();
  DatasetInfo info{.format = "euroc",
                   .name = root.filename().string(),
                   .scenario_file = {},
                   .rig = ReadRig(mav0, rig_file),
                   .has_reference = Has(mav0, "ref0"),
                   .has_truth = Has(mav0, kTruthFolder) && HasRows(mav0, kTruthFolder)};
  if (fs::exists(root / "scenario.yaml")) info.scenario_file = root / "scenario.yaml";
  FindTimes(mav0, info);
  const BodyAxes axes = AxesOf(mav0, info.rig);
  axes.Apply(info.rig);
  std::vector<EntrySource> sources = Sources(mav0, info, axes);
  return Dataset(std::move(info), std::move(sources));
}

}  // namespace polnav::testbed
