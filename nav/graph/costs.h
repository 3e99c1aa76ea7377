// How does Ceres see the window's edges? Internal to nav/graph.
#pragma once

#include <ceres/ceres.h>

#include <algorithm>
#include <array>

#include "nav/graph/edges.h"
#include "nav/stereo/reprojection.h"

namespace polnav::nav {

// A pose as Ceres sees it: p, then q as x y z w.
using PoseBlock = std::array<double, 7>;

inline PoseBlock ToBlock(const Pose& pose) {
  return {pose.p.x(), pose.p.y(), pose.p.z(), pose.q.x(), pose.q.y(), pose.q.z(), pose.q.w()};
}

inline Pose ToPose(const double* block) {
  return {Eigen::Quaterniond(block[6], block[3], block[4], block[5]),
          Eigen::Vector3d(block[0], block[1], block[2])};
}

template <int kRows>
using RowMajor7 = Eigen::Matrix<double, kRows, 7, Eigen::RowMajor>;
using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

template <int kRows>
void PutResidual(const Eigen::Matrix<double, kRows, 1>& residual, double* out) {
  std::copy(residual.data(), residual.data() + kRows, out);
}

template <int kRows>
void PutPoseJacobian(const Eigen::Matrix<double, kRows, 6>& by_pose, double* out) {
  if (out == nullptr) return;
  Eigen::Map<RowMajor7<kRows>> J(out);
  J.setZero();
  J.template leftCols<6>() = by_pose;
}

inline void PutLandmarkJacobian(const Eigen::Matrix3d& by_landmark, double* out) {
  if (out == nullptr) return;
  Eigen::Map<RowMajor3> J(out);
  J = by_landmark;
}

// The edges know their Jacobians by (dp, dtheta) already. They are handed to Ceres in the first
// six of the seven columns, and the manifold's Jacobian picks exactly those.
class PoseManifold final : public ceres::Manifold {
 public:
  int AmbientSize() const override { return 7; }
  int TangentSize() const override { return 6; }
  bool Plus(const double* x, const double* delta, double* x_plus_delta) const override {
    const Eigen::Map<const Eigen::Matrix<double, 6, 1>> d(delta);
    const PoseBlock block = ToBlock(Perturb(ToPose(x), d));
    std::copy(block.begin(), block.end(), x_plus_delta);
    return true;
  }
  bool PlusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 7, 6, Eigen::RowMajor>> J(jacobian);
    J.setIdentity();
    return true;
  }
  bool Minus(const double* y, const double* x, double* y_minus_x) const override {
    PutResidual<6>(Difference(ToPose(y), ToPose(x)), y_minus_x);
    return true;
  }
  bool MinusJacobian(const double*, double* jacobian) const override {
    Eigen::Map<Eigen::Matrix<double, 6, 7, Eigen::RowMajor>> J(jacobian);
    J.setIdentity();
    return true;
  }
};

// Reprojection from a host into another keyframe: blocks host, target, landmark.
class ReprojectionCost final : public ceres::SizedCostFunction<3, 7, 7, 3> {
 public:
  ReprojectionCost(const RectifiedCamera& camera, const StereoPixel& seen,
                   const PixelSigmas& sigmas)
      : camera_(camera), seen_(seen), sigmas_(sigmas) {}

  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const Eigen::Map<const Eigen::Vector3d> landmark(x[2]);
    const auto r = Reproject(camera_, ToPose(x[0]), ToPose(x[1]), landmark, seen_, sigmas_);
    if (!r) return false;  // behind the camera: Ceres takes a shorter step
    PutResidual<3>(r->residual, residuals);
    if (jacobians == nullptr) return true;
    PutPoseJacobian<3>(r->by_host, jacobians[0]);
    PutPoseJacobian<3>(r->by_target, jacobians[1]);
    PutLandmarkJacobian(r->by_landmark, jacobians[2]);
    return true;
  }

 private:
  const RectifiedCamera& camera_;
  StereoPixel seen_;
  PixelSigmas sigmas_;
};

// The host's own sighting: independent of every pose.
class HostCost final : public ceres::SizedCostFunction<3, 3> {
 public:
  HostCost(const RectifiedCamera& camera, const StereoPixel& seen, const PixelSigmas& sigmas)
      : camera_(camera), seen_(seen), sigmas_(sigmas) {}

  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const Eigen::Map<const Eigen::Vector3d> landmark(x[0]);
    const auto r = Reproject(camera_, Pose{}, Pose{}, landmark, seen_, sigmas_);
    if (!r) return false;
    PutResidual<3>(r->residual, residuals);
    if (jacobians != nullptr) PutLandmarkJacobian(r->by_landmark, jacobians[0]);
    return true;
  }

 private:
  const RectifiedCamera& camera_;
  StereoPixel seen_;
  PixelSigmas sigmas_;
};

class HeadingCost final : public ceres::SizedCostFunction<1, 7> {
 public:
  explicit HeadingCost(const HeadingEdge& edge) : edge_(edge) {}
  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const HeadingResidual r = EvaluateHeading(edge_, ToPose(x[0]));
    residuals[0] = r.residual;
    if (jacobians != nullptr) PutPoseJacobian<1>(r.by_pose, jacobians[0]);
    return true;
  }

 private:
  HeadingEdge edge_;
};

class LevelCost final : public ceres::SizedCostFunction<2, 7> {
 public:
  explicit LevelCost(const LevelEdge& edge) : edge_(edge) {}
  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const LevelResidual r = EvaluateLevel(edge_, ToPose(x[0]));
    PutResidual<2>(r.residual, residuals);
    if (jacobians != nullptr) PutPoseJacobian<2>(r.by_pose, jacobians[0]);
    return true;
  }

 private:
  LevelEdge edge_;
};

class PriorCost final : public ceres::CostFunction {
 public:
  explicit PriorCost(const Prior& prior) : prior_(prior) {
    set_num_residuals(static_cast<int>(prior.residual.size()));
    for (std::size_t i = 0; i < prior.linearized.size(); ++i) {
      mutable_parameter_block_sizes()->push_back(7);
    }
  }

  bool Evaluate(double const* const* x, double* residuals, double** jacobians) const override {
    const auto rows = prior_.residual.size();
    Eigen::Map<Eigen::VectorXd> r(residuals, rows);
    r = prior_.residual;
    for (std::size_t i = 0; i < prior_.linearized.size(); ++i) {
      const auto block = prior_.jacobian.middleCols<6>(6 * static_cast<Eigen::Index>(i));
      const Eigen::Matrix<double, 6, 1> delta = Difference(ToPose(x[i]), prior_.linearized[i]);
      r += block * delta;
      if (jacobians == nullptr || jacobians[i] == nullptr) continue;
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 7, Eigen::RowMajor>> J(jacobians[i], rows,
                                                                              7);
      J.setZero();
      J.leftCols<3>() = block.leftCols<3>();
      J.middleCols<3>(3) = block.rightCols<3>() * InverseLeftJacobian(delta.tail<3>());
    }
    return true;
  }

 private:
  const Prior& prior_;
};

}  // namespace polnav::nav
