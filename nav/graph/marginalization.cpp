#include "nav/graph/marginalization.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <stdexcept>

#include "nav/graph/edges.h"

namespace polnav::nav {
namespace {

// Information that a landmark's inverse depth gets for free, so that one seen once from far away
// does not make its 3x3 block singular: 1 / (1000 1/m)^2, nothing beside a single disparity.
constexpr double kFreeInformation = 1e-6;

// Cost 1/2 delta^T H delta + g^T delta over the window's poses, six entries each.
struct NormalEquations {
  Eigen::MatrixXd H;
  Eigen::VectorXd g;

  explicit NormalEquations(std::size_t poses)
      : H(Eigen::MatrixXd::Zero(6 * static_cast<Eigen::Index>(poses),
                                6 * static_cast<Eigen::Index>(poses))),
        g(Eigen::VectorXd::Zero(H.rows())) {}

  template <typename Jacobian, typename Residual>
  void AddToPose(std::size_t pose, const Jacobian& J, const Residual& r) {
    const auto at = 6 * static_cast<Eigen::Index>(pose);
    H.block<6, 6>(at, at) += J.transpose() * J;
    g.segment<6>(at) += J.transpose() * r;
  }
};

void AddPrior(const Window& window, NormalEquations& n) {
  const Prior& prior = window.prior;
  const auto size = prior.jacobian.cols();
  Eigen::MatrixXd J = prior.jacobian;
  Eigen::VectorXd r = prior.residual;
  for (std::size_t i = 0; i < prior.linearized.size(); ++i) {
    const auto at = 6 * static_cast<Eigen::Index>(i);
    const auto delta = Difference(window.keyframes[i].T_WB, prior.linearized[i]);
    r += prior.jacobian.middleCols<6>(at) * delta;
    J.middleCols<3>(at + 3) =
        prior.jacobian.middleCols<3>(at + 3) * InverseLeftJacobian(delta.tail<3>());
  }
  n.H.topLeftCorner(size, size) += J.transpose() * J;
  n.g.head(size) += J.transpose() * r;
}

void AddPoseEdges(const Keyframe& keyframe, std::size_t pose, NormalEquations& n) {
  if (keyframe.heading) {
    const HeadingResidual e = EvaluateHeading(*keyframe.heading, keyframe.T_WB);
    n.AddToPose(pose, e.by_pose, Eigen::Matrix<double, 1, 1>(e.residual));
  }
  if (keyframe.level) {
    const LevelResidual e = EvaluateLevel(*keyframe.level, keyframe.T_WB);
    n.AddToPose(pose, e.by_pose, e.residual);
  }
}

// Huber's weight as a factor on residual and Jacobian.
double RobustScale(const Eigen::Vector3d& residual, double huber_sigmas) {
  const double norm = residual.norm();
  return norm <= huber_sigmas ? 1.0 : std::sqrt(huber_sigmas / norm);
}

// Adds what one landmark says about the poses once it is itself eliminated.
void AddLandmark(const RectifiedCamera& camera, const BundleAdjustmentOptions& options,
                 const Window& window, const Landmark& landmark, NormalEquations& n) {
  const std::size_t host = IndexOf(window, landmark.host);
  Eigen::Matrix3d H_ll = Eigen::Vector3d(0.0, 0.0, kFreeInformation).asDiagonal();
  Eigen::Vector3d g_l = Eigen::Vector3d::Zero();
  std::vector<std::size_t> poses{host};
  std::vector<Matrix3x6d> H_lp{Matrix3x6d::Zero()};
  for (const Sighting& s : landmark.sightings) {
    const std::size_t target = IndexOf(window, s.keyframe);
    auto e = Reproject(camera, window.keyframes[host].T_WB, window.keyframes[target].T_WB,
                       landmark.coordinates, s.pixel, options.sigmas);
    if (!e) continue;
    const double scale = RobustScale(e->residual, options.huber_sigmas);
    e->residual *= scale;
    e->by_landmark *= scale;
    H_ll += e->by_landmark.transpose() * e->by_landmark;
    g_l += e->by_landmark.transpose() * e->residual;
    if (target == host) continue;
    e->by_host *= scale;
    e->by_target *= scale;
    n.AddToPose(host, e->by_host, e->residual);
    n.AddToPose(target, e->by_target, e->residual);
    const auto h = 6 * static_cast<Eigen::Index>(host);
    const auto t = 6 * static_cast<Eigen::Index>(target);
    const Matrix6d cross = e->by_host.transpose() * e->by_target;
    n.H.block<6, 6>(h, t) += cross;
    n.H.block<6, 6>(t, h) += cross.transpose();
    H_lp.front() += e->by_landmark.transpose() * e->by_host;
    poses.push_back(target);
    H_lp.push_back(e->by_landmark.transpose() * e->by_target);
  }
  const Eigen::Matrix3d inverse = H_ll.inverse();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const Eigen::Matrix<double, 6, 3> gain = H_lp[i].transpose() * inverse;
    const auto at = 6 * static_cast<Eigen::Index>(poses[i]);
    n.g.segment<6>(at) -= gain * g_l;
    for (std::size_t j = 0; j < poses.size(); ++j) {
      n.H.block<6, 6>(at, 6 * static_cast<Eigen::Index>(poses[j])) -= gain * H_lp[j];
    }
  }
}

// A square root of the information on all poses but the first, which is eliminated.
Prior EliminateFirst(const Window& window, const NormalEquations& n) {
  const Eigen::Index rest = n.H.rows() - 6;
  const Eigen::LDLT<Matrix6d> first(n.H.topLeftCorner<6, 6>());
  if (first.info() != Eigen::Success) {
    throw std::logic_error("MarginalizeOldest: the oldest keyframe is not constrained");
  }
  const Eigen::MatrixXd cross = n.H.bottomLeftCorner(rest, 6);
  const Eigen::MatrixXd H =
      n.H.bottomRightCorner(rest, rest) - cross * first.solve(cross.transpose());
  const Eigen::VectorXd g = n.g.tail(rest) - cross * first.solve(n.g.head<6>());
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(0.5 * (H + H.transpose()));
  if (eigen.info() != Eigen::Success) {
    throw std::logic_error("MarginalizeOldest: the prior's information has no eigenvalues");
  }
  // Directions whose information is lost in the rounding of the strongest one carry none.
  const double floor = 1e-12 * eigen.eigenvalues().maxCoeff();
  const Eigen::ArrayXd s = eigen.eigenvalues().array();
  const Eigen::ArrayXd root = (s > floor).select(s.max(0.0).sqrt(), 0.0);
  const Eigen::ArrayXd inverse_root = (s > floor).select(root.inverse(), 0.0);
  Prior prior;
  prior.jacobian = root.matrix().asDiagonal() * eigen.eigenvectors().transpose();
  prior.residual = inverse_root.matrix().asDiagonal() * (eigen.eigenvectors().transpose() * g);
  for (std::size_t i = 1; i < window.keyframes.size(); ++i) {
    prior.linearized.push_back(window.keyframes[i].T_WB);
  }
  return prior;
}

}  // namespace

void MarginalizeOldest(const RectifiedCamera& camera, const BundleAdjustmentOptions& options,
                       Window& window) {
  NormalEquations n(window.keyframes.size());
  AddPrior(window, n);
  AddPoseEdges(window.keyframes.front(), 0, n);
  const std::uint64_t oldest = window.keyframes.front().id;
  for (auto it = window.landmarks.begin(); it != window.landmarks.end();) {
    const bool leaves = it->second.host == oldest;
    if (leaves) AddLandmark(camera, options, window, it->second, n);
    it = leaves ? window.landmarks.erase(it) : std::next(it);
  }
  window.prior = EliminateFirst(window, n);
  window.keyframes.pop_front();
}

Matrix6d NewestCovariance(const RectifiedCamera& camera, const BundleAdjustmentOptions& options,
                          const Window& window) {
  NormalEquations n(window.keyframes.size());
  AddPrior(window, n);
  for (std::size_t i = 0; i < window.keyframes.size(); ++i) {
    AddPoseEdges(window.keyframes[i], i, n);
  }
  for (const auto& [id, landmark] : window.landmarks) {
    AddLandmark(camera, options, window, landmark, n);
  }
  const Eigen::LDLT<Eigen::MatrixXd> solver(n.H);
  if (solver.info() != Eigen::Success) {
    throw std::logic_error("NewestCovariance: the window's information is singular");
  }
  Eigen::MatrixXd selector = Eigen::MatrixXd::Zero(n.H.rows(), 6);
  selector.bottomRows<6>().setIdentity();
  const Eigen::MatrixXd columns = solver.solve(selector);
  const Matrix6d covariance = columns.bottomRows<6>();
  return 0.5 * (covariance + covariance.transpose());
}

}  // namespace polnav::nav
