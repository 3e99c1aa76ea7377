// KITTI's conventions become Polnav's: forward is x, up is z, time is whole nanoseconds.
#include <gtest/gtest.h>

#include "tests/testbed/dataset/dataset_files.h"
#include "tests/testbed/temporary_folder.h"
#include "tools/testbed/dataset/kitti_reader.h"
#include "tools/testbed/input_error.h"

namespace polnav::testbed {
namespace {

class Kitti : public ::testing::Test {
 protected:
  Kitti() { WriteKitti(root_, 4, true); }

  std::string ErrorOf() {
    try {
      Dataset dataset = OpenDataset(root_, {});
      (void)ReadAll(dataset);
    } catch (const InputError& error) {
      return std::string(error.what()).substr(root_.string().size() + 1);
    }
    return "no error";
  }

  TemporaryFolder folder_;
  std::filesystem::path root_ = folder_.path() / "06";
};

TEST_F(Kitti, TheRightCameraIsToTheRight) {
  const nav::StereoCalibration stereo = *OpenDataset(root_, {}).info().rig.stereo;
  EXPECT_EQ(stereo.left.width_px, 320);
  EXPECT_EQ(stereo.left.cy_px, 80.0);
  EXPECT_LT((stereo.left.T_BC.q * Eigen::Vector3d::UnitZ() - Eigen::Vector3d::UnitX()).norm(),
            1e-12);
  EXPECT_LT((stereo.left.T_BC.q * Eigen::Vector3d::UnitY() + Eigen::Vector3d::UnitZ()).norm(),
            1e-12);
  EXPECT_LT((stereo.right.T_BC.p - Eigen::Vector3d(0, -1, 0)).norm(), 1e-12);
}

// The camera drives 2 m along its z, 1 m to its right, 0.5 m down, and turns left: about its -y.
TEST_F(Kitti, PosesAreOfTheBodyInTheFirstBody) {
  WriteText(root_ / "times.txt", "1.5\n1.6037000e+00\n");
  WriteText(root_ / "poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n0.8 0 -0.6 1 0 1 0 0.5 0.6 0 0.8 2\n");
  Dataset dataset = OpenDataset(root_, {});
  EXPECT_EQ(dataset.info().epoch, 1'500'000'000);
  const std::vector<DatasetItem> items = ReadAll(dataset);
  ASSERT_EQ(items.size(), 4U);
  EXPECT_LT(std::get<sim::Truth>(items[0]).T_WB.p.norm(), 1e-12);
  const auto& truth = std::get<sim::Truth>(items[2]);
  EXPECT_EQ(truth.stamp, 103'700'000);
  EXPECT_LT((truth.T_WB.p - Eigen::Vector3d(2, -1, -0.5)).norm(), 1e-12);
  const Eigen::Vector3d forward_W = truth.T_WB.q * Eigen::Vector3d::UnitX();
  EXPECT_LT((forward_W - Eigen::Vector3d(0.8, 0.6, 0)).norm(), 1e-12);
  const auto& pair = std::get<nav::StereoImages>(std::get<nav::Measurement>(items[3]));
  EXPECT_EQ(pair.stamp, truth.stamp);
  EXPECT_EQ(pair.left.size(), cv::Size(320, 160));
}

TEST_F(Kitti, WhatIsBrokenIsRefusedByLine) {
  Replace(root_ / "poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n", "1 0 0 0 0 1 0 0 0 0 1\n");
  EXPECT_EQ(ErrorOf(), "poses.txt:1: expected 12 columns, got 11");
  WriteText(root_ / "poses.txt", "1 0 0 0 0 2 0 0 0 0 1 0\n");
  EXPECT_EQ(ErrorOf(), "poses.txt:1: its first three columns are no rotation");
  WriteText(root_ / "poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  EXPECT_EQ(ErrorOf(), "poses.txt:1: fewer poses than there are times in times.txt");
  std::filesystem::remove(root_ / "poses.txt");
  EXPECT_EQ(ErrorOf(), "no error");
  Replace(root_ / "calib.txt", "P1: 2e2", "P1: 0");
  EXPECT_EQ(ErrorOf(), "calib.txt:2: P1: focal lengths are positive");
  WriteText(root_ / "calib.txt", "P0: 2e2 0 160 0 0 2e2 80 0 0 0 1 0\n");
  EXPECT_EQ(ErrorOf(), "calib.txt: P1: missing; expected 'P1: ' and 12 numbers");
  WriteText(root_ / "calib.txt",
            "P0: 2e2 0 160 0 0 2e2 80 0 0 0 1 0\nP1: 2e2 0 160 0 0 2e2 80 0 0 0 1 0\n");
  EXPECT_EQ(ErrorOf().substr(0, 27), "calib.txt: P1: no baseline:");
}

}  // namespace
}  // namespace polnav::testbed
