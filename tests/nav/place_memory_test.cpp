#include "nav/graph/place_memory.h"

#include <gtest/gtest.h>

#include "tests/nav/synthetic_street.h"

namespace polnav::nav {
namespace {

constexpr TimeNs kLater = 60 * kNsPerSecond;

class PlaceMemoryTest : public ::testing::Test {
 protected:
  RectifiedCamera camera_ = StereoRectifier(TestCalibration()).camera();
  SyntheticStreet street_{camera_, 60.0, 3};
  PoseSolverOptions solver_{.sigmas = {0.7, 0.6}, .inlier_sigmas = 2.0};
  PlaceMemory memory_{PlaceOptions{}};
  std::vector<GraphNode> nodes_;

  StereoFeatures See(const Pose& T_WB) { return street_.SeeDescribed(T_WB, 0, 0.1); }

  void VisitFirst(const Pose& T_WB) {
    nodes_ = {{.stamp = 0, .T_WB = T_WB}};
    memory_.Remember(camera_, nodes_, See(T_WB));
  }

  // believed: where the graph has the vehicle.
  std::optional<RelativeEdge> VisitAgain(const Pose& believed, const StereoFeatures& seen,
                                         TimeNs stamp = kLater) {
    nodes_.push_back({.stamp = stamp, .T_WB = believed});
    return memory_.Recognize(camera_, nodes_, seen, solver_);
  }
};

TEST_F(PlaceMemoryTest, GivesThePoseRelativeToTheFirstVisit) {
  VisitFirst(street_.PoseAt(0.0));
  const Pose truth = street_.PoseAt(0.8);
  Eigen::Matrix<double, 6, 1> drift;
  drift << 0.6, -0.4, 0.2, 0.005, -0.005, 0.02;
  const auto edge = VisitAgain(Perturb(truth, drift), See(truth));
  ASSERT_TRUE(edge);
  EXPECT_EQ(edge->from, 0u);
  EXPECT_EQ(edge->to, 1u);
  const Pose expected = street_.PoseAt(0.0).Inverse() * truth;
  // Some hundred points at 0.1 px and a tenth of that in disparity error of depth: centimetres.
  EXPECT_LT((edge->T_ft.p - expected.p).norm(), 0.05);
  EXPECT_LT(edge->T_ft.q.angularDistance(expected.q), DegToRad(0.1));
}

TEST_F(PlaceMemoryTest, AFreshPlaceOrADistantOneIsNoReturn) {
  const Pose here = street_.PoseAt(0.0);
  VisitFirst(here);
  EXPECT_FALSE(VisitAgain(here, See(here), kNsPerSecond));
  const Pose far = street_.PoseAt(8.0);
  EXPECT_FALSE(VisitAgain(far, See(far)));
}

TEST_F(PlaceMemoryTest, AnotherSceneAtTheSamePlaceIsNoReturn) {
  const Pose here = street_.PoseAt(0.0);
  VisitFirst(here);
  street_ = SyntheticStreet(camera_, 60.0, 4);
  StereoFeatures other = See(here);
  for (FeatureObservation& f : other.features) f.id += 100000;
  cv::bitwise_not(other.descriptors, other.descriptors);
  EXPECT_FALSE(VisitAgain(here, other));
}

TEST_F(PlaceMemoryTest, WithoutDescriptorsThereIsNothingToKnow) {
  const Pose here = street_.PoseAt(0.0);
  nodes_ = {{.T_WB = here}};
  memory_.Remember(camera_, nodes_, street_.See(here, 0, 0.1));
  EXPECT_FALSE(VisitAgain(here, street_.See(here, kLater, 0.1)));
}

}  // namespace
}  // namespace polnav::nav
