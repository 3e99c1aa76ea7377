#include "nav/graph/normal_equations.h"

#include <Eigen/LU>
#include <cmath>
#include <numeric>

#include "nav/graph/edges.h"

namespace polnav::nav {
namespace {

// Information that a landmark's inverse depth gets for free, so that one seen once from far away
// does not make its 3x3 block singular: 1 / (1000 1/m)^2, nothing beside a single disparity.
constexpr double kFreeInformation = 1e-6;

// Huber's factor on residual and Jacobian; adds the loss to the cost.
double RobustScale(double norm, double huber_sigmas, double& cost) {
  if (norm <= huber_sigmas) {
    cost += 0.5 * norm * norm;
    return 1.0;
  }
  cost += huber_sigmas * (norm - 0.5 * huber_sigmas);
  return std::sqrt(huber_sigmas / norm);
}

// Cauchy's, likewise: what is far off counts for nothing.
double RedescendingScale(double norm, double sigmas, double& cost) {
  const double ratio2 = norm * norm / (sigmas * sigmas);
  cost += 0.5 * sigmas * sigmas * std::log1p(ratio2);
  return 1.0 / std::sqrt(1.0 + ratio2);
}

// Beyond, the IMU's word counts for less: a fault, not noise. Expected are 1.7 (attitude) and 2.4
// (velocity and position).
constexpr double kInertialSigmas = 4.0;

// Factors on the rows of an inertial residual. While level and velocity are still being found a
// large residual is the state's; afterwards it is a sensor's that has gone wrong.
Vector15d InertialScales(const InertialEdge& edge, const Vector15d& residual, double& cost) {
  const auto scale = edge.settled ? RedescendingScale : RobustScale;
  Vector15d scales = Vector15d::Ones();
  scales.head<3>().setConstant(scale(residual.head<3>().norm(), kInertialSigmas, cost));
  scales.segment<6>(3).setConstant(scale(residual.segment<6>(3).norm(), kInertialSigmas, cost));
  cost += 0.5 * residual.tail<6>().squaredNorm();
  return scales;
}

}  // namespace

NormalEquations::NormalEquations(const RectifiedCamera& camera, const Window& window)
    : camera_(camera),
      viewpoints_(ViewpointsOf(camera, window)),
      layout_{window.keyframes.size(), window.inertial},
      H_(Eigen::MatrixXd::Zero(layout_.size(), layout_.size())),
      g_(Eigen::VectorXd::Zero(layout_.size())) {}

void NormalEquations::AddPrior(const Window& window) {
  const Prior& prior = window.prior;
  Eigen::MatrixXd J = prior.jacobian;
  Eigen::VectorXd r = prior.residual;
  for (std::size_t i = 0; i < prior.linearized.size(); ++i) {
    const auto at = layout_.Pose(i);
    const auto delta = Difference(window.keyframes[i].T_WB, prior.linearized[i]);
    r += prior.jacobian.middleCols<6>(at) * delta;
    J.middleCols<3>(at + 3) =
        prior.jacobian.middleCols<3>(at + 3) * InverseLeftJacobian(delta.tail<3>());
  }
  std::vector<Eigen::Index> at(static_cast<std::size_t>(layout_.Pose(prior.linearized.size())));
  std::iota(at.begin(), at.end(), 0);
  const auto take = [&](Eigen::Index from, const Eigen::VectorXd& delta) {
    r += prior.jacobian.middleCols(std::ssize(at), delta.size()) * delta;
    for (Eigen::Index k = 0; k < delta.size(); ++k) at.push_back(from + k);
  };
  if (prior.motion) {
    take(layout_.Motion(0), Difference(window.keyframes[0].motion, *prior.motion));
  }
  if (prior.errors) take(layout_.Errors(), window.errors - *prior.errors);
  H_(at, at) += J.transpose() * J;
  g_(at) += J.transpose() * r;
  cost_ += 0.5 * r.squaredNorm();
}

void NormalEquations::AddKeyframe(const Window& window, std::size_t i) {
  const Keyframe& keyframe = window.keyframes[i];
  const auto pose = layout_.Pose(i);
  const auto motion = layout_.Motion(i);
  if (keyframe.heading) {
    const HeadingResidual e = EvaluateHeading(*keyframe.heading, keyframe.T_WB, window.errors);
    const auto errors = layout_.Errors();
    H_.block<kSkyErrors, 6>(errors, pose) += e.by_errors.transpose() * e.by_pose;
    H_.block<kSkyErrors, kSkyErrors>(errors, errors) += e.by_errors.transpose() * e.by_errors;
    g_.segment<kSkyErrors>(errors) += e.by_errors.transpose() * e.residual;
    H_.block<6, 6>(pose, pose) += e.by_pose.transpose() * e.by_pose;
    g_.segment<6>(pose) += e.by_pose.transpose() * e.residual;
    cost_ += 0.5 * e.residual * e.residual;
  }
  if (keyframe.motion_prior) {
    const MotionPrior& prior = *keyframe.motion_prior;
    Eigen::Matrix<double, 9, 1> weight;
    for (int k = 0; k < 3; ++k) weight.segment<3>(3 * k).setConstant(1.0 / prior.sigmas(k));
    const Eigen::Matrix<double, 9, 1> r =
        weight.cwiseProduct(Difference(keyframe.motion, prior.mean));
    H_.diagonal().segment<9>(motion) += weight.cwiseAbs2();
    g_.segment<9>(motion) += weight.cwiseProduct(r);
    cost_ += 0.5 * r.squaredNorm();
  }
}

void NormalEquations::AddInertial(const Window& window, std::size_t i) {
  const Keyframe& keyframe = window.keyframes[i];
  if (i == 0 || !keyframe.inertial) return;
  const Keyframe& before = window.keyframes[i - 1];
  const InertialResidual e = EvaluateInertial(*keyframe.inertial, before.T_WB, before.motion,
                                              keyframe.T_WB, keyframe.motion);
  const Vector15d scales = InertialScales(*keyframe.inertial, e.residual, cost_);
  Eigen::Matrix<double, 15, 30> J;
  J << e.by_pose_i, e.by_pose_j, e.by_motion_i, e.by_motion_j;
  J = scales.asDiagonal() * J;
  const Vector15d r = scales.cwiseProduct(e.residual);
  const Eigen::Matrix<double, 30, 30> JtJ = J.transpose() * J;
  const Eigen::Matrix<double, 30, 1> Jtr = J.transpose() * r;
  // Poses i and j are neighbours in d, and so are their motions.
  const auto poses = layout_.Pose(i - 1);
  const auto motions = layout_.Motion(i - 1);
  H_.block<12, 12>(poses, poses) += JtJ.topLeftCorner<12, 12>();
  H_.block<18, 12>(motions, poses) += JtJ.bottomLeftCorner<18, 12>();
  H_.block<18, 18>(motions, motions) += JtJ.bottomRightCorner<18, 18>();
  g_.segment<12>(poses) += Jtr.head<12>();
  g_.segment<18>(motions) += Jtr.tail<18>();
}

void NormalEquations::AddLandmark(const BundleAdjustmentOptions& options, const Window& window,
                                  const Landmark& landmark) {
  const std::size_t host = IndexOf(window, landmark.host);
  const auto h = layout_.Pose(host);
  LandmarkBlock block{.H = Eigen::Vector3d(0.0, 0.0, kFreeInformation).asDiagonal(),
                      .g = Eigen::Vector3d::Zero(),
                      .begin = couplings_.size(),
                      .end = 0};
  couplings_.push_back({h, Matrix3x6d::Zero()});
  for (const Sighting& s : landmark.sightings) {
    const std::size_t target = IndexOf(window, s.keyframe);
    auto e = Reproject(camera_, viewpoints_[host], viewpoints_[target], landmark.coordinates,
                       s.pixel, options.sigmas);
    if (!e) continue;
    const double scale = RobustScale(e->residual.norm(), options.huber_sigmas, cost_);
    e->residual *= scale;
    e->by_landmark *= scale;
    block.H += e->by_landmark.transpose() * e->by_landmark;
    block.g += e->by_landmark.transpose() * e->residual;
    if (target == host) continue;
    e->by_host *= scale;
    e->by_target *= scale;
    const auto t = layout_.Pose(target);
    H_.block<6, 6>(h, h) += e->by_host.transpose() * e->by_host;
    H_.block<6, 6>(t, t) += e->by_target.transpose() * e->by_target;
    H_.block<6, 6>(t, h) += e->by_target.transpose() * e->by_host;  // the host is the older one
    g_.segment<6>(h) += e->by_host.transpose() * e->residual;
    g_.segment<6>(t) += e->by_target.transpose() * e->residual;
    couplings_[block.begin].H += e->by_landmark.transpose() * e->by_host;
    couplings_.push_back({t, e->by_landmark.transpose() * e->by_target});
  }
  block.end = couplings_.size();
  landmarks_.push_back(block);
}

Eigen::Matrix3d NormalEquations::LandmarkBlock::Inverse(double damping) const {
  Eigen::Matrix3d damped = H;
  damped.diagonal() *= 1.0 + damping;
  return damped.inverse();
}

NormalEquations::Reduced NormalEquations::Reduce(double damping) const {
  Reduced reduced{H_, g_};
  reduced.H.diagonal() *= 1.0 + damping;
  for (const LandmarkBlock& landmark : landmarks_) {
    const Eigen::Matrix3d inverse = landmark.Inverse(damping);
    reduced.landmarks_gain += 0.5 * landmark.g.dot(inverse * landmark.g);
    for (std::size_t i = landmark.begin; i < landmark.end; ++i) {
      const Coupling& row = couplings_[i];
      const Eigen::Matrix<double, 6, 3> gain = row.H.transpose() * inverse;
      reduced.g.segment<6>(row.at) -= gain * landmark.g;
      // Sightings come in the order of keyframes: columns up to i are the older ones.
      for (std::size_t j = landmark.begin; j <= i; ++j) {
        reduced.H.block<6, 6>(row.at, couplings_[j].at) -= gain * couplings_[j].H;
      }
    }
  }
  reduced.H.triangularView<Eigen::StrictlyUpper>() = reduced.H.transpose();
  return reduced;
}

std::vector<Eigen::Vector3d> NormalEquations::LandmarkSteps(const Eigen::VectorXd& step,
                                                            double damping) const {
  std::vector<Eigen::Vector3d> steps;
  steps.reserve(landmarks_.size());
  for (const LandmarkBlock& landmark : landmarks_) {
    Eigen::Vector3d g = landmark.g;
    for (std::size_t i = landmark.begin; i < landmark.end; ++i) {
      g += couplings_[i].H * step.segment<6>(couplings_[i].at);
    }
    steps.push_back(-(landmark.Inverse(damping) * g));
  }
  return steps;
}

NormalEquations LinearizeWindow(const RectifiedCamera& camera,
                                const BundleAdjustmentOptions& options, const Window& window) {
  NormalEquations equations(camera, window);
  equations.AddPrior(window);
  for (std::size_t i = 0; i < window.keyframes.size(); ++i) {
    equations.AddKeyframe(window, i);
    equations.AddInertial(window, i);
  }
  for (const auto& [id, landmark] : window.landmarks) {
    equations.AddLandmark(options, window, landmark);
  }
  return equations;
}

}  // namespace polnav::nav
