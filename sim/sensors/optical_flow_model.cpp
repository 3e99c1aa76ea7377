#include "sim/sensors/optical_flow_model.h"

#include <algorithm>
#include <cmath>

namespace polnav::sim {
namespace {

// The fit's reference: ground that a pixel covers, and contrast.
constexpr double kPixel_m = 0.6e-3;
constexpr double kContrast = 0.1;

Eigen::Vector2d GaussianPair(RandomStream::Sample& draw) {
  const double x = draw.Gaussian();
  return {x, draw.Gaussian()};
}

Eigen::Vector2d Project(const FlowFrame& point_of, const FlowFrame& into, double focal_px) {
  const Eigen::Vector3d axis = point_of.T_WF.q * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d p_W = point_of.T_WF.p + *point_of.distance_m * axis;
  const Eigen::Vector3d p_F = into.T_WF.q.conjugate() * (p_W - into.T_WF.p);
  return focal_px * p_F.head<2>() / p_F.z();
}

}  // namespace

double TypicalFlowNoise(const OpticalFlowOptions& options) {
  return options.model.moving_sigma_px / options.focal_px * std::sqrt(options.internal_rate_hz);
}

// Forwards and backwards, so that it is exact to the second order of the motion.
std::optional<Eigen::Vector2d> TrueShift(const FlowFrame& before, const FlowFrame& after,
                                         double focal_px) {
  if (!before.distance_m || !after.distance_m) return std::nullopt;
  return 0.5 * (Project(before, after, focal_px) - Project(after, before, focal_px));
}

OpticalFlowModel::OpticalFlowModel(const OpticalFlowOptions& options, double grain_contrast,
                                   std::uint64_t seed, std::uint64_t trial)
    : options_(options),
      grain_contrast_(grain_contrast),
      focal_px_(DrawTrueFlowCamera(options, seed, trial).focal_px),
      blocks_(36),
      noise_(seed, trial, "optical_flow/model") {}

PictureShift OpticalFlowModel::Match(const FlowFrame& before, const FlowFrame& after,
                                     std::uint64_t frame) {
  PictureShift match{.blocks = blocks_};
  const auto shift = TrueShift(before, after, focal_px_);
  if (!shift) return match;
  match.shift_px = *shift;
  match.matched = match.blocks;
  return match;
}

nav::OpticalFlowSample OpticalFlowModel::Take(const FlowInterval& interval) {
  std::vector<PictureShift> shifts;
  const std::uint64_t first = interval.index * (interval.frames.size() - 1) + 1;
  for (std::size_t i = 0; i + 1 < interval.frames.size(); ++i) {
    shifts.push_back(Match(interval.frames[i], interval.frames[i + 1], first + i));
  }
  return Integrate(interval, shifts, options_.focal_px);
}

}  // namespace polnav::sim
