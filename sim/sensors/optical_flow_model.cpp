#include "sim/sensors/optical_flow_model.h"

#include <algorithm>
#include <cmath>

namespace polnav::sim {
namespace {

// The fit of docs/optical_flow.md: its reference, and how noise depends on the ground that a pixel
// covers and on what the world's own textures add to the grain, as a contrast over the reference.
constexpr double kPixel_m = 0.6e-3;
constexpr double kContrast = 0.1;
constexpr double kPixelPower = -0.6;
constexpr double kTexture = 0.1;
constexpr double kTexturePower = 2.0;
constexpr double kTextureMost = 0.6;
constexpr double kMoving = 0.75;      // of the noise, is left between pixels
constexpr double kMatchWidth = 0.35;  // of the logarithm of noise, over which blocks are lost
constexpr int kBlocks = 25;
constexpr double kFarthest_px = kBlockSearch_px + 0.5;

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

// Of a picture that moves: a displacement's two pictures err by themselves.
double TypicalFlowNoise(const OpticalFlowOptions& options) {
  return kMoving * std::sqrt(2.0 * options.internal_rate_hz) * options.model.noise_sigma_px /
         options.focal_px;
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
      noise_(seed, trial, "optical_flow/model") {}

void OpticalFlowModel::ComeTo(double distance_m) {
  const double pixel = distance_m / focal_px_ / kPixel_m;
  const double texture = std::min(kTextureMost, kTexture * std::pow(pixel, kTexturePower));
  const double contrast = std::hypot(grain_contrast_ / kContrast, texture);
  // The scenario's own noise stays within what pictures could show.
  sigma_px_ = std::min(
      1.0, options_.model.noise_sigma_px * std::pow(pixel, kPixelPower) / std::max(1e-6, contrast));
  const double weaker = std::log(std::max(1e-9, sigma_px_) / options_.model.half_matched_px);
  share_ = 0.5 * std::erfc(weaker / kMatchWidth / std::sqrt(2.0));
}

PictureShift OpticalFlowModel::Match(const FlowFrame& before, const FlowFrame& after,
                                     std::uint64_t frame) {
  RandomStream::Sample draw = noise_.At(frame);
  const Eigen::Vector2d a = GaussianPair(draw);
  const Eigen::Vector2d b = GaussianPair(draw);
  const double luck = draw.Gaussian();
  PictureShift match{.blocks = kBlocks};
  const auto shift = TrueShift(before, after, focal_px_);
  if (shift) {
    const double way = shift->norm() / options_.model.texture_length_px;
    const double alike = std::exp(-way * way);
    const double rest = std::sqrt(1.0 - alike * alike);
    const double sigma_px = sigma_px_ * (kMoving + (1.0 - kMoving) * alike);
    match.shift_px = *shift + sigma_px * (a - alike * after_ - rest * b);
    luck_ = alike * luck_ + rest * luck;
    const double share = share_ + luck_ * std::sqrt(share_ * (1.0 - share_) / kBlocks);
    const bool found = shift->cwiseAbs().maxCoeff() < kFarthest_px;
    match.matched =
        found ? static_cast<int>(std::lround(kBlocks * std::clamp(share, 0.0, 1.0))) : 0;
  }
  after_ = a;
  return match;
}

nav::OpticalFlowSample OpticalFlowModel::Take(const FlowInterval& interval) {
  std::vector<PictureShift> shifts;
  if (interval.frames.back().distance_m) ComeTo(*interval.frames.back().distance_m);
  const std::uint64_t first = interval.index * (interval.frames.size() - 1) + 1;
  for (std::size_t i = 0; i + 1 < interval.frames.size(); ++i) {
    shifts.push_back(Match(interval.frames[i], interval.frames[i + 1], first + i));
  }
  return Integrate(interval, shifts, options_.focal_px);
}

}  // namespace polnav::sim
