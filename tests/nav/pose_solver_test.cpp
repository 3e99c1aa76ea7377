#include "nav/stereo/pose_solver.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/nav/synthetic_street.h"

namespace polnav::nav {
namespace {

using Vector6d = Eigen::Matrix<double, 6, 1>;

class PoseSolverTest : public ::testing::Test {
 protected:
  // Landmarks all over the picture at about depth_m, seen from truth_ with noise of one sigma.
  std::vector<LandmarkView> Views(int count, double depth_m) {
    std::mt19937_64 engine(3);
    std::uniform_real_distribution<double> uniform;
    std::normal_distribution<double> gaussian;
    std::vector<LandmarkView> views;
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector3d landmark(1.2 * uniform(engine) - 0.6, 0.6 * uniform(engine) - 0.3,
                                     (0.8 + 0.4 * uniform(engine)) / depth_m);
      StereoPixel seen{.disparity_px = 0.0};
      const auto e =
          Reproject(camera_, host_, ViewpointOf(camera_, truth_), landmark, seen, {1.0, 1.0});
      seen.uv_px = -e->residual.head<2>();
      seen.disparity_px = -e->residual.z();
      seen.uv_px +=
          options_.sigmas.position_px * Eigen::Vector2d(gaussian(engine), gaussian(engine));
      *seen.disparity_px += options_.sigmas.disparity_px * gaussian(engine);
      views.push_back({.id = static_cast<std::uint64_t>(i),
                       .host = host_,
                       .landmark = landmark,
                       .pixel = seen});
    }
    return views;
  }

  double ErrorOf(const std::optional<PoseSolution>& solution) const {
    return (solution.value().T_WB.p - truth_.p).norm();
  }

  RectifiedCamera camera_ = StereoRectifier(TestCalibration()).camera();
  Viewpoint host_ = ViewpointOf(camera_, {ExpRotation({0.0, 0.0, 0.3}), {3.0, -2.0, 0.5}});
  Pose truth_{ExpRotation({0.0, 0.01, 0.32}), {3.5, -1.8, 0.5}};
  PoseSolverOptions options_{.sigmas = {.position_px = 0.7, .disparity_px = 0.6}};
  // Constant velocity at 10 Hz misses 0.1 m and 0.3 degrees.
  Vector6d sigmas_ = (Vector6d() << 0.1, 0.1, 0.1, 0.005, 0.005, 0.005).finished();
};

// Prior and views weigh by their information: a prior three sigmas off moves the answer by
// 3 (sigma_views / sigma_prior)^2 of its sigmas.
TEST_F(PoseSolverTest, ManyViewsOverruleThePrior) {
  const auto views = Views(150, 8.0);
  const PosePrior prior{Perturb(truth_, 3.0 * sigmas_), sigmas_.cwiseAbs2().asDiagonal()};
  const auto solution = SolvePose(camera_, views, prior.T_WB, options_, 12, prior);
  ASSERT_TRUE(solution);
  EXPECT_GT(solution->inliers, 140);
  const Vector6d error = Difference(solution->T_WB, truth_);
  for (int k = 0; k < 6; ++k) {
    const double sigma = std::sqrt(solution->covariance(k, k));
    EXPECT_LT(std::abs(error[k]), 4.0 * sigma + 3.0 * sigma * sigma / sigmas_[k]) << k;
    EXPECT_LT(sigma, 0.3 * sigmas_[k]) << k;
  }
}

// Some 440 squares of unit Gaussians cut at three sigma (0.973 each on average): their mean is
// known to sqrt(2 / 440) = 0.07. Twice the noise is four times the squares, less what becomes an
// outlier.
TEST_F(PoseSolverTest, NisIsOneWhenPixelsAreAsNoisyAsBelieved) {
  const auto views = Views(150, 8.0);
  EXPECT_NEAR(SolvePose(camera_, views, truth_, options_, 12)->nis, 0.97, 3.0 * 0.07);
  options_.sigmas = {.position_px = 0.35, .disparity_px = 0.3};
  EXPECT_GT(SolvePose(camera_, views, truth_, options_, 12)->nis, 2.0);
}

// Twelve points 90 m away know the place to half a metre, constant velocity to a tenth.
TEST_F(PoseSolverTest, FewFarViewsLeaveThePlaceToThePrior) {
  const auto views = Views(12, 90.0);
  const auto alone = SolvePose(camera_, views, truth_, options_, 8);
  const PosePrior prior{Perturb(truth_, 0.5 * sigmas_), sigmas_.cwiseAbs2().asDiagonal()};
  const auto with_prior = SolvePose(camera_, views, truth_, options_, 8, prior);
  EXPECT_GT(ErrorOf(alone), 0.2);
  EXPECT_LT(ErrorOf(with_prior), 0.15);
}

}  // namespace
}  // namespace polnav::nav
