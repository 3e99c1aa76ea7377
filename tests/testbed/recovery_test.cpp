#include "tools/testbed/recovery.h"

#include <gtest/gtest.h>

#include <functional>

namespace polnav::testbed {
namespace {

// At 10 Hz.
struct Minute {
  ErrorSeries errors;
  std::vector<nav::Estimate> estimates;

  Minute(const std::function<double(double)>& heading_deg,
         const std::function<bool(double)>& tracked) {
    for (int i = 0; i <= 600; ++i) {
      const double t_s = 0.1 * i;
      errors.t_s.push_back(t_s);
      errors.heading_deg.push_back(heading_deg(t_s));
      nav::Estimate e{.stamp = nav::FromSeconds(t_s)};
      e.tracked = tracked(t_s);
      estimates.push_back(e);
    }
  }
};

bool Always(double) { return true; }

// Off by a tenth of a degree, by three from 20 s on, back from 33 s on.
double ComesBack(double t_s) { return t_s >= 20.0 && t_s < 33.0 ? 3.0 : 0.1; }

TEST(Recovery, CountsFromTheDisturbancesEnd) {
  const Minute run(ComesBack, [](double t_s) { return t_s < 20.0 || t_s >= 30.45; });
  const auto recovery = ScoreRecovery({{20.0, 30.0}}, run.errors, run.estimates);
  ASSERT_TRUE(recovery && recovery->heading_s);
  EXPECT_NEAR(*recovery->heading_s, 3.0, 0.11);  // an interval between estimates
  EXPECT_NEAR(recovery->tracking_s, 0.5, 0.11);
  EXPECT_EQ(recovery->disturbances, 1);
}

TEST(Recovery, IsNoneWhereNothingWasLost) {
  const Minute run([](double) { return 0.1; }, Always);
  const auto recovery = ScoreRecovery({{20.0, 30.0}, {40.0, 45.0}}, run.errors, run.estimates);
  ASSERT_TRUE(recovery && recovery->heading_s);
  EXPECT_EQ(*recovery->heading_s, 0.0);
  EXPECT_EQ(recovery->tracking_s, 0.0);
  EXPECT_EQ(recovery->disturbances, 2);
}

TEST(Recovery, LastsToTheNextDisturbanceWhereItDoesNotCome) {
  const Minute run([](double t_s) { return t_s < 20.0 ? 0.1 : 3.0; }, Always);
  const auto recovery = ScoreRecovery({{20.0, 30.0}, {42.0, 50.0}}, run.errors, run.estimates);
  ASSERT_TRUE(recovery && recovery->heading_s);
  EXPECT_NEAR(*recovery->heading_s, 12.0, 1e-9);
}

TEST(Recovery, TakesOverlappingDisturbancesAsOne) {
  const Minute run(ComesBack, Always);
  const auto recovery = ScoreRecovery({{25.0, 32.0}, {20.0, 30.0}}, run.errors, run.estimates);
  ASSERT_TRUE(recovery && recovery->heading_s);
  EXPECT_NEAR(*recovery->heading_s, 1.0, 0.11);
  EXPECT_EQ(recovery->disturbances, 1);
}

TEST(Recovery, SaysNothingOfWhatItCannotJudge) {
  const Minute run(ComesBack, Always);
  EXPECT_FALSE(ScoreRecovery({}, run.errors, run.estimates));
  EXPECT_FALSE(ScoreRecovery({{50.0, 59.5}}, run.errors, run.estimates)) << "the run is over";
  const auto early = ScoreRecovery({{2.0, 30.0}}, run.errors, run.estimates);
  ASSERT_TRUE(early);
  EXPECT_FALSE(early->heading_s) << "nothing to compare with";
}

}  // namespace
}  // namespace polnav::testbed
