// Estimates in a world of their own are moved onto the truth, covariances with them.
#include "tools/testbed/run_record.h"

#include <gtest/gtest.h>

#include <cmath>

namespace polnav::testbed {
namespace {

const nav::Pose kT_WE{Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * M_PI, Eigen::Vector3d::UnitZ())),
                      {10, 20, 30}};

// On an arc, as long as it is curved; the estimator's world E is turned by a quarter and moved.
RunRecord Elsewhere(double curvature_1_m) {
  RunRecord record;
  EstimatorRun run{.name = "stereo"};
  for (int i = 0; i < 50; ++i) {
    const double x_m = 0.5 * i;
    sim::Truth truth{.stamp = i * 100'000'000LL};
    truth.T_WB.p = {x_m, 0.5 * curvature_1_m * x_m * x_m, 0.0};
    record.truth.push_back(truth);
    nav::Estimate e{.stamp = truth.stamp, .T_WB = kT_WE.Inverse() * truth.T_WB};
    e.covariance.diagonal() << 4.0, 1.0, 1.0, 0.04, 0.01, 0.01;  // along E's x
    run.estimates.push_back(e);
  }
  run.sha256 = HashOf(run.estimates);
  record.estimators.push_back(run);
  return record;
}

TEST(AlignToTruth, FindsTheOtherWorldAndTurnsCovariances) {
  const RunRecord record = Elsewhere(0.05);
  for (const Alignment alignment : {Alignment::kYaw, Alignment::kSe3}) {
    const EstimatorRun run = AlignToTruth(record, alignment).estimators.at(0);
    EXPECT_EQ(run.alignment, alignment);
    for (std::size_t i = 0; i < run.estimates.size(); ++i) {
      EXPECT_LT((run.estimates[i].T_WB.p - record.truth[i].T_WB.p).norm(), 1e-9);
      EXPECT_LT(run.estimates[i].T_WB.q.angularDistance(record.truth[i].T_WB.q), 1e-7);
    }
    // What was along E's x is along W's y.
    EXPECT_NEAR(run.estimates[7].covariance(1, 1), 4.0, 1e-9);
    EXPECT_NEAR(run.estimates[7].covariance(4, 4), 0.04, 1e-9);
    EXPECT_EQ(run.sha256, record.estimators[0].sha256);  // of what the estimator said
  }
}

TEST(AlignToTruth, LeavesAloneWhatItCannotDetermine) {
  const RunRecord straight = Elsewhere(0.0);
  const EstimatorRun run = AlignToTruth(straight, Alignment::kSe3).estimators.at(0);
  EXPECT_EQ(run.alignment, Alignment::kNone);
  EXPECT_EQ(HashOf(run.estimates), straight.estimators[0].sha256);
  RunRecord compass = Elsewhere(0.05);
  compass.estimators[0].heading_only = true;
  EXPECT_EQ(AlignToTruth(compass, Alignment::kSe3).estimators.at(0).alignment, Alignment::kNone);
  EXPECT_EQ(AlignToTruth(Elsewhere(0.05), Alignment::kNone).estimators.at(0).alignment,
            Alignment::kNone);
}

}  // namespace
}  // namespace polnav::testbed
