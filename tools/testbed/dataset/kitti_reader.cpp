#include "tools/testbed/dataset/kitti_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <memory>
#include <opencv2/imgcodecs.hpp>

#include "tools/testbed/dataset/calibration_yaml.h"
#include "tools/testbed/dataset/table_reader.h"
#include "tools/testbed/input_error.h"

namespace polnav::testbed {
namespace {

namespace fs = std::filesystem;

using Matrix34 = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;

// The left camera's axes in B.
Eigen::Quaterniond CameraInBody() {
  Eigen::Matrix3d R_BC;
  R_BC << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return Eigen::Quaterniond(R_BC);
}

fs::path PictureFile(const fs::path& folder, const char* camera, std::size_t index) {
  return folder / camera / fmt::format("{:06}.png", index);
}

// Twelve numbers from this field on, row by row.
Matrix34 MatrixAt(const TableReader& reader, const TableRow& row, std::size_t first) {
  Matrix34 matrix;
  for (int i = 0; i < 12; ++i) {
    matrix(i / 4, i % 4) = reader.Number(row, first + static_cast<std::size_t>(i));
  }
  return matrix;
}

Matrix34 ReadProjection(const fs::path& file, const std::string& name) {
  TableReader reader(file, TableKind::kWords);
  while (const std::optional<TableRow> row = reader.Next()) {
    if (row->fields[0] != name + ":") continue;
    reader.ExpectFields(*row, {13});
    Matrix34 P = MatrixAt(reader, *row, 1);
    if (!(P(0, 0) > 0.0) || !(P(1, 1) > 0.0)) {
      reader.Fail(name + ": focal lengths are positive");
    }
    const bool pinhole =
        P(0, 1) == 0.0 && P(1, 0) == 0.0 && P.row(2) == Matrix34::Identity().row(2);
    if (!pinhole) reader.Fail(name + ": not the projection of a rectified camera");
    return P;
  }
  throw InputError(file.string(), 0, name, "missing; expected '" + name + ": ' and 12 numbers");
}

nav::CameraCalibration CameraOf(const Matrix34& P, const cv::Size& size) {
  const Eigen::Vector3d p_C(-P(0, 3) / P(0, 0), -P(1, 3) / P(1, 1), 0.0);
  return {.width_px = size.width,
          .height_px = size.height,
          .fx_px = P(0, 0),
          .fy_px = P(1, 1),
          .cx_px = P(0, 2),
          .cy_px = P(1, 2),
          .T_BC = {CameraInBody(), CameraInBody() * p_C}};
}

// calib.txt does not have it.
cv::Size SizeOfPictures(const fs::path& folder) {
  if (!fs::is_directory(folder / "image_0")) {
    throw InputError((folder / "image_0").string(), 0, "", "no such folder");
  }
  constexpr std::size_t kTries = 100;
  for (std::size_t i = 0; i < kTries; ++i) {
    const fs::path file = PictureFile(folder, "image_0", i);
    if (!fs::is_regular_file(file)) continue;
    const cv::Mat image = cv::imread(file.string(), cv::IMREAD_GRAYSCALE);
    if (!image.empty()) return image.size();
  }
  throw InputError((folder / "image_0").string(), 0, "",
                   "no readable picture like 000000.png among the first ones");
}

nav::StereoCalibration ReadCameras(const fs::path& folder, const std::optional<RigFile>& rig) {
  for (const char* sensor : {"imu0", "pol0", "polcam0"}) {
    if (HasSection(rig, sensor)) FailAt(*rig, sensor, "the dataset has no such sensor");
  }
  const fs::path file = folder / "calib.txt";
  const bool replaced = HasSection(rig, "cam0") && HasSection(rig, "cam1");
  nav::StereoCalibration stereo;
  if (!replaced) {
    const cv::Size size = SizeOfPictures(folder);
    stereo = {CameraOf(ReadProjection(file, "P0"), size),
              CameraOf(ReadProjection(file, "P1"), size)};
  }
  if (HasSection(rig, "cam0")) stereo.left = CameraFrom(SensorSection(*rig, "cam0"));
  if (HasSection(rig, "cam1")) stereo.right = CameraFrom(SensorSection(*rig, "cam1"));
  if (HasSection(rig, "cam1")) {
    CheckPair(stereo, SensorSection(*rig, "cam1"));
  } else if (!(stereo.left.T_BC.p.y() - stereo.right.T_BC.p.y() > 1e-4)) {
    throw InputError(file.string(), 0, "P1",
                     "no baseline: the second camera has to be to the right of the first");
  }
  return stereo;
}

EntrySource PairSource(const fs::path& folder) {
  auto times = std::make_shared<TableReader>(folder / "times.txt", TableKind::kSecondsWords);
  return [times, folder, index = std::size_t{0}]() mutable -> std::optional<DatasetEntry> {
    const std::optional<TableRow> row = times->Next();
    if (!row) return std::nullopt;
    times->ExpectFields(*row, {0});
    PairFiles pair{row->stamp, PictureFile(folder, "image_0", index),
                   PictureFile(folder, "image_1", index)};
    ++index;
    return pair;
  };
}

// The pose of the left camera, C0 the first one's place.
nav::Pose PoseFrom(const TableReader& reader, const TableRow& row) {
  reader.ExpectFields(row, {12});
  const Matrix34 T = MatrixAt(reader, row, 0);
  const Eigen::Matrix3d R = T.leftCols<3>();
  if (!IsRotation(R)) reader.Fail("its first three columns are no rotation");
  return {Eigen::Quaterniond(R).normalized(), T.col(3)};
}

class TruthTable {
 public:
  explicit TruthTable(const fs::path& folder)
      : times_(folder / "times.txt", TableKind::kSecondsWords),
        poses_(folder / "poses.txt", TableKind::kWords) {}

  std::optional<DatasetEntry> Next() {
    const std::optional<TableRow> time = times_.Next();
    const std::optional<TableRow> pose = poses_.Next();
    if (!time && !pose) return std::nullopt;
    if (!time) poses_.Fail("more poses than there are times in times.txt");
    if (!pose) poses_.Fail("fewer poses than there are times in times.txt");
    const nav::Pose T_BC{CameraInBody(), Eigen::Vector3d::Zero()};
    const nav::Pose T_0C = PoseFrom(poses_, *pose);
    if (!T_W0_) T_W0_ = T_BC * T_0C.Inverse();  // W is B here
    return sim::Truth{.stamp = time->stamp, .T_WB = *T_W0_ * T_0C * T_BC.Inverse()};
  }

 private:
  TableReader times_;
  TableReader poses_;
  std::optional<nav::Pose> T_W0_;  // of the first pose
};

}  // namespace

bool IsKitti(const fs::path& folder) {
  return fs::exists(folder / "calib.txt") && fs::exists(folder / "times.txt");
}

Dataset OpenKitti(const fs::path& folder, const std::optional<RigFile>& rig_file) {
  DatasetInfo info{.format = "kitti",
                   .name = fs::absolute(folder / "").lexically_normal().parent_path().filename(),
                   .scenario_file = {},
                   .has_truth = fs::exists(folder / "poses.txt")};
  if (fs::exists(folder / "scenario.yaml")) info.scenario_file = folder / "scenario.yaml";
  info.rig.stereo = ReadCameras(folder, rig_file);
  const fs::path times = folder / "times.txt";
  const std::optional<TableRow> first = TableReader(times, TableKind::kSecondsWords).Next();
  if (!first) throw InputError(times.string(), 0, "", "holds no time");
  info.epoch = first->stamp;
  info.duration = LastStamp(times, TableKind::kSecondsWords).value_or(info.epoch) - info.epoch;
  std::vector<EntrySource> sources;
  if (info.has_truth) {
    sources.emplace_back([table = std::make_shared<TruthTable>(folder)] { return table->Next(); });
  }
  sources.push_back(PairSource(folder));
  return Dataset(std::move(info), std::move(sources));
}

}  // namespace polnav::testbed
