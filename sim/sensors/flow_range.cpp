#include "sim/sensors/flow_range.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace polnav::sim {
namespace {

constexpr double kSteepest = 0.1;  // sine of the smallest angle between axis and ground

Eigen::Vector3d AxisOf(const nav::Pose& T_WF) { return T_WF.q * Eigen::Vector3d::UnitZ(); }

GroundPlane PlaneAt(const Terrain& terrain, double x_m, double y_m) {
  const Terrain::Surface s = terrain.At(x_m, y_m);
  return {{x_m, y_m, s.height_m},
          Eigen::Vector3d(-s.gradient.x(), -s.gradient.y(), 1.0).normalized()};
}

std::optional<double> Nearer(std::optional<double> a, std::optional<double> b) {
  if (!a || !b) return a ? a : b;
  return std::min(*a, *b);
}

}  // namespace

std::optional<double> GroundPlane::Distance(const nav::Pose& T_WF) const {
  const double towards = -normal_W.dot(AxisOf(T_WF));
  if (towards < kSteepest) return std::nullopt;
  return std::max(0.0, normal_W.dot(T_WF.p - p_W_m) / towards);
}

// The plane under the sensor says where the axis meets the ground; where that is far aside, the
// plane is taken there.
GroundPlane GroundAlong(const Terrain& terrain, const nav::Pose& T_WF) {
  constexpr double kAside_m = 0.05;  // with bumps of 7 mm a plane is good to 0.1 mm so far
  GroundPlane plane = PlaneAt(terrain, T_WF.p.x(), T_WF.p.y());
  for (int i = 0; i < 4; ++i) {
    const std::optional<double> distance_m = plane.Distance(T_WF);
    if (!distance_m) break;
    const Eigen::Vector3d there = T_WF.p + *distance_m * AxisOf(T_WF);
    if ((there - plane.p_W_m).head<2>().norm() < kAside_m) break;
    plane = PlaneAt(terrain, there.x(), there.y());
  }
  return plane;
}

ThingsAhead LookForThings(const Occlusion& occlusion, const nav::Pose& T_WF, nav::TimeNs stamp,
                          double beam_rad) {
  const auto view = occlusion.From(T_WF.p, AxisOf(T_WF), 0.5 * beam_rad, stamp);
  const auto look = [&](double x, double y) -> std::optional<double> {
    const auto hit = view.Look(T_WF.q * Eigen::Vector3d(x, y, 1.0).normalized());
    if (!hit || hit->label == Label::kGround) return std::nullopt;
    return hit->distance_m;
  };
  if (view.empty()) return {};
  const double aside = std::tan(0.5 * beam_rad);
  ThingsAhead ahead{.on_axis_m = look(0.0, 0.0)};
  ahead.in_beam_m = ahead.on_axis_m;
  for (const auto& [x, y] :
       std::array<std::array<double, 2>, 4>{{{1, 0}, {-1, 0}, {0, 1}, {0, -1}}}) {
    ahead.in_beam_m = Nearer(ahead.in_beam_m, look(aside * x, aside * y));
  }
  return ahead;
}

RangeFinder::RangeFinder(const OpticalFlowOptions& options, std::uint64_t seed, std::uint64_t trial)
    : options_(options), noise_(seed, trial, "optical_flow/range") {
  RandomStream::Sample draw = RandomStream(seed, trial, "optical_flow/range_finder").At(0);
  bias_m_ = options.range_bias_sigma_m * draw.Gaussian();
  scale_ = 1.0 + options.range_scale_sigma * draw.Gaussian();
}

std::optional<double> RangeFinder::Read(std::optional<double> distance_m,
                                        std::uint64_t index) const {
  if (!distance_m) return std::nullopt;
  RandomStream::Sample draw = noise_.At(index);
  const bool echo = draw.Uniform() >= options_.range_dropout_probability;
  const double range_m = scale_ * *distance_m + bias_m_ + options_.range_sigma_m * draw.Gaussian();
  if (!echo || range_m < options_.range_min_m || range_m > options_.range_max_m) {
    return std::nullopt;
  }
  return range_m;
}

}  // namespace polnav::sim
