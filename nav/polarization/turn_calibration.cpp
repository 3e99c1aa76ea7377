#include "nav/polarization/turn_calibration.h"

#include <ceres/ceres.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <utility>

#include "nav/polarization/compass.h"

namespace polnav::nav {
namespace {

constexpr std::size_t kFewestPictures = 6;
constexpr int kHoldOutEvery = 3;
constexpr int kStride = 3;              // every so many blocks: neighbours say the same
constexpr double kPatches = 60.0;       // of a picture, each worth one independent residual
constexpr double kAcrossSigma = 0.005;  // of a patch: what Rayleigh leaves out
constexpr double kPairsSigma = 0.002;   // of a patch: slopes within blocks
// Given sigmas of zero mean that nobody said.
constexpr double kUnsaidGainSigma = 0.01;
constexpr double kUnsaidOffsetSigma = 0.002;
constexpr double kUnsaidPolarizerSigma_rad = 0.01;
constexpr double kUnsaidMountSigma_rad = 0.02;

double Said(double sigma, double unsaid) { return sigma > 0.0 ? sigma : unsaid; }

struct View {
  std::vector<ChannelBlock> channels;
  double sun_azimuth_rad = 0.0;
  double sun_elevation_rad = 0.0;
  double heading_rad = 0.0;  // as the compass reads it
  std::optional<double> stated_rad;
};

struct Parameters {
  std::array<double, 12> instrument{};
  std::array<double, 3> mount{};
};

struct Prior {
  double sigma;
  int index;
  template <typename T>
  bool operator()(const T* values, T* residual) const {
    residual[0] = values[index] / sigma;
    return true;
  }
};

class Turn {
 public:
  Turn(const CompassOptions& options, const PolarizationCameraCalibration& given)
      : options_(options),
        given_(given),
        reader_(given, BlockSizeFor(given.width_px, given.height_px), options.saturation) {}

  [[nodiscard]] std::vector<View> Look(const std::vector<TurnPicture>& pictures) const;
  [[nodiscard]] Parameters Solve(const std::vector<View>& views, Parameters* sigmas) const;
  [[nodiscard]] HeldOut Try(const std::vector<View>& views, const Parameters& parameters) const;
  [[nodiscard]] PolarizationCameraCalibration Apply(const Parameters& parameters) const;

 private:
  [[nodiscard]] std::vector<TurnResidual> ResidualsOf(const View& view) const;
  void AddPriors(ceres::Problem& problem, Parameters& parameters) const;

  CompassOptions options_;
  PolarizationCameraCalibration given_;
  BlockReader reader_;
};

std::vector<View> Turn::Look(const std::vector<TurnPicture>& pictures) const {
  const Compass compass(options_, given_);
  std::vector<View> views;
  for (const TurnPicture& picture : pictures) {
    const CompassReading reading = compass.Read(picture.mosaic, picture.sun_W);
    if (reading.status != CompassStatus::kHeading) continue;
    View view;
    reader_.ReadChannels(picture.mosaic, view.channels);
    view.sun_azimuth_rad = std::atan2(picture.sun_W.x(), picture.sun_W.y());
    view.sun_elevation_rad = std::atan2(picture.sun_W.z(), picture.sun_W.head<2>().norm());
    view.heading_rad = reading.heading_rad;
    view.stated_rad = picture.heading_rad;
    views.push_back(std::move(view));
  }
  return views;
}

std::vector<TurnResidual> Turn::ResidualsOf(const View& view) const {
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

void Turn::AddPriors(ceres::Problem& problem, Parameters& parameters) const {
  const auto instrument = [&](int index, double sigma) {
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<Prior, 1, 12>(new Prior{sigma, index}),
                             nullptr, parameters.instrument.data());
  };
  for (int k = 0; k < 4; ++k) {
    instrument(k, Said(given_.gain_sigma, kUnsaidGainSigma));
    instrument(4 + k, Said(given_.offset_sigma, kUnsaidOffsetSigma));
    instrument(8 + k, Said(given_.polarizer_sigma_rad, kUnsaidPolarizerSigma_rad));
  }
  for (int k = 0; k < 3; ++k) {
    const double sigma =
        Said(std::hypot(given_.mount_sigma_rad, given_.center_sigma_px / given_.lens.focal_px),
             kUnsaidMountSigma_rad);
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<Prior, 1, 3>(new Prior{sigma, k}),
                             nullptr, parameters.mount.data());
  }
}

// Standard deviations of a block's values, from the solution's curvature. In groups of `group` only
// differences count: what four channels have in common is light, or a turn of the mounting.
void Deviations(ceres::Covariance& covariance, const double* block, int size, int group,
                double* sigmas) {
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> matrix(size, size);
  covariance.GetCovarianceBlock(block, block, matrix.data());
  for (int first = 0; first < size; first += group) {
    const Eigen::MatrixXd some = matrix.block(first, first, group, group);
    const Eigen::MatrixXd centred =
        Eigen::MatrixXd::Identity(group, group) -
        Eigen::MatrixXd::Constant(group, group, group > 1 ? 1.0 / group : 0.0);
    const Eigen::MatrixXd apart = centred * some * centred;
    for (int k = 0; k < group; ++k) sigmas[first + k] = std::sqrt(std::max(0.0, apart(k, k)));
  }
}

Parameters Turn::Solve(const std::vector<View>& views, Parameters* sigmas) const {
  Parameters parameters;
  std::vector<double> headings;
  for (const View& view : views) headings.push_back(view.stated_rad.value_or(view.heading_rad));
  ceres::Problem problem;
  bool any_stated = false;
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (const TurnResidual& residual : ResidualsOf(views[i])) {
      auto* cost =
          new ceres::AutoDiffCostFunction<TurnResidual, 2, 12, 3, 1>(new TurnResidual(residual));
      problem.AddResidualBlock(cost, new ceres::CauchyLoss(2.0), parameters.instrument.data(),
                               parameters.mount.data(), &headings[i]);
    }
    if (views[i].stated_rad) {
      any_stated = true;
      problem.SetParameterBlockConstant(&headings[i]);
    }
  }
  AddPriors(problem, parameters);
  if (!any_stated) {
    problem.SetManifold(parameters.mount.data(), new ceres::SubsetManifold(3, {2}));
  }
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::DENSE_SCHUR;
  solver.max_num_iterations = 30;
  solver.num_threads = 1;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  if (!summary.IsSolutionUsable()) {
    throw std::invalid_argument("the pictures of the turn do not fix the camera: " +
                                summary.message);
  }
  if (sigmas != nullptr) {
    ceres::Covariance covariance({});
    const std::vector<std::pair<const double*, const double*>> wanted = {
        {parameters.instrument.data(), parameters.instrument.data()},
        {parameters.mount.data(), parameters.mount.data()}};
    if (!covariance.Compute(wanted, &problem)) {
      throw std::invalid_argument("the pictures of the turn do not fix the camera");
    }
    Deviations(covariance, parameters.instrument.data(), 12, 4, sigmas->instrument.data());
    Deviations(covariance, parameters.mount.data(), 3, 1, sigmas->mount.data());
    if (!any_stated) sigmas->mount[2] = given_.mount_sigma_rad;
  }
  return parameters;
}

HeldOut Turn::Try(const std::vector<View>& views, const Parameters& parameters) const {
  HeldOut result;
  double pairs = 0.0;
  double across = 0.0;
  double count = 0.0;
  double heading_error = 0.0;
  int stated = 0;
  for (const View& view : views) {
    // The heading that fits best, by Newton's steps on the residuals' mean slope.
    std::vector<TurnResidual> residuals = ResidualsOf(view);
    double heading = view.heading_rad;
    const auto evaluate = [&](double at, std::vector<std::array<double, 2>>& values) {
      values.clear();
      for (const TurnResidual& residual : residuals) {
        std::array<double, 2> value{};
        residual(parameters.instrument.data(), parameters.mount.data(), &at, value.data());
        values.push_back({value[0] * residual.pairs_sigma, value[1] * residual.across_sigma});
      }
    };
    std::vector<std::array<double, 2>> here;
    std::vector<std::array<double, 2>> there;
    for (int i = 0; i < 5; ++i) {
      constexpr double kStep_rad = 1e-4;
      evaluate(heading, here);
      evaluate(heading + kStep_rad, there);
      double slope2 = 0.0;
      double pull = 0.0;
      for (std::size_t k = 0; k < here.size(); ++k) {
        const double slope = (there[k][1] - here[k][1]) / kStep_rad;
        const double weight = 1.0 / (1.0 + std::pow(here[k][1] / (2.0 * kAcrossSigma), 2));
        slope2 += weight * slope * slope;
        pull -= weight * slope * here[k][1];
      }
      heading += pull / std::max(slope2, 1e-12);
    }
    evaluate(heading, here);
    for (const auto& value : here) {
      pairs += value[0] * value[0];
      across += value[1] * value[1];
      count += 1.0;
    }
    if (view.stated_rad) {
      heading_error += std::pow(WrapPi(heading - *view.stated_rad), 2);
      ++stated;
    }
  }
  result.pairs = std::sqrt(pairs / std::max(count, 1.0));
  result.across = std::sqrt(across / std::max(count, 1.0));
  if (stated > 0) result.heading_rad = std::sqrt(heading_error / stated);
  return result;
}

PolarizationCameraCalibration Turn::Apply(const Parameters& parameters) const {
  PolarizationCameraCalibration calibration = given_;
  for (std::size_t k = 0; k < 4; ++k) {
    calibration.gain[k] *= 1.0 + parameters.instrument[k];
    calibration.offset[k] += parameters.instrument[4 + k];
    calibration.polarizer_rad[k] += parameters.instrument[8 + k];
  }
  const Eigen::Vector3d turn(parameters.mount[0], parameters.mount[1], parameters.mount[2]);
  const double angle = turn.norm();
  if (angle > 0.0) {
    calibration.T_BS.q = Eigen::AngleAxisd(angle, turn / angle) * given_.T_BS.q;
  }
  return calibration;
}

// Of one of the four.
double SpreadOf(const std::array<double, 12>& sigmas, std::size_t first) {
  double square = 0.0;
  for (std::size_t k = first; k < first + 4; ++k) square += sigmas[k] * sigmas[k];
  return std::sqrt(square / 4.0);
}

}  // namespace

TurnCalibration CalibrateFromTurn(const CompassOptions& options,
                                  const PolarizationCameraCalibration& given,
                                  const std::vector<TurnPicture>& pictures) {
  const Turn turn(options, given);
  const std::vector<View> views = turn.Look(pictures);
  if (views.size() < kFewestPictures) {
    throw std::invalid_argument("a turn needs six pictures with a heading; there are " +
                                std::to_string(views.size()));
  }
  std::vector<View> fitted;
  std::vector<View> held_out;
  for (std::size_t i = 0; i < views.size(); ++i) {
    (i % kHoldOutEvery == kHoldOutEvery - 1 ? held_out : fitted).push_back(views[i]);
  }
  TurnCalibration result{.pictures = static_cast<int>(views.size()),
                         .held_out = static_cast<int>(held_out.size())};
  result.before = turn.Try(held_out, Parameters{});
  result.after = turn.Try(held_out, turn.Solve(fitted, nullptr));
  Parameters sigmas;
  const Parameters parameters = turn.Solve(views, &sigmas);
  result.calibration = turn.Apply(parameters);
  result.calibration.gain_sigma = SpreadOf(sigmas.instrument, 0);
  result.calibration.offset_sigma = SpreadOf(sigmas.instrument, 4);
  result.calibration.polarizer_sigma_rad = SpreadOf(sigmas.instrument, 8);
  result.calibration.mount_sigma_rad = std::sqrt(
      (std::pow(sigmas.mount[0], 2) + std::pow(sigmas.mount[1], 2) + std::pow(sigmas.mount[2], 2)) /
      3.0);
  result.calibration.center_sigma_px = 0.0;  // in the mounting's
  return result;
}

}  // namespace polnav::nav
