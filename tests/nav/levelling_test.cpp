#include "nav/stereo/levelling.h"

#include <gtest/gtest.h>

#include "nav/stereo/reprojection.h"

namespace polnav::nav {
namespace {

constexpr TimeNs kFrame = kNsPerSecond / 10;
constexpr TimeNs kSample = kNsPerSecond / 100;

// A vehicle in a level curve that speeds up: 6 m/s and 0.5 m/s^2 on a radius of 60 m, tilted by
// `tilt` about its own axes.
struct Curve {
  Eigen::Quaterniond tilt;

  [[nodiscard]] Pose At(double t) const {
    const double angle = (6.0 * t + 0.25 * t * t) / 60.0;
    return {LevelAttitude(-angle) * tilt,
            60.0 * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0)};
  }
  // Specific force in B by second differences of the exact path.
  [[nodiscard]] Eigen::Vector3d ForceAt(double t) const {
    constexpr double h = 1e-3;
    const Eigen::Vector3d a = (At(t + h).p - 2.0 * At(t).p + At(t - h).p) / (h * h);
    return At(t).q.conjugate() * (a + Eigen::Vector3d(0, 0, 9.80665));
  }
};

TEST(Levelling, FindsUpInACurveThatAPendulumWouldMissByDegrees) {
  const Curve curve{ExpRotation({0.01, -0.02, 0.0})};
  Levelling levelling({.first_interval_s = 2.0});
  std::optional<LevelEdge> edge;
  TimeNs at = 0;
  for (TimeNs t = 0; t <= 3 * kNsPerSecond && !edge; t += kSample) {
    if (t > 0) {
      levelling.Add({.stamp = t, .accel_m_s2 = curve.ForceAt(ToSeconds(t - kSample / 2))});
    }
    if (t % kFrame != 0) continue;
    const Pose before = curve.At(ToSeconds(t - kFrame));
    levelling.AddMotion(t, before.Inverse() * curve.At(ToSeconds(t)));
    edge = levelling.TakeEdge();
    at = t;
  }
  ASSERT_TRUE(edge);
  const Eigen::Vector3d up = curve.At(ToSeconds(at)).q.conjugate() * Eigen::Vector3d::UnitZ();
  // What is left: the body turns by 1.1 degrees within a frame, of which the mean force is taken
  // half way: second order, 1e-4 of 0.6 m/s^2. The curve itself would tilt a pendulum by 0.07 rad.
  EXPECT_LT((edge->up_B - up).norm(), 2e-4);
}

TEST(Levelling, TheFirstAnswerIsAsSureAsTheBiasAndLaterOnesLess) {
  Levelling levelling({.first_interval_s = 1.0, .interval_s = 1.0, .velocity_sigma_m_s = 1e-4});
  std::vector<double> sigmas;
  for (TimeNs t = 0; sigmas.size() < 2; t += kFrame) {
    levelling.Add({.stamp = t, .accel_m_s2 = {0, 0, 9.8}});
    levelling.AddMotion(t, {});
    if (const auto edge = levelling.TakeEdge()) sigmas.push_back(edge->sigma_rad);
  }
  EXPECT_NEAR(sigmas[0], DegToRad(0.15), 1e-4);
  EXPECT_GT(sigmas[1], 5.0 * sigmas[0]);
}

TEST(Levelling, WithoutAnImuThereIsNoAnswer) {
  Levelling levelling(LevellingOptions{});
  for (int k = 0; k < 100; ++k) levelling.AddMotion(k * kFrame, {});
  EXPECT_FALSE(levelling.FirstIsDue());
  EXPECT_FALSE(levelling.TakeEdge());
}

}  // namespace
}  // namespace polnav::nav
