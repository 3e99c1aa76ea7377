// What do the window's edges ask of its unknowns, near where they are?
//
// Cost 1/2 sum |r|^2, Huber-robust where an edge may be wrong, as 1/2 d^T H d + g^T d + cost about
// the current values. d stacks the keyframes' (dp, dtheta) in W, six each, then with an IMU their
// (dv, dgyro_bias, daccel_bias), nine each, and last the sky's errors; landmarks are kept aside,
// each with a block of its own, and eliminated by Reduce. Internal to nav/graph.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "nav/graph/window.h"

namespace polnav::nav {

struct BundleAdjustmentOptions {
  PixelSigmas sigmas;
  double huber_sigmas = 1.5;
  int max_iterations = 6;
};

struct WindowLayout {
  std::size_t keyframes = 0;
  bool inertial = false;

  [[nodiscard]] Eigen::Index Pose(std::size_t i) const { return 6 * static_cast<Eigen::Index>(i); }
  [[nodiscard]] Eigen::Index Motion(std::size_t i) const {
    return 6 * static_cast<Eigen::Index>(keyframes) + 9 * static_cast<Eigen::Index>(i);
  }
  [[nodiscard]] Eigen::Index Errors() const {
    return inertial ? Motion(keyframes) : Pose(keyframes);
  }
  [[nodiscard]] Eigen::Index size() const { return Errors() + kSkyErrors; }
};

class NormalEquations {
 public:
  NormalEquations(const RectifiedCamera& camera, const Window& window);

  void AddPrior(const Window& window);
  void AddKeyframe(const Window& window, std::size_t keyframe);  // the edges of it alone
  void AddInertial(const Window& window, std::size_t keyframe);  // from the one before, if any
  void AddLandmark(const BundleAdjustmentOptions& options, const Window& window,
                   const Landmark& landmark);

  // Of all but the landmarks, with these eliminated. damping: Levenberg-Marquardt's, relative.
  struct Reduced {
    Eigen::MatrixXd H;
    Eigen::VectorXd g;
    double landmarks_gain = 0.0;  // of cost, when they alone move
  };
  [[nodiscard]] Reduced Reduce(double damping = 0.0) const;

  // The landmarks' step, in the order in which they were added, that goes with the others' one.
  [[nodiscard]] std::vector<Eigen::Vector3d> LandmarkSteps(const Eigen::VectorXd& step,
                                                           double damping) const;

  [[nodiscard]] double cost() const { return cost_; }
  [[nodiscard]] const WindowLayout& layout() const { return layout_; }

 private:
  // What couples a landmark to one pose.
  struct Coupling {
    Eigen::Index at;
    Matrix3x6d H;
  };
  struct LandmarkBlock {
    Eigen::Matrix3d H;
    Eigen::Vector3d g;
    std::size_t begin;  // of its couplings
    std::size_t end;

    [[nodiscard]] Eigen::Matrix3d Inverse(double damping) const;
  };

  RectifiedCamera camera_;
  std::vector<Viewpoint> viewpoints_;  // of the keyframes
  WindowLayout layout_;
  Eigen::MatrixXd H_;  // lower triangle of blocks
  Eigen::VectorXd g_;
  double cost_ = 0.0;
  std::vector<LandmarkBlock> landmarks_;
  std::vector<Coupling> couplings_;
};

// Everything in the window.
[[nodiscard]] NormalEquations LinearizeWindow(const RectifiedCamera& camera,
                                              const BundleAdjustmentOptions& options,
                                              const Window& window);

}  // namespace polnav::nav
