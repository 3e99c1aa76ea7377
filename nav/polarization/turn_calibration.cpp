#include "nav/polarization/turn_calibration.h"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "nav/polarization/compass.h"
#include "nav/polarization/turn_solver.h"

namespace polnav::nav {
namespace {

constexpr std::size_t kFewestPictures = 6;
constexpr int kHoldOutEvery = 3;
constexpr double kOutlier = 0.01;  // residual across, where a held-out block begins to count less

std::vector<TurnView> Look(const CompassOptions& options,
                           const PolarizationCameraCalibration& given, const BlockReader& reader,
                           const std::vector<TurnPicture>& pictures) {
  const Compass compass(options, given);
  std::vector<TurnView> views;
  for (const TurnPicture& picture : pictures) {
    const CompassReading reading = compass.Read(picture.mosaic, picture.sun_W);
    if (reading.status != CompassStatus::kHeading) continue;
    TurnView view;
    reader.ReadChannels(picture.mosaic, view.channels);
    view.sun_azimuth_rad = std::atan2(picture.sun_W.x(), picture.sun_W.y());
    view.sun_elevation_rad = std::atan2(picture.sun_W.z(), picture.sun_W.head<2>().norm());
    view.heading_rad = reading.heading_rad;
    view.stated_rad = picture.heading_rad;
    views.push_back(std::move(view));
  }
  return views;
}

// Pairs and across, a block, without their sigmas.
using Values = std::vector<std::array<double, 2>>;

Values ValuesAt(double heading_rad, const std::vector<TurnResidual>& residuals,
                const TurnErrors& errors) {
  Values values;
  for (const TurnResidual& residual : residuals) {
    std::array<double, 2> value{};
    residual(errors.instrument.data(), errors.view.data(), &errors.scattering, &heading_rad,
             value.data());
    values.push_back({value[0] * residual.pairs_sigma, value[1] * residual.across_sigma});
  }
  return values;
}

// The heading that fits best, by Gauss-Newton on the residuals across.
double BestHeading(double start_rad, const std::vector<TurnResidual>& residuals,
                   const TurnErrors& errors) {
  constexpr double kStep_rad = 1e-4;
  double heading = start_rad;
  for (int i = 0; i < 5; ++i) {
    const Values here = ValuesAt(heading, residuals, errors);
    const Values there = ValuesAt(heading + kStep_rad, residuals, errors);
    double slope2 = 0.0;
    double pull = 0.0;
    for (std::size_t k = 0; k < here.size(); ++k) {
      const double slope = (there[k][1] - here[k][1]) / kStep_rad;
      const double weight = 1.0 / (1.0 + std::pow(here[k][1] / kOutlier, 2));
      slope2 += weight * slope * slope;
      pull -= weight * slope * here[k][1];
    }
    heading += pull / std::max(slope2, 1e-12);
  }
  return heading;
}

HeldOut Try(const TurnSolver& solver, const std::vector<TurnView>& views,
            const TurnErrors& errors) {
  double pairs = 0.0;
  double across = 0.0;
  double count = 0.0;
  double heading_error = 0.0;
  int stated = 0;
  for (const TurnView& view : views) {
    const std::vector<TurnResidual> residuals = solver.ResidualsOf(view);
    const double heading = BestHeading(view.heading_rad, residuals, errors);
    for (const auto& value : ValuesAt(heading, residuals, errors)) {
      pairs += value[0] * value[0];
      across += value[1] * value[1];
      count += 1.0;
    }
    if (!view.stated_rad) continue;
    heading_error += std::pow(WrapPi(heading - *view.stated_rad), 2);
    ++stated;
  }
  HeldOut result{.pairs = std::sqrt(pairs / std::max(count, 1.0)),
                 .across = std::sqrt(across / std::max(count, 1.0))};
  if (stated > 0) result.heading_rad = std::sqrt(heading_error / stated);
  return result;
}

double Rms(const InstrumentCovariance& covariance, int first, int count) {
  return std::sqrt(covariance.diagonal().segment(first, count).mean());
}

PolarizationCameraCalibration Apply(const PolarizationCameraCalibration& given,
                                    const TurnErrors& errors,
                                    const InstrumentCovariance& covariance) {
  PolarizationCameraCalibration calibration = given;
  for (std::size_t k = 0; k < 4; ++k) {
    calibration.gain[k] *= 1.0 + errors.instrument[k];
    calibration.offset[k] += errors.instrument[4 + k];
    calibration.polarizer_rad[k] += errors.instrument[8 + k];
  }
  calibration.lens.center_px += Eigen::Vector2d(errors.view[4], errors.view[5]);
  const Eigen::Vector3d turn(errors.view[0], errors.view[1], errors.view[2]);
  const double angle = turn.norm();
  if (angle > 0.0) {
    calibration.T_BS.q = Eigen::AngleAxisd(angle, turn / angle) * given.T_BS.q;
  }
  calibration.covariance = covariance;
  calibration.gain_sigma = Rms(covariance, 0, 4);
  calibration.offset_sigma = Rms(covariance, 4, 4);
  calibration.polarizer_sigma_rad = Rms(covariance, 8, 4);
  calibration.mount_sigma_rad = Rms(covariance, 12, 3);
  calibration.focal_sigma = Rms(covariance, 15, 1);
  calibration.center_sigma_px = Rms(covariance, 16, 2);
  return calibration;
}

}  // namespace

TurnCalibration CalibrateFromTurn(const CompassOptions& options,
                                  const PolarizationCameraCalibration& given,
                                  const std::vector<TurnPicture>& pictures) {
  const TurnSolver solver(options, given);
  const std::vector<TurnView> views = Look(options, given, solver.reader(), pictures);
  if (views.size() < kFewestPictures) {
    throw std::invalid_argument("a turn needs six pictures with a heading; there are " +
                                std::to_string(views.size()));
  }
  std::vector<TurnView> fitted;
  std::vector<TurnView> held_out;
  for (std::size_t i = 0; i < views.size(); ++i) {
    (i % kHoldOutEvery == kHoldOutEvery - 1 ? held_out : fitted).push_back(views[i]);
  }
  TurnCalibration result{.pictures = static_cast<int>(views.size()),
                         .held_out = static_cast<int>(held_out.size())};
  result.before = Try(solver, held_out, TurnErrors{});
  result.after = Try(solver, held_out, solver.Solve(fitted, nullptr));
  InstrumentCovariance covariance;
  const TurnErrors errors = solver.Solve(views, &covariance);
  result.calibration = Apply(given, errors, covariance);
  return result;
}

}  // namespace polnav::nav
