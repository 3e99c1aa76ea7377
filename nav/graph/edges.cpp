#include "nav/graph/edges.h"

#include <Eigen/Cholesky>
#include <cmath>
#include <stdexcept>

namespace polnav::nav {

std::size_t IndexOf(const Window& window, std::uint64_t keyframe) {
  for (std::size_t i = 0; i < window.keyframes.size(); ++i) {
    if (window.keyframes[i].id == keyframe) return i;
  }
  throw std::logic_error("Window: a landmark refers to a keyframe that has slid out");
}

std::vector<Viewpoint> ViewpointsOf(const RectifiedCamera& camera, const Window& window) {
  std::vector<Viewpoint> viewpoints;
  viewpoints.reserve(window.keyframes.size());
  for (const Keyframe& k : window.keyframes) viewpoints.push_back(ViewpointOf(camera, k.T_WB));
  return viewpoints;
}

HeadingResidual EvaluateHeading(const HeadingEdge& edge, const Pose& T_WB,
                                const SkyErrors& errors) {
  const Eigen::Vector3d x_W = T_WB.q * Eigen::Vector3d::UnitX();
  const double horizontal2 = x_W.head<2>().squaredNorm();
  HeadingResidual r;
  const double heading = edge.heading_rad - edge.by_errors.dot(errors);
  r.residual = WrapPi(heading - CompassHeading(T_WB.q)) / edge.sigma_rad;
  r.by_errors = -edge.by_errors.transpose() / edge.sigma_rad;
  // psi = atan2(x_E, x_N) and dx = dtheta x x, hence dpsi = (x_N dx_E - x_E dx_N) / (x_E^2 +
  // x_N^2).
  const Eigen::RowVector3d by_x(x_W.y() / horizontal2, -x_W.x() / horizontal2, 0.0);
  r.by_pose.setZero();
  r.by_pose.tail<3>() = by_x * Skew(x_W) / edge.sigma_rad;
  if (!edge.by_tilt.isZero()) {
    const Eigen::Vector3d turn = LogRotation(T_WB.q * edge.q_WB.conjugate());
    const Eigen::RowVector2d by_tilt = edge.by_tilt.transpose() / edge.sigma_rad;
    r.residual += by_tilt * turn.head<2>();
    r.by_pose.tail<3>() += by_tilt * InverseLeftJacobian(turn).topRows<2>();
  }
  return r;
}

LevelResidual EvaluateLevel(const LevelEdge& edge, const Pose& T_WB) {
  const Eigen::Vector3d up_W = T_WB.q * edge.up_B;
  LevelResidual r;
  r.residual = up_W.head<2>() / edge.sigma_rad;
  r.by_pose.setZero();
  r.by_pose.rightCols<3>() = -Skew(up_W).topRows<2>() / edge.sigma_rad;
  return r;
}

Eigen::Matrix3d InverseLeftJacobian(const Eigen::Vector3d& theta) {
  const double angle = theta.norm();
  const Eigen::Matrix3d s = Skew(theta);
  // 1/12 is the limit at zero; the series' next term is angle^2 / 720.
  const double c = angle < 1e-4 ? 1.0 / 12.0
                                : 1.0 / (angle * angle) -
                                      (1.0 + std::cos(angle)) / (2.0 * angle * std::sin(angle));
  return Eigen::Matrix3d::Identity() - 0.5 * s + c * s * s;
}

namespace {

// Jacobian of a prior: the inverse of the covariance's Cholesky factor.
template <int kSize>
Eigen::MatrixXd RootInformation(const Eigen::Matrix<double, kSize, kSize>& covariance) {
  const Eigen::LLT<Eigen::Matrix<double, kSize, kSize>> llt(covariance);
  if (llt.info() != Eigen::Success) {
    throw std::logic_error("PriorFromCovariance: the covariance is not positive definite");
  }
  return llt.matrixL().solve(Eigen::Matrix<double, kSize, kSize>::Identity());
}

}  // namespace

Prior PriorFromCovariance(const Pose& T_WB, const Matrix6d& covariance) {
  return {.linearized = {T_WB},
          .motion = {},
          .errors = {},
          .jacobian = RootInformation<6>(covariance),
          .residual = Eigen::VectorXd::Zero(6)};
}

Prior PriorFromCovariance(const Pose& T_WB, const Motion& motion, const Matrix15d& covariance) {
  return {.linearized = {T_WB},
          .motion = motion,
          .errors = {},
          .jacobian = RootInformation<15>(covariance),
          .residual = Eigen::VectorXd::Zero(15)};
}

void AddErrors(const SkyErrors& errors,
               const Eigen::Matrix<double, kSkyErrors, kSkyErrors>& covariance, Prior& prior) {
  const Eigen::Index rows = prior.jacobian.rows();
  const Eigen::Index columns = prior.jacobian.cols();
  prior.errors = errors;
  prior.jacobian.conservativeResizeLike(
      Eigen::MatrixXd::Zero(rows + kSkyErrors, columns + kSkyErrors));
  prior.jacobian.bottomRightCorner<kSkyErrors, kSkyErrors>() =
      RootInformation<kSkyErrors>(covariance);
  prior.residual.conservativeResizeLike(Eigen::VectorXd::Zero(rows + kSkyErrors));
}

Eigen::Matrix<double, 9, 1> Difference(const Motion& motion, const Motion& reference) {
  Eigen::Matrix<double, 9, 1> d;
  d << motion.v_WI - reference.v_WI, motion.gyro_bias - reference.gyro_bias,
      motion.accel_bias - reference.accel_bias;
  return d;
}

}  // namespace polnav::nav
