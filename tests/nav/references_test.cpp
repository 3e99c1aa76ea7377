#include "nav/stereo/references.h"

#include <gtest/gtest.h>

#include "tests/nav/spot_texture.h"

namespace polnav::nav {
namespace {

Pyramid PyramidOf(double shift_x) { return BuildPyramid(SpotTexture(shift_x, 0.0), {}, true); }

TEST(References, PutBackWhatHasWandered) {
  std::vector<FollowedPoint> tracks{{.id = 1, .raw = {200.0F, 180.0F}, .disparity = 5.0F}};
  RenewReferences(PyramidOf(0.0), {}, tracks);
  tracks[0].raw = {203.5F, 180.3F};  // the picture moves by 3.0 px, the track slipped besides
  HoldToReferences(PyramidOf(3.0), {}, tracks);
  ASSERT_TRUE(tracks[0].reference);
  EXPECT_NEAR(tracks[0].raw.x, 203.0, 0.05);
  EXPECT_NEAR(tracks[0].raw.y, 180.0, 0.05);
}

TEST(References, AreGivenUpWhereSomethingElseIsInTheirPlace) {
  std::vector<FollowedPoint> tracks{{.id = 1, .raw = {200.0F, 180.0F}, .disparity = 5.0F}};
  RenewReferences(PyramidOf(0.0), {}, tracks);
  HoldToReferences(PyramidOf(40.0), {}, tracks);
  EXPECT_FALSE(tracks[0].reference);
  EXPECT_EQ(tracks[0].raw, cv::Point2f(200.0F, 180.0F));
}

TEST(References, BeginAnewWhenThePointHasComeNearer) {
  std::vector<FollowedPoint> tracks{{.id = 1, .raw = {200.0F, 180.0F}, .disparity = 10.0F}};
  RenewReferences(PyramidOf(0.0), {}, tracks);
  tracks[0].disparity = 11.0F;
  RenewReferences(PyramidOf(0.0), {}, tracks);
  EXPECT_EQ(tracks[0].reference_disparity, 10.0F);
  tracks[0].disparity = 20.0F;
  RenewReferences(PyramidOf(0.0), {}, tracks);
  EXPECT_EQ(tracks[0].reference_disparity, 20.0F);
}

}  // namespace
}  // namespace polnav::nav
