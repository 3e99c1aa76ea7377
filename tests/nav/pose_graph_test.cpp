#include "nav/graph/pose_graph.h"

#include <gtest/gtest.h>

#include "nav/graph/edges.h"

namespace polnav::nav {
namespace {

// A drive around a circle of 60 m in steps of 2 m. Odometry adds a steady twist per metre and
// nothing at random.
struct CircleDrive {
  static constexpr double kRadius_m = 60.0;
  static constexpr double kStep_m = 2.0;
  PoseGraphOptions options;
  PoseGraph graph;
  std::vector<Pose> truth;

  CircleDrive(int steps, const Vector6d& drift) {
    Vector6d sigmas;
    sigmas << 0.01, 0.01, 0.01, 0.01, 0.01, 0.01;
    graph.start = PriorFromCovariance(PoseAt(0), Matrix6d(sigmas.cwiseAbs2().asDiagonal()));
    for (int k = 0; k <= steps; ++k) {
      truth.push_back(PoseAt(k));
      GraphNode node{.keyframe = static_cast<std::uint64_t>(k), .T_WB = PoseAt(k)};
      if (k > 0) {
        const RelativeEdge step = Step(static_cast<std::size_t>(k), drift);
        node.T_WB = graph.nodes.back().T_WB * step.T_ft;
        graph.steps.push_back(step);
      }
      graph.nodes.push_back(node);
    }
  }

  static Pose PoseAt(int k) {
    const double a = kStep_m * k / kRadius_m;
    return {LevelAttitude(-a), kRadius_m * Eigen::Vector3d(std::cos(a), std::sin(a), 0.0)};
  }

  [[nodiscard]] RelativeEdge Step(std::size_t to, const Vector6d& drift) const {
    const Pose T_ft = truth[to - 1].Inverse() * truth[to];
    const double length = T_ft.p.norm();
    return {
        .from = to - 1,
        .to = to,
        .T_ft = {ExpRotation(length * drift.tail<3>()) * T_ft.q, T_ft.p + length * drift.head<3>()},
        .position_sigma_m = 0.01,
        .angle_sigma_rad = DegToRad(0.02),
        .length_m = length};
  }

  void AddReturn(std::size_t from, std::size_t to) {
    graph.returns.push_back({.from = from,
                             .to = to,
                             .T_ft = truth[from].Inverse() * truth[to],
                             .position_sigma_m = 0.05,
                             .angle_sigma_rad = DegToRad(0.1)});
  }

  [[nodiscard]] double WorstPosition_m() const {
    double worst = 0.0;
    for (std::size_t i = 0; i < truth.size(); ++i) {
      worst = std::max(worst, (graph.nodes[i].T_WB.p - truth[i].p).norm());
    }
    return worst;
  }
};

Vector6d Twist(double x, double y, double z, double roll_deg, double pitch_deg, double yaw_deg) {
  Vector6d twist;
  twist << x, y, z, DegToRad(roll_deg), DegToRad(pitch_deg), DegToRad(yaw_deg);
  return twist;
}

TEST(RelativeEdge, JacobiansAgreeWithFiniteDifferences) {
  const RelativeEdge edge{.T_ft = {ExpRotation({0.1, -0.2, 0.3}), {1.0, 0.2, -0.1}},
                          .position_sigma_m = 0.1,
                          .angle_sigma_rad = 0.02,
                          .length_m = 1.3};
  const Pose from{ExpRotation({0.05, -0.08, 1.9}), {1, 2, 3}};
  const Pose to{ExpRotation({0.2, -0.3, 2.1}), {1.2, 1.1, 2.8}};
  const Vector6d drift = Twist(0.01, -0.02, 0.03, 0.5, -0.4, 0.3);
  const RelativeResidual e = EvaluateRelative(edge, from, to, drift);
  constexpr double kStep = 1e-6;
  for (int k = 0; k < 6; ++k) {
    const Vector6d d = kStep * Vector6d::Unit(k);
    const auto slope = [&](const RelativeResidual& plus, const RelativeResidual& minus) {
      return Vector6d((plus.residual - minus.residual) / (2.0 * kStep));
    };
    const Vector6d by_from = slope(EvaluateRelative(edge, Perturb(from, d), to, drift),
                                   EvaluateRelative(edge, Perturb(from, -d), to, drift));
    const Vector6d by_to = slope(EvaluateRelative(edge, from, Perturb(to, d), drift),
                                 EvaluateRelative(edge, from, Perturb(to, -d), drift));
    const Vector6d by_drift = slope(EvaluateRelative(edge, from, to, drift + d),
                                    EvaluateRelative(edge, from, to, drift - d));
    EXPECT_LT((by_from - e.by_from.col(k)).norm(), 1e-6) << k;
    EXPECT_LT((by_to - e.by_to.col(k)).norm(), 1e-6) << k;
    EXPECT_LT((by_drift - e.by_drift.col(k)).norm(), 1e-6) << k;
  }
}

TEST(PoseGraph, WithoutReturnsOdometryStaysAsItIs) {
  CircleDrive drive(50, Vector6d::Zero());
  ASSERT_TRUE(OptimizePoseGraph(drive.options, drive.graph).usable);
  EXPECT_LT(drive.WorstPosition_m(), 1e-9);
  EXPECT_LT(drive.graph.drift.norm(), 1e-12);
}

// One and a half laps; places of the first lap are seen on the second. Steady errors of a few
// millimetres and thousandths of a degree a metre put the end of the lap metres off. Without the
// accelerometer a climb could as well be a tilt that grew at random.
TEST(PoseGraph, ReturnsShowTheSteadyDriftAndCorrectTheWholeDrive) {
  const Vector6d drift = Twist(0.0, 0.0, 0.003, 0.0, 0.0, 0.003);
  CircleDrive drive(282, drift);
  // Random steps turn by 0.3 degrees a lap, so a lap tells the yaw drift to 0.0007 degrees a metre:
  // what is believed beforehand must be vaguer than that not to hold it back.
  drive.options.drift_position_sigma = 0.02;
  drive.options.drift_angle_sigma_deg = 0.02;
  for (GraphNode& node : drive.graph.nodes) node.level = LevelEdge{.sigma_rad = DegToRad(0.2)};
  EXPECT_GT(drive.WorstPosition_m(), 2.0);
  for (std::size_t k = 0; k + 188 < drive.truth.size(); k += 5) drive.AddReturn(k, k + 188);
  ASSERT_TRUE(OptimizePoseGraph(drive.options, drive.graph).usable);
  // The returns pin a lap's 1.1 m and 1.1 degrees to some 0.05 m and 0.05 degrees.
  EXPECT_LT(drive.WorstPosition_m(), 0.15);
  EXPECT_NEAR(drive.graph.drift(2), drift(2), 0.05 * drift(2));
  EXPECT_NEAR(drive.graph.drift(5), drift(5), 0.05 * drift(5));
}

TEST(PoseGraph, TheSkyAloneShowsAYawDrift) {
  const Vector6d drift = Twist(0.0, 0.0, 0.0, 0.0, 0.0, 0.004);
  CircleDrive drive(300, drift);
  for (std::size_t k = 0; k < drive.truth.size(); ++k) {
    drive.graph.nodes[k].heading =
        HeadingEdge{.heading_rad = CompassHeading(drive.truth[k].q), .sigma_rad = DegToRad(2.0)};
  }
  ASSERT_TRUE(OptimizePoseGraph(drive.options, drive.graph).usable);
  EXPECT_NEAR(drive.graph.drift(5), drift(5), 0.2 * drift(5));
}

TEST(PoseGraph, AFalseReturnCountsForLittleBesideTrueOnes) {
  CircleDrive drive(282, Vector6d::Zero());
  for (std::size_t k = 0; k + 188 < drive.truth.size(); k += 5) drive.AddReturn(k, k + 188);
  drive.AddReturn(40, 40 + 188);
  drive.graph.returns.back().T_ft.p.x() += 5.0;  // 100 sigmas
  ASSERT_TRUE(OptimizePoseGraph(drive.options, drive.graph).usable);
  EXPECT_LT(drive.WorstPosition_m(), 0.1);
}

// Straight on, no prior knowledge of a drift: variances of independent steps add up, and those of
// the angles act on the lever arm.
TEST(PoseGraph, TheNewestPosesCovarianceIsWhatTheStepsAddUpTo) {
  PoseGraphOptions options{.drift_position_sigma = 1e-6, .drift_angle_sigma_deg = 1e-6};
  PoseGraph graph;
  graph.start = PriorFromCovariance({}, 1e-4 * Matrix6d::Identity());
  constexpr int kSteps = 20;
  constexpr double kAngle = 0.001;
  constexpr double kPosition = 0.02;
  for (int k = 0; k <= kSteps; ++k) {
    graph.nodes.push_back({.T_WB = {Eigen::Quaterniond::Identity(), {1.0 * k, 0.0, 0.0}}});
    if (k == 0) continue;
    graph.steps.push_back({.from = static_cast<std::size_t>(k - 1),
                           .to = static_cast<std::size_t>(k),
                           .T_ft = {Eigen::Quaterniond::Identity(), {1.0, 0.0, 0.0}},
                           .position_sigma_m = kPosition,
                           .angle_sigma_rad = kAngle,
                           .length_m = 1.0});
  }
  const PoseGraphSummary summary = OptimizePoseGraph(options, graph);
  ASSERT_TRUE(summary.usable);
  const Matrix6d& P = summary.newest_covariance;
  EXPECT_NEAR(P(5, 5), 1e-4 + kSteps * kAngle * kAngle, 1e-9);
  EXPECT_NEAR(P(0, 0), 1e-4 + kSteps * kPosition * kPosition, 1e-8);
  double across = 1e-4 * (1.0 + kSteps * kSteps) + kSteps * kPosition * kPosition;
  for (int k = 1; k <= kSteps; ++k) {
    across += kAngle * kAngle * (kSteps - k) * (kSteps - k);
  }
  EXPECT_NEAR(P(1, 1), across, 1e-6 * across);
}

}  // namespace
}  // namespace polnav::nav
