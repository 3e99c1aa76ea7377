// Errors of trajectories: where the answer is known by geometry, and evo's numbers on data that
// exercises association, alignment and pairing.
#include "tools/testbed/pose_errors.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "tools/testbed/statistics.h"
#include "tools/testbed/tum.h"

namespace polnav::testbed {
namespace {

constexpr double kTau = 2.0 * std::numbers::pi;

Eigen::Quaterniond Yaw(double angle) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
}

// Level, forward along a circle of the given radius, counter-clockwise, one lap in n steps.
Trajectory Circle(double radius_m, int n) {
  Trajectory trajectory;
  for (int i = 0; i <= n; ++i) {
    const double a = kTau * i / n;
    trajectory.push_back(
        {i * 100'000'000LL,
         {Yaw(a + kTau / 4.0),
          {radius_m * std::cos(a), radius_m * std::sin(a), 0.1 * std::sin(3.0 * a)}}});
  }
  return trajectory;
}

Trajectory Transformed(const nav::Pose& T, Trajectory trajectory) {
  for (StampedPose& pose : trajectory) pose.T_WB = T * pose.T_WB;
  return trajectory;
}

double Max(const std::vector<double>& values) { return Summarize(values).max; }

TEST(Ape, OfAPureOffsetIsTheOffset) {
  const Trajectory truth = Circle(20.0, 100);
  const nav::Pose offset{Eigen::Quaterniond::Identity(), {3.0, -4.0, 12.0}};
  const auto pairs = Associate(truth, Transformed(offset, truth));
  EXPECT_NEAR(Summarize(ApeTranslation(pairs)).rmse, 13.0, 1e-12);
  EXPECT_LT(Max(ApeAngle(pairs)), 1e-12);
}

TEST(Ape, OfAPureYawErrorGrowsWithTheDistanceFromTheOrigin) {
  const Trajectory truth = Circle(20.0, 100);
  const double yaw = 0.3;
  const auto pairs = Associate(truth, Transformed({Yaw(yaw), Eigen::Vector3d::Zero()}, truth));
  // A chord: 2 r sin(yaw / 2) of the horizontal radius.
  EXPECT_NEAR(Max(ApeTranslation(pairs)), 2.0 * 20.0 * std::sin(yaw / 2.0), 1e-10);
  EXPECT_NEAR(Summarize(ApeAngle(pairs)).mean, yaw, 1e-12);
}

TEST(Align, UndoesWhatItIsAllowedToUndo) {
  const Trajectory truth = Circle(20.0, 100);
  const nav::Pose yaw{Yaw(2.0), {5.0, 6.0, 7.0}};
  const nav::Pose tilt{Eigen::Quaterniond(Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX())) * yaw.q,
                       yaw.p};
  for (const Alignment alignment : {Alignment::kYaw, Alignment::kSe3}) {
    const auto pairs = Associate(truth, Transformed(yaw, truth));
    EXPECT_LT(Max(ApeTranslation(Moved(*Align(pairs, alignment), pairs))), 1e-11);
  }
  const auto pairs = Associate(truth, Transformed(tilt, truth));
  EXPECT_LT(Max(ApeTranslation(Moved(*Align(pairs, Alignment::kSe3), pairs))), 1e-11);
  // A tilt of 0.2 rad lifts the rim of a 20 m circle by 4 m; yaw cannot undo that.
  EXPECT_GT(Max(ApeTranslation(Moved(*Align(pairs, Alignment::kYaw), pairs))), 3.0);
}

TEST(Align, RefusesAStraightLine) {
  Trajectory line;
  for (int i = 0; i < 10; ++i) {
    line.push_back({i, {Eigen::Quaterniond::Identity(), {1.0 * i, 0.0, 0.0}}});
  }
  const auto pairs = Associate(line, line);
  EXPECT_FALSE(Align(pairs, Alignment::kSe3).has_value());
  EXPECT_TRUE(Align(pairs, Alignment::kYaw).has_value());  // a horizontal line does fix the yaw
}

TEST(Rpe, IsBlindToTheFrame) {
  const Trajectory truth = Circle(20.0, 1000);
  const nav::Pose moved{Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5), {100.0, 0.0, 3.0}};
  const RelativeErrors errors = Rpe(Associate(truth, Transformed(moved, truth)), 1.0);
  EXPECT_LT(Max(errors.translation_m), 1e-10);
  EXPECT_LT(Max(errors.angle_rad), 1e-10);
}

TEST(Rpe, OfAScaledTrajectoryIsTheScaleError) {
  const Trajectory truth = Circle(20.0, 10000);
  Trajectory estimate = truth;
  for (StampedPose& pose : estimate) pose.T_WB.p *= 1.01;
  // Pairs are 10 m of the estimate apart: 1 % too long over a nearly straight chord. The chord of a
  // 10 m arc at 20 m is 1 % shorter than the arc; pairs overshoot by up to a step (0.013 m).
  const RelativeErrors errors = Rpe(Associate(truth, estimate), 10.0);
  EXPECT_NEAR(Summarize(errors.translation_m).mean, 0.01 * 10.0 / 1.01, 0.0015);
}

TEST(Rpe, HasPairsFromTheFirstDeltaOn) {
  Trajectory line;
  for (int i = 0; i <= 10; ++i) {
    line.push_back({i, {Eigen::Quaterniond::Identity(), {0.5 * i, 0.0, 0.0}}});
  }
  const auto pairs = PairsByPath(Associate(line, line), 1.0);
  const std::vector<std::pair<std::size_t, std::size_t>> expected{{2, 4}, {4, 6}, {6, 8}, {8, 10}};
  EXPECT_EQ(pairs, expected);
  EXPECT_TRUE(PairsByPath(Associate(line, line), 100.0).empty());
}

TEST(Associate, TakesTheNearestWithinTenMilliseconds) {
  const nav::TimeNs ms = 1'000'000;
  const Trajectory truth{{0, {}}, {20 * ms, {}}, {40 * ms, {}}};
  const Trajectory estimate{{9 * ms, {}}, {31 * ms, {}}};
  const auto pairs = Associate(truth, estimate);
  ASSERT_EQ(pairs.size(), 2U);
  EXPECT_EQ(pairs[0].stamp, 9 * ms);
  EXPECT_TRUE(Associate(truth, {{51 * ms, {}}}).empty());
  EXPECT_EQ(Associate(truth, {{50 * ms, {}}}).size(), 1U);
}

class EvoGolden : public ::testing::Test {
 protected:
  static std::string Path(const std::string& name) {
    return std::string(POLNAV_TEST_DATA) + "/" + name;
  }

  void ExpectAgreement(const std::string& key, const std::vector<double>& errors) const {
    const Statistics s = Summarize(errors);
    const nlohmann::json& g = golden_.at(key);
    EXPECT_EQ(s.count, g.at("count").get<std::size_t>()) << key;
    EXPECT_NEAR(s.rmse, g.at("rmse").get<double>(), 1e-6) << key;
    EXPECT_NEAR(s.mean, g.at("mean").get<double>(), 1e-6) << key;
    EXPECT_NEAR(s.median, g.at("median").get<double>(), 1e-6) << key;
    EXPECT_NEAR(s.std, g.at("std").get<double>(), 1e-6) << key;
    EXPECT_NEAR(s.min, g.at("min").get<double>(), 1e-6) << key;
    EXPECT_NEAR(s.max, g.at("max").get<double>(), 1e-6) << key;
    EXPECT_NEAR(s.sse, g.at("sse").get<double>(), 1e-6) << key;
  }

  static std::vector<double> Degrees(std::vector<double> angles) {
    for (double& a : angles) a = nav::RadToDeg(a);
    return angles;
  }

  nlohmann::json golden_ = nlohmann::json::parse(std::ifstream(Path("evo_golden.json")));
  std::vector<PosePair> pairs_ =
      Associate(ReadTum(Path("evo_truth.tum")), ReadTum(Path("evo_estimate.tum")));
};

TEST_F(EvoGolden, AssociationAndAbsoluteErrorsAgree) {
  EXPECT_EQ(pairs_.size(), golden_.at("pairs").get<std::size_t>());
  ExpectAgreement("ape_trans_m_none", ApeTranslation(pairs_));
  ExpectAgreement("ape_rot_deg_none", Degrees(ApeAngle(pairs_)));
}

TEST_F(EvoGolden, ErrorsAfterAlignmentAgree) {
  const auto aligned = Moved(*Align(pairs_, Alignment::kSe3), pairs_);
  ExpectAgreement("ape_trans_m_se3", ApeTranslation(aligned));
  ExpectAgreement("ape_rot_deg_se3", Degrees(ApeAngle(aligned)));
}

TEST_F(EvoGolden, RelativeErrorsAgree) {
  for (const auto& [delta_m, name] : {std::pair{1.0, "1"}, {10.0, "10"}, {100.0, "100"}}) {
    const RelativeErrors errors = Rpe(pairs_, delta_m);
    ExpectAgreement(std::string("rpe_trans_m_") + name, errors.translation_m);
    ExpectAgreement(std::string("rpe_rot_deg_") + name, Degrees(errors.angle_rad));
  }
}

}  // namespace
}  // namespace polnav::testbed
