#include "nav/polarization/turn_solver.h"

#include <ceres/ceres.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "nav/polarization/instrument_errors.h"
#include "nav/polarization/mirror_patches.h"

namespace polnav::nav {
namespace {

constexpr int kStride = 3;              // every so many blocks: neighbours say the same
constexpr double kPatches = 60.0;       // of a picture, each worth one independent residual
constexpr double kAcrossSigma = 0.005;  // of a patch: what Rayleigh leaves out
constexpr double kPairsSigma = 0.002;   // of a patch: slopes within blocks
// Among the errors.
constexpr int kMountTurn = 14;
constexpr int kFocal = 15;
// Given sigmas of zero mean that nobody said.
constexpr double kUnsaidGainSigma = 0.01;
constexpr double kUnsaidOffsetSigma = 0.002;
constexpr double kUnsaidPolarizerSigma_rad = 0.01;
constexpr double kUnsaidMountSigma_rad = 0.02;
constexpr double kScatteringSigma = 0.1;      // of light scattered many times, over all light
constexpr double kRoundSigma = 0.03;          // of the focal length as a measure of the sky
constexpr double kKept = 1e-9;                // of what is not to move
constexpr double kUnsaidCenterSigma = 0.005;  // over the focal length

double Said(double sigma, double unsaid) { return sigma > 0.0 ? sigma : unsaid; }

// What is solved for, a heading a picture apart: instrument (12), view (6), scattering (1).
constexpr int kSolved = kInstrumentErrors + 1;
using SolvedVector = Eigen::Matrix<double, kSolved, 1>;

// Beforehand, one sigma. The focal length takes up what skies have beside the pattern, which is as
// round as its error would be: hence wide, and not believed afterwards.
SolvedVector SpreadBeforehand(const PolarizationCameraCalibration& given, bool any_stated) {
  const double mount = Said(given.mount_sigma_rad, kUnsaidMountSigma_rad);
  const double center = Said(given.center_sigma_px, kUnsaidCenterSigma * given.lens.focal_px);
  SolvedVector sigma;
  sigma << Eigen::Vector4d::Constant(Said(given.gain_sigma, kUnsaidGainSigma)),
      Eigen::Vector4d::Constant(Said(given.offset_sigma, kUnsaidOffsetSigma)),
      Eigen::Vector4d::Constant(Said(given.polarizer_sigma_rad, kUnsaidPolarizerSigma_rad)), mount,
      mount, any_stated ? mount : kKept, kRoundSigma, center, center, kScatteringSigma;
  return sigma;
}

template <int size>
struct Prior {
  Eigen::Matrix<double, size, 1> sigma;
  template <typename T>
  bool operator()(const T* values, T* residual) const {
    for (int k = 0; k < size; ++k) residual[k] = values[k] / sigma[k];
    return true;
  }
};

template <int size>
void AddPrior(ceres::Problem& problem, const Eigen::Matrix<double, size, 1>& sigma,
              double* values) {
  problem.AddResidualBlock(
      new ceres::AutoDiffCostFunction<Prior<size>, size, size>(new Prior<size>{sigma}), nullptr,
      values);
}

struct TurnProblem {
  ceres::Problem problem;
  TurnErrors errors;
  std::vector<double> headings;
  std::vector<std::vector<ceres::ResidualBlockId>> patches;  // of sky, over all pictures
  std::vector<double*> solved;                               // the camera's first
  SolvedVector beforehand;
};

void Build(const CompassOptions& options, const TurnSolver& solver,
           const PolarizationCameraCalibration& given, const std::vector<TurnView>& views,
           TurnProblem& turn) {
  bool any_stated = false;
  for (const TurnView& view : views) {
    any_stated = any_stated || view.stated_rad;
    turn.headings.push_back(view.stated_rad.value_or(view.heading_rad));
  }
  turn.beforehand = SpreadBeforehand(given, any_stated);
  AddPrior<12>(turn.problem, turn.beforehand.head<12>(), turn.errors.instrument.data());
  AddPrior<6>(turn.problem, turn.beforehand.segment<6>(12), turn.errors.view.data());
  AddPrior<1>(turn.problem, turn.beforehand.tail<1>(), &turn.errors.scattering);
  turn.solved = {turn.errors.instrument.data(), turn.errors.view.data(), &turn.errors.scattering};
  const MirrorPatches patches(DegToRad(options.correlation_deg));
  turn.patches.resize(patches.count());
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (const TurnResidual& residual : solver.ResidualsOf(views[i])) {
      const double sun_angle = turn.headings[i] - residual.sun_azimuth_rad;
      const MirrorPatch patch = patches.Of(residual.axes_B.col(2), sun_angle);
      auto* cost =
          new ceres::AutoDiffCostFunction<TurnResidual, 2, 12, 6, 1, 1>(new TurnResidual(residual));
      turn.patches[patch.index].push_back(turn.problem.AddResidualBlock(
          cost, new ceres::CauchyLoss(2.0), turn.errors.instrument.data(), turn.errors.view.data(),
          &turn.errors.scattering, &turn.headings[i]));
    }
    if (views[i].stated_rad) {
      turn.problem.SetParameterBlockConstant(&turn.headings[i]);
    } else {
      turn.solved.push_back(&turn.headings[i]);
    }
  }
}

// Of what each patch of sky pulls the solution by, together with its mirror image and in all
// pictures. All pulls balance, and so would each patch's if the sky were the pattern and pixels had
// no noise: how far it does not is what the errors of a patch, alike as they may be, really do.
Eigen::MatrixXd Scatter(TurnProblem& turn, Eigen::Index size) {
  Eigen::MatrixXd scatter = Eigen::MatrixXd::Zero(size, size);
  double count = 0.0;
  ceres::Problem::EvaluateOptions options;
  options.parameter_blocks = turn.solved;
  for (const auto& blocks : turn.patches) {
    if (blocks.empty()) continue;
    options.residual_blocks = blocks;
    std::vector<double> gradient;
    turn.problem.Evaluate(options, nullptr, nullptr, &gradient, nullptr);
    const Eigen::Map<const Eigen::VectorXd> pull(gradient.data(), size);
    scatter += pull * pull.transpose();
    count += 1.0;
  }
  return scatter * count / std::max(count - 1.0, 1.0);
}

// The sandwich estimate: the curvature's inverse about what the pulls really scatter by, the
// priors' own part as believed.
InstrumentCovariance CovarianceAfter(TurnProblem& turn,
                                     const PolarizationCameraCalibration& given) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const std::vector<const double*> wanted(turn.solved.begin(), turn.solved.end());
  const Eigen::Index size = kSolved + static_cast<Eigen::Index>(wanted.size()) - 3;
  RowMajor inverse(size, size);
  ceres::Covariance covariance({});
  if (!covariance.Compute(wanted, &turn.problem) ||
      !covariance.GetCovarianceMatrix(wanted, inverse.data())) {
    throw std::invalid_argument("the pictures of the turn do not fix the camera");
  }
  Eigen::MatrixXd scatter = Scatter(turn, size);
  scatter.diagonal().head<kSolved>() += turn.beforehand.cwiseAbs2().cwiseInverse();
  const Eigen::MatrixXd rows = inverse.topRows<kInstrumentErrors>();
  InstrumentCovariance result = rows * scatter * rows.transpose();
  // What was kept is as unsure as it was.
  const auto keep = [&result](int index, double sigma) {
    result.row(index).setZero();
    result.col(index).setZero();
    result(index, index) = sigma * sigma;
  };
  keep(kFocal, given.focal_sigma);
  if (turn.beforehand[kMountTurn] == kKept) keep(kMountTurn, given.mount_sigma_rad);
  return result;
}

}  // namespace

std::vector<TurnResidual> TurnSolver::ResidualsOf(const TurnView& view) const {
  std::vector<TurnResidual> residuals;
  const double least_up = std::sin(DegToRad(options_.min_elevation_deg));
  for (int row = kStride / 2; row < reader_.rows(); row += kStride) {
    for (int col = kStride / 2; col < reader_.cols(); col += kStride) {
      const ChannelBlock& block =
          view.channels[static_cast<std::size_t>(row * reader_.cols() + col)];
      const Eigen::Vector2d middle = reader_.Center(col, row);
      const PixelAxes axes = AxesOfPixel(given_.lens, middle);
      TurnResidual residual;
      residual.axes_B << given_.T_BS.q * axes.x_S, given_.T_BS.q * axes.y_S,
          given_.T_BS.q * axes.ray_S;
      const bool outside =
          options_.radius_px > 0.0 && (middle - given_.lens.center_px).norm() > options_.radius_px;
      if (block.usable < 1.0F || residual.axes_B(2, 2) < least_up || outside) continue;
      residual.turn_by_lens = TurnByLens(given_, middle);
      residual.mean = block.mean.cast<double>();
      residual.polarizer_rad = Eigen::Map<const Eigen::Vector4d>(given_.polarizer_rad.data());
      residual.gain = Eigen::Map<const Eigen::Vector4d>(given_.gain.data());
      residual.offset = Eigen::Map<const Eigen::Vector4d>(given_.offset.data());
      residual.sun_azimuth_rad = view.sun_azimuth_rad;
      residual.sun_elevation_rad = view.sun_elevation_rad;
      residuals.push_back(residual);
    }
  }
  const double alike = std::sqrt(std::max(1.0, static_cast<double>(residuals.size()) / kPatches));
  for (TurnResidual& residual : residuals) {
    residual.across_sigma = kAcrossSigma * alike;
    residual.pairs_sigma = kPairsSigma * alike;
  }
  return residuals;
}

TurnErrors TurnSolver::Solve(const std::vector<TurnView>& views,
                             InstrumentCovariance* covariance) const {
  TurnProblem turn;
  Build(options_, *this, given_, views, turn);
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_SCHUR;
  solver.max_num_iterations = 30;
  solver.num_threads = 1;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &turn.problem, &summary);
  if (!summary.IsSolutionUsable()) {
    throw std::invalid_argument("the pictures of the turn do not fix the camera: " +
                                summary.message);
  }
  if (covariance != nullptr) *covariance = CovarianceAfter(turn, given_);
  return turn.errors;
}

}  // namespace polnav::nav
