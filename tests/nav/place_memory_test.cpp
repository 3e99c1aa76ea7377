#include "nav/graph/place_memory.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>

#include "tests/nav/synthetic_street.h"

namespace polnav::nav {
namespace {

class PlaceMemoryTest : public ::testing::Test {
 protected:
  RectifiedCamera camera_ = StereoRectifier(TestCalibration()).camera();
  SyntheticStreet street_{camera_, 60.0, 3};
  PoseSolverOptions solver_{.sigmas = {0.7, 0.6}, .inlier_sigmas = 2.0};
  PlaceMemory memory_{PlaceOptions{.enabled = true}};

  // Features with a random descriptor that belongs to the point, whoever looks at it.
  StereoFeatures See(const Pose& T_WB, TimeNs stamp) {
    StereoFeatures seen = street_.See(T_WB, stamp, 0.1);
    seen.descriptors.create(static_cast<int>(seen.features.size()), 32, CV_8UC1);
    for (std::size_t i = 0; i < seen.features.size(); ++i) {
      cv::RNG random(seen.features[i].id + 1);
      cv::Mat row = seen.descriptors.row(static_cast<int>(i));
      random.fill(row, cv::RNG::UNIFORM, 0, 256);
    }
    return seen;
  }
};

constexpr TimeNs kLater = 60 * kNsPerSecond;

TEST_F(PlaceMemoryTest, GivesThePoseRelativeToTheFirstVisit) {
  memory_.Remember(camera_, 0, street_.PoseAt(0.0), See(street_.PoseAt(0.0), 0));
  const Pose truth = street_.PoseAt(0.8);
  Eigen::Matrix<double, 6, 1> drift;
  drift << 0.6, -0.4, 0.2, 0.005, -0.005, 0.02;
  const auto edge =
      memory_.Recognize(camera_, kLater, Perturb(truth, drift), See(truth, kLater), solver_);
  ASSERT_TRUE(edge);
  // Some hundred points at 0.1 px and a tenth of that in disparity error of depth: centimetres.
  EXPECT_LT((edge->T_WB.p - truth.p).norm(), 0.05);
  EXPECT_LT(edge->T_WB.q.angularDistance(truth.q), DegToRad(0.1));
}

TEST_F(PlaceMemoryTest, AFreshPlaceOrADistantOneIsNoFix) {
  const Pose here = street_.PoseAt(0.0);
  memory_.Remember(camera_, 0, here, See(here, 0));
  EXPECT_FALSE(memory_.Recognize(camera_, kNsPerSecond, here, See(here, kNsPerSecond), solver_));
  const Pose far = street_.PoseAt(8.0);
  EXPECT_FALSE(memory_.Recognize(camera_, kLater, far, See(far, kLater), solver_));
}

TEST_F(PlaceMemoryTest, AnotherSceneAtTheSamePlaceIsNoFix) {
  const Pose here = street_.PoseAt(0.0);
  memory_.Remember(camera_, 0, here, See(here, 0));
  street_ = SyntheticStreet(camera_, 60.0, 4);
  StereoFeatures other = See(here, kLater);
  for (FeatureObservation& f : other.features) f.id += 100000;
  cv::bitwise_not(other.descriptors, other.descriptors);
  EXPECT_FALSE(memory_.Recognize(camera_, kLater, here, other, solver_));
}

TEST_F(PlaceMemoryTest, ByDefaultItIsOffAndKnowsNothing) {
  PlaceMemory off(PlaceOptions{});
  const Pose here = street_.PoseAt(0.0);
  off.Remember(camera_, 0, here, See(here, 0));
  EXPECT_FALSE(off.Recognize(camera_, kLater, here, See(here, kLater), solver_));
}

}  // namespace
}  // namespace polnav::nav
