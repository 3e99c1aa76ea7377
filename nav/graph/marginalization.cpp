#include "nav/graph/marginalization.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <cmath>
#include <stdexcept>

#include "nav/graph/normal_equations.h"

namespace polnav::nav {
namespace {

using Indices = std::vector<Eigen::Index>;

void Append(Eigen::Index begin, Eigen::Index count, Indices& indices) {
  for (Eigen::Index i = 0; i < count; ++i) indices.push_back(begin + i);
}

// A square root of the information on `kept`, the others having been eliminated. Unknowns of very
// different units are scaled to one first.
Prior Eliminate(const NormalEquations::Reduced& n, const Indices& gone, const Indices& kept) {
  const Eigen::LDLT<Eigen::MatrixXd> first(n.H(gone, gone));
  if (first.info() != Eigen::Success) {
    throw std::logic_error("MarginalizeOldest: the oldest keyframe is not constrained");
  }
  const Eigen::MatrixXd cross = n.H(kept, gone);
  Eigen::MatrixXd H = n.H(kept, kept) - cross * first.solve(cross.transpose());
  Eigen::VectorXd g = n.g(kept) - cross * first.solve(n.g(gone));
  const Eigen::VectorXd scale =
      H.diagonal().unaryExpr([](double d) { return d > 0.0 ? 1.0 / std::sqrt(d) : 1.0; });
  H = scale.asDiagonal() * (0.5 * (H + H.transpose())) * scale.asDiagonal();
  g = scale.cwiseProduct(g);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(H);
  if (eigen.info() != Eigen::Success) {
    throw std::logic_error("MarginalizeOldest: the prior's information has no eigenvalues");
  }
  // Directions whose information is lost in the rounding of the strongest one carry none.
  const double floor = 1e-12 * eigen.eigenvalues().maxCoeff();
  const Eigen::ArrayXd s = eigen.eigenvalues().array();
  const Eigen::ArrayXd root = (s > floor).select(s.max(0.0).sqrt(), 0.0);
  const Eigen::ArrayXd inverse_root = (s > floor).select(root.inverse(), 0.0);
  Prior prior;
  prior.jacobian = root.matrix().asDiagonal() * eigen.eigenvectors().transpose() *
                   scale.cwiseInverse().asDiagonal();
  prior.residual = inverse_root.matrix().asDiagonal() * (eigen.eigenvectors().transpose() * g);
  return prior;
}

// X with X^T X the covariance of the last `count` unknowns of this order: the last block of the
// Cholesky factor is that of their own information. Rounding may take the definiteness of what is
// hardly known; a damping far below what anything is known to gives it back.
Eigen::MatrixXd LastInverseRoot(const NormalEquations& window, const Indices& order,
                                Eigen::Index count) {
  for (const double damping : {0.0, 1e-10, 1e-8, 1e-6}) {
    const Eigen::LLT<Eigen::MatrixXd> solver(window.Reduce(damping).H(order, order));
    if (solver.info() != Eigen::Success) continue;
    return solver.matrixLLT()
        .bottomRightCorner(count, count)
        .triangularView<Eigen::Lower>()
        .solve(Eigen::MatrixXd::Identity(count, count));
  }
  throw std::logic_error("NewestCovariance: the window's information is singular");
}

}  // namespace

void MarginalizeOldest(const RectifiedCamera& camera, const BundleAdjustmentOptions& options,
                       Window& window) {
  NormalEquations n(camera, window);
  n.AddPrior(window);
  const std::size_t keyframes = window.keyframes.size();
  n.AddKeyframe(window, 0);
  if (keyframes > 1) n.AddInertial(window, 1);
  const std::uint64_t oldest = window.keyframes.front().id;
  for (auto it = window.landmarks.begin(); it != window.landmarks.end();) {
    const bool leaves = it->second.host == oldest;
    if (leaves) n.AddLandmark(options, window, it->second);
    it = leaves ? window.landmarks.erase(it) : std::next(it);
  }
  const WindowLayout& layout = n.layout();
  Indices gone;
  Indices kept;
  Append(layout.Pose(0), 6, gone);
  Append(layout.Pose(1), layout.Pose(keyframes - 1), kept);
  if (layout.inertial) {
    Append(layout.Motion(0), 9, gone);
    Append(layout.Motion(1), 9, kept);
  }
  Append(layout.Errors(), kSkyErrors, kept);
  Prior prior = Eliminate(n.Reduce(), gone, kept);
  window.keyframes.pop_front();
  for (const Keyframe& keyframe : window.keyframes) prior.linearized.push_back(keyframe.T_WB);
  if (layout.inertial) prior.motion = window.keyframes.front().motion;
  prior.errors = window.errors;
  window.prior = prior;
}

StateCovariance NewestCovariance(const NormalEquations& window) {
  const WindowLayout& layout = window.layout();
  const std::size_t newest = layout.keyframes - 1;
  Indices order;
  Indices place;  // in the answer
  Append(0, layout.Pose(newest), order);
  if (layout.inertial) Append(layout.Motion(0), layout.Motion(newest) - layout.Motion(0), order);
  const auto ask = [&](Eigen::Index from, Eigen::Index count, Eigen::Index to) {
    Append(from, count, order);
    Append(to, count, place);
  };
  ask(layout.Pose(newest), 6, 0);
  if (layout.inertial) ask(layout.Motion(newest), 9, 6);
  ask(layout.Errors(), kSkyErrors, 15);
  const Eigen::MatrixXd root = LastInverseRoot(window, order, std::ssize(place));
  StateCovariance covariance = StateCovariance::Zero();
  covariance(place, place) = root.transpose() * root;
  return covariance;
}

}  // namespace polnav::nav
