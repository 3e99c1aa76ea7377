#include "tools/testbed/dataset/dataset.h"

#include <fmt/format.h>

#include "tools/testbed/dataset/euroc_reader.h"
#include "tools/testbed/dataset/kitti_reader.h"
#include "tools/testbed/dataset/pictures.h"
#include "tools/testbed/dataset/rig_file.h"

namespace polnav::testbed {

nav::TimeNs StampOf(const DatasetEntry& entry) {
  return std::visit([](const auto& e) { return e.stamp; }, entry);
}

Dataset::Dataset(DatasetInfo info, std::vector<EntrySource> sources) : info_(std::move(info)) {
  for (EntrySource& source : sources) {
    std::optional<DatasetEntry> head = source();
    streams_.push_back({std::move(source), std::move(head)});
  }
}

// A broken line must not take good ones from before it along.
void Dataset::Advance(Stream& stream) {
  const nav::TimeNs before = StampOf(*stream.head);
  stream.head.reset();
  try {
    stream.head = stream.next();
  } catch (const InputError& error) {
    if (failure_) return;
    failure_ = error;
    good_until_ = before;
  }
}

std::optional<DatasetEntry> Dataset::TakeEarliest() {
  Stream* earliest = nullptr;
  for (Stream& stream : streams_) {
    if (!stream.head) continue;
    if (earliest == nullptr || StampOf(*stream.head) < StampOf(*earliest->head)) {
      earliest = &stream;
    }
  }
  const bool good = earliest != nullptr && StampOf(*earliest->head) <= good_until_;
  if (failure_ && !good) throw InputError(*failure_);
  if (earliest == nullptr) return std::nullopt;
  DatasetEntry entry = *earliest->head;
  Advance(*earliest);
  std::visit([&](auto& e) { e.stamp -= info_.epoch; }, entry);
  return entry;
}

std::optional<DatasetItem> Dataset::Next() {
  while (const std::optional<DatasetEntry> entry = TakeEarliest()) {
    if (std::optional<DatasetItem> item = Load(*entry)) return item;
  }
  return std::nullopt;
}

std::optional<DatasetItem> Dataset::Load(const DatasetEntry& entry) {
  if (const auto* pair = std::get_if<PairFiles>(&entry)) return LoadPair(*pair);
  if (const auto* sky = std::get_if<MosaicFile>(&entry)) return LoadSky(*sky);
  if (const auto* truth = std::get_if<sim::Truth>(&entry)) return *truth;
  if (const auto* imu = std::get_if<nav::ImuSample>(&entry)) return nav::Measurement(*imu);
  if (const auto* light = std::get_if<nav::PolarizationSample>(&entry)) {
    return nav::Measurement(*light);
  }
  if (const auto* pose = std::get_if<nav::ReferencePose>(&entry)) return nav::Measurement(*pose);
  if (const auto* flow = std::get_if<nav::OpticalFlowSample>(&entry)) {
    return nav::Measurement(*flow);
  }
  problems_.push_back(std::get<BrokenFrame>(entry).problem);
  return std::nullopt;
}

std::optional<DatasetItem> Dataset::LoadPair(const PairFiles& files) {
  const nav::CameraCalibration& camera = info_.rig.stereo.value().left;
  const cv::Size size(camera.width_px, camera.height_px);
  const LoadedPicture left = LoadGrey(files.left, size);
  const LoadedPicture right = LoadGrey(files.right, size);
  if (left.image.empty() || right.image.empty()) {
    problems_.push_back(left.image.empty() ? left.problem : right.problem);
    return std::nullopt;
  }
  return nav::Measurement(nav::StereoImages{files.stamp, left.image, right.image});
}

std::optional<DatasetItem> Dataset::LoadSky(const MosaicFile& file) {
  const nav::PolarizationCameraCalibration& camera = info_.rig.polarization_camera.value();
  const LoadedPicture sky =
      LoadMosaic(file.file, cv::Size(camera.width_px, camera.height_px), camera.bits);
  if (sky.image.empty()) {
    problems_.push_back(sky.problem);
    return std::nullopt;
  }
  return nav::Measurement(nav::PolarizationImage{file.stamp, sky.image});
}

Dataset OpenDataset(const std::filesystem::path& folder, const std::filesystem::path& rig_file) {
  if (!std::filesystem::is_directory(folder)) {
    throw InputError(folder.string(), 0, "", "no such folder");
  }
  const std::optional<RigFile> rig = ReadRigFile(rig_file);
  if (const std::filesystem::path mav0 = FindMav0(folder); !mav0.empty()) {
    return OpenEuroc(mav0, rig);
  }
  if (IsKitti(folder)) return OpenKitti(folder, rig);
  throw InputError(folder.string(), 0, "",
                   "no dataset: expected EuRoC's mav0/cam0, mav0/imu0 ... or KITTI odometry's "
                   "calib.txt and times.txt");
}

}  // namespace polnav::testbed
