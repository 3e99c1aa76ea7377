// A recording reads back as what was written; somebody else's dataset is understood; what is broken
// costs as little as it can.
#include <gtest/gtest.h>

#include <opencv2/imgcodecs.hpp>

#include "tests/testbed/dataset/dataset_files.h"
#include "tests/testbed/temporary_folder.h"
#include "tools/testbed/dataset/body_axes.h"
#include "tools/testbed/dataset/euroc_reader.h"
#include "tools/testbed/dataset/euroc_writer.h"
#include "tools/testbed/hash.h"
#include "tools/testbed/input_error.h"
#include "tools/testbed/stream_hash.h"

namespace polnav::testbed {
namespace {

namespace fs = std::filesystem;

nav::TimeNs StampOfItem(const DatasetItem& item) {
  const auto* truth = std::get_if<sim::Truth>(&item);
  return truth != nullptr ? truth->stamp : nav::StampOf(std::get<nav::Measurement>(item));
}

std::string NameOfItem(const DatasetItem& item) {
  const auto* measurement = std::get_if<nav::Measurement>(&item);
  return measurement == nullptr ? "truth" : nav::StreamName(*measurement);
}

std::string DigestOf(const DatasetItem& item) {
  Sha256 hash;
  if (const auto* truth = std::get_if<sim::Truth>(&item)) {
    HashTruth(*truth, hash);
  } else {
    HashMeasurement(std::get<nav::Measurement>(item), hash);
  }
  return hash.HexDigest();
}

class Euroc : public ::testing::Test {
 protected:
  Euroc() { WriteRecording(root_, scenario_, items_); }

  Dataset Open(const fs::path& rig = {}) { return OpenDataset(root_, rig); }
  std::string ErrorOf(const fs::path& rig = {}) {
    try {
      Dataset dataset = Open(rig);
      (void)ReadAll(dataset);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }
  [[nodiscard]] std::string In(const std::string& name) const { return (mav0_ / name).string(); }
  [[nodiscard]] std::size_t Count(const std::vector<DatasetItem>& items,
                                  const std::string& name) const {
    return static_cast<std::size_t>(std::count_if(
        items.begin(), items.end(), [&](const auto& item) { return NameOfItem(item) == name; }));
  }

  TemporaryFolder folder_;
  Scenario scenario_ = SmallScenario();
  std::vector<DatasetItem> items_ = SmallRecording(scenario_);
  fs::path root_ = folder_.path() / "flight";
  fs::path mav0_ = root_ / "mav0";
};

TEST_F(Euroc, ARecordingComesBackInOrderAndToTheLastBit) {
  Dataset dataset = Open();
  EXPECT_EQ(dataset.info().epoch, 0);
  EXPECT_EQ(dataset.info().duration, 500'000'000);
  EXPECT_EQ(dataset.info().scenario_file, root_ / "scenario.yaml");
  const std::vector<DatasetItem> again = ReadAll(dataset);
  ASSERT_EQ(again.size(), items_.size());
  for (std::size_t i = 0; i < again.size(); ++i) {
    ASSERT_EQ(NameOfItem(again[i]), NameOfItem(items_[i])) << i;
    EXPECT_EQ(DigestOf(again[i]), DigestOf(items_[i])) << i << " " << NameOfItem(items_[i]);
  }
  EXPECT_TRUE(dataset.problems().empty());
}

// What a filter believes of its IMU is scored alike on the recording. Others write nan.
TEST_F(Euroc, TheImusBiasesComeBack) {
  const auto truth_of = [](const std::vector<DatasetItem>& items) {
    std::vector<sim::Truth> truth;
    for (const DatasetItem& item : items) {
      if (const auto* t = std::get_if<sim::Truth>(&item)) truth.push_back(*t);
    }
    return truth;
  };
  std::vector<sim::Truth> written = truth_of(items_);
  ASSERT_TRUE(written.at(1).imu_bias.has_value());
  written[1].imu_bias.reset();
  WriteRecording(root_, scenario_, {written.begin(), written.end()});
  Dataset dataset = Open();
  const std::vector<sim::Truth> read = truth_of(ReadAll(dataset));
  ASSERT_EQ(read.size(), written.size());
  for (std::size_t i = 0; i < read.size(); ++i) {
    ASSERT_EQ(read[i].imu_bias.has_value(), i != 1) << i;
    if (i == 1) continue;
    EXPECT_EQ(read[i].imu_bias->gyro_rad_s, written[i].imu_bias->gyro_rad_s) << i;
    EXPECT_EQ(read[i].imu_bias->accel_m_s2, written[i].imu_bias->accel_m_s2) << i;
  }
}

TEST_F(Euroc, EverythingIsOnDiskWhileTheRunGoesOn) {
  const fs::path other = folder_.path() / "running";
  EurocWriter writer(other, scenario_, sim::NominalRig(scenario_.sensors));
  for (std::size_t i = 0; i < 40; ++i) {
    std::visit([&](const auto& said) { writer.Write(said); }, items_[i]);
  }
  Dataset dataset = OpenDataset(other, {});  // the writer is still there
  EXPECT_EQ(ReadAll(dataset).size(), 40U);
}

TEST_F(Euroc, ANewRecordingTakesThePlaceOfAnOldOneButOfNothingElse) {
  WriteRecording(root_, scenario_, {items_.begin(), items_.begin() + 10});
  Dataset dataset = Open();
  EXPECT_EQ(ReadAll(dataset).size(), 10U);
  MakeForeign(root_);
  EXPECT_THROW(WriteRecording(root_, scenario_, items_), InputError);
  EXPECT_TRUE(fs::exists(mav0_ / "imu0" / "data.csv"));
}

TEST_F(Euroc, Mav0ItselfWillDo) {
  Dataset dataset = OpenDataset(mav0_ / "", {});
  EXPECT_EQ(dataset.info().name, "flight");
  EXPECT_EQ(ReadAll(dataset).size(), items_.size());
  EXPECT_THROW((void)OpenDataset(folder_.path(), {}), InputError);
  EXPECT_THROW((void)OpenDataset(root_ / "scenario.yaml", {}), InputError);
}

TEST_F(Euroc, WithoutTruthThereIsNone) {
  fs::remove_all(mav0_ / kTruthFolder);
  Dataset dataset = Open();
  EXPECT_FALSE(dataset.info().has_truth);
  EXPECT_EQ(Count(ReadAll(dataset), "truth"), 0U);
}

// Epochs of today, EuRoC's 17 columns, Windows line ends.
TEST_F(Euroc, OthersTimeCountsFromTheirFirstStamp) {
  MakeForeign(root_);
  for (const char* sensor : {"cam0", "cam1", "pol0", "ref0", "polcam0", "flow0"}) {
    fs::remove_all(mav0_ / sensor);
  }
  WriteText(In("imu0/data.csv"),
            "#timestamp [ns],w,w,w,a,a,a\r\n1403715273262142976,1,2,3,4,5,6\r\n"
            "1403715273272142976,1,2,3,4,5,6\r\n");
  WriteText(In(std::string(kTruthFolder) + "/data.csv"),
            "#timestamp,...\r\n1403715273267142976,1,2,3,0.7071,0,0,0.7071,4,5,6,0,0,0,0,0,0\r\n");
  Dataset dataset = Open();
  EXPECT_EQ(dataset.info().epoch, 1403715273262142976);
  EXPECT_EQ(dataset.info().duration, 10'000'000);
  const std::vector<DatasetItem> items = ReadAll(dataset);
  ASSERT_EQ(items.size(), 3U);
  EXPECT_EQ(StampOfItem(items[0]), 0);
  const auto& truth = std::get<sim::Truth>(items[1]);
  EXPECT_EQ(truth.stamp, 5'000'000);
  EXPECT_EQ(truth.v_WB_m_s, Eigen::Vector3d(4, 5, 6));
  EXPECT_NEAR(truth.T_WB.q.norm(), 1.0, 1e-15);
}

// A body whose x is up and z forward, as EuRoC's: Polnav's x is its z, and a camera that looked
// along the body's z looks along Polnav's x. Where things are in the world does not change.
TEST_F(Euroc, OthersBodyAxesAreRenamed) {
  Eigen::Matrix3d R_BC;  // the camera's right is the body's y, its down the body's -x
  R_BC << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  const Eigen::Quaterniond tilt(Eigen::AngleAxisd(0.3, Eigen::Vector3d(1, 2, 3).normalized()));
  const Eigen::Quaterniond q_BP = RenamedAxes(tilt * Eigen::Quaterniond(R_BC));
  EXPECT_LT((q_BP * Eigen::Vector3d::UnitX() - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  EXPECT_LT((q_BP * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitX()).norm(), 1e-12);

  nav::Rig rig = sim::NominalRig(scenario_.sensors);
  rig.stereo->left.T_BC.q = Eigen::Quaterniond(R_BC);
  const nav::Pose T_BC = rig.stereo->left.T_BC;
  const nav::Pose T_BS{tilt, {0.1, 0.2, 0.3}};  // the truth is about a marker S on the body
  const BodyAxes axes(rig, T_BS);
  axes.Apply(rig);
  const sim::Truth marker{.T_WB = {tilt, {5, 6, 7}}};
  const nav::Pose T_WC = axes.Of(marker).T_WB * rig.stereo->left.T_BC;
  const nav::Pose expected = marker.T_WB * T_BS.Inverse() * T_BC;
  EXPECT_LT((T_WC.p - expected.p).norm(), 1e-12);
  EXPECT_LT(T_WC.q.angularDistance(expected.q), 1e-7);
}

TEST_F(Euroc, ForwardLookingCamerasChangeNothing) {
  const Eigen::Quaterniond q_BC = sim::NominalRig(scenario_.sensors).stereo->left.T_BC.q;
  EXPECT_EQ(RenamedAxes(q_BC).angularDistance(Eigen::Quaterniond::Identity()), 0.0);
}

TEST_F(Euroc, ABadFrameIsLeftOutAndNamed) {
  fs::remove(In("cam0/data/100000000.png"));
  cv::imwrite(In("cam1/data/200000000.png"), cv::Mat(60, 80, CV_8UC1, cv::Scalar(9)));
  WriteText(In("cam1/data/300000000.png"), "no picture");
  Replace(In("cam1/data.csv"), "400000000,400000000.png\n", "");
  cv::imwrite(In("polcam0/data/0.png"), cv::Mat(24, 32, CV_8UC1, cv::Scalar(9)));
  Dataset dataset = Open();
  const std::vector<DatasetItem> items = ReadAll(dataset);
  EXPECT_EQ(Count(items, "stereo"), 2U);
  EXPECT_EQ(Count(items, "polarization_camera"), 5U);
  EXPECT_EQ(Count(items, "imu"), 50U);
  const std::vector<std::string> expected{
      In("polcam0/data/0.png") + ": expected one channel of 16 bits",
      In("cam0/data/100000000.png") + ": no such file",
      In("cam1/data/200000000.png") + ": 80 x 60 px, expected 160 x 120",
      In("cam1/data/300000000.png") + ": not a readable picture",
      In("cam0/data/400000000.png") + ": its pair is not in " + In("cam1/data.csv")};
  EXPECT_EQ(dataset.problems(), expected);
}

TEST_F(Euroc, WhatComesBeforeABrokenLineIsGood) {
  Replace(In("imu0/data.csv"), "\n250000000,", "\n250000000;");
  Dataset dataset = Open();
  std::size_t imu = 0;
  const auto read = [&] {
    while (const auto item = dataset.Next()) imu += NameOfItem(*item) == "imu" ? 1U : 0U;
  };
  try {
    read();
    FAIL() << "the line is not refused";
  } catch (const InputError& error) {
    EXPECT_EQ(error.line(), 26);
    EXPECT_EQ(error.file(), In("imu0/data.csv"));
  }
  EXPECT_EQ(imu, 24U);  // all before it, the one right before it included
}

TEST_F(Euroc, WhatCannotBeUnderstoodIsRefusedBeforeAnythingIsRead) {
  Replace(In("pol0/sensor.yaml"), "fov_rad", "fov_deg");
  EXPECT_EQ(ErrorOf(), In("pol0/sensor.yaml") + ": fov_rad: missing; expected a number");
  fs::remove(In("pol0/sensor.yaml"));
  EXPECT_EQ(ErrorOf(), In("pol0/sensor.yaml") + ": no such file");
  fs::remove_all(In("pol0"));
  EXPECT_EQ(ErrorOf(), "no error");
  fs::remove(In("imu0/data.csv"));
  EXPECT_EQ(ErrorOf(), In("imu0/data.csv") + ": no such file");
}

TEST_F(Euroc, ARigFileTakesThePlaceOfCalibrations) {
  const fs::path rig = folder_.path() / "rig.yaml";
  std::string pol0 = ReadText(In("pol0/sensor.yaml"));
  fs::remove(In("pol0/sensor.yaml"));  // need not be there then
  std::string indented;
  for (const char c : "\n" + pol0) indented += c == '\n' ? std::string("\n  ") : std::string(1, c);
  WriteText(rig, "pol0:" + indented);
  Replace(rig, "fov_rad: ", "fov_rad: 0.5 # ");
  EXPECT_EQ(Open(rig).info().rig.polarimeter->fov_rad, 0.5);
  WriteText(rig, "cam9: {}\n");
  EXPECT_NE(ErrorOf(rig).find("rig.yaml:1: cam9: is not one of: cam0"), std::string::npos);
  WriteText(rig, "imu0: {rate_hz: 100}\n");
  EXPECT_NE(ErrorOf(rig).find("rig.yaml:1: imu0.T_BS.rows: missing"), std::string::npos);
  fs::remove_all(In("polcam0"));
  WriteText(rig, "polcam0: {bits: 8}\n");
  EXPECT_NE(ErrorOf(rig).find("polcam0: the dataset has no such sensor"), std::string::npos);
}

}  // namespace
}  // namespace polnav::testbed
