#include "sim/sensors/optical_flow.h"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "sim/sensors/optical_flow_model.h"
#include "sim/sensors/rotation.h"

namespace polnav::sim {
namespace {

nav::Pose NominalMount(const OpticalFlowOptions& options) {
  return {Eigen::Quaterniond(0.0, 1.0, 0.0, 0.0), options.position_m};  // half a turn about x
}

}  // namespace

nav::OpticalFlowCalibration NominalOpticalFlow(const OpticalFlowOptions& options) {
  return {.T_BF = NominalMount(options),
          .rate_hz = options.rate_hz,
          .flow_noise_rad_s_sqrt_hz = TypicalFlowNoise(options),
          .flow_scale_sigma = options.focal_sigma,
          .mount_sigma_rad = nav::DegToRad(options.mount_error_sigma_deg),
          .range_sigma_m = options.range_sigma_m,
          .range_min_m = options.range_min_m,
          .range_max_m = options.range_max_m};
}

TrueFlowCamera DrawTrueFlowCamera(const OpticalFlowOptions& options, std::uint64_t seed,
                                  std::uint64_t trial) {
  RandomStream::Sample draw = RandomStream(seed, trial, "optical_flow/camera").At(0);
  TrueFlowCamera camera{NominalMount(options), options.focal_px};
  camera.focal_px *= 1.0 + options.focal_sigma * draw.Gaussian();
  const Eigen::Vector3d turn = nav::DegToRad(options.mount_error_sigma_deg) * GaussianVector(draw);
  camera.T_BF.q = RotationOf(turn) * camera.T_BF.q;
  return camera;
}

OpticalFlow::OpticalFlow(const OpticalFlowOptions& options, const Terrain& terrain,
                         const Occlusion* occlusion, std::uint64_t seed, std::uint64_t trial)
    : options_(options),
      terrain_(terrain),
      occlusion_(occlusion),
      camera_(DrawTrueFlowCamera(options, seed, trial)),
      range_(options, seed, trial),
      frames_per_reading_(
          static_cast<std::size_t>(std::lround(options.internal_rate_hz / options.rate_hz))),
      gyro_noise_(seed, trial, "optical_flow/gyro") {
  if (frames_per_reading_ < 1) throw std::logic_error("OpticalFlow: fewer frames than readings");
  RandomStream::Sample draw = RandomStream(seed, trial, "optical_flow/gyroscopes").At(0);
  gyro_bias_rad_s_ = nav::DegToRad(options.gyro_bias_sigma_deg_s) * GaussianVector(draw);
  gyro_scale_ = Eigen::Vector3d::Ones() + options.gyro_scale_sigma * GaussianVector(draw);
}

Eigen::Vector3d OpticalFlow::ReadGyro(const Eigen::Quaterniond& q_WF, double dt_s) {
  const Eigen::Vector3d turn = RotationVector(interval_.frames.back().T_WF.q.conjugate() * q_WF);
  RandomStream::Sample draw = gyro_noise_.At(frame_);
  const double noise_rad = nav::DegToRad(options_.gyro_noise_deg_s_sqrt_hz) * std::sqrt(dt_s);
  return gyro_scale_.cwiseProduct(turn) + dt_s * gyro_bias_rad_s_ +
         noise_rad * GaussianVector(draw);
}

// The ground is a plane as far as the sensor gets in an interval.
void OpticalFlow::Measure(FlowInterval& interval) const {
  FlowFrame& last = interval.frames.back();
  const GroundPlane ground = GroundAlong(terrain_, last.T_WF);
  for (FlowFrame& frame : interval.frames) frame.distance_m = ground.Distance(frame.T_WF);
  std::optional<double> heard_m = last.distance_m;
  if (occlusion_ != nullptr) {
    const ThingsAhead things =
        LookForThings(*occlusion_, last.T_WF, last.stamp, nav::DegToRad(options_.range_beam_deg));
    const auto nearer = [](const std::optional<double>& thing, std::optional<double>& than) {
      if (thing && (!than || *thing < *than)) than = thing;
    };
    for (FlowFrame& frame : interval.frames) nearer(things.on_axis_m, frame.distance_m);
    nearer(things.in_beam_m, heard_m);
  }
  interval.range_m = range_.Read(heard_m, interval.index);
}

std::optional<FlowInterval> OpticalFlow::Look(const Truth& truth) {
  FlowFrame frame{.stamp = truth.stamp, .T_WF = truth.T_WB * camera_.T_BF};
  if (!interval_.frames.empty()) {
    const double dt_s = nav::ToSeconds(frame.stamp - interval_.frames.back().stamp);
    frame.gyro_rad = ReadGyro(frame.T_WF.q, dt_s);
  }
  ++frame_;
  interval_.frames.push_back(frame);
  if (interval_.frames.size() <= frames_per_reading_) return std::nullopt;
  FlowInterval done = std::move(interval_);
  interval_ = {.index = done.index + 1, .frames = {done.frames.back()}};
  interval_.frames.reserve(frames_per_reading_ + 1);
  Measure(done);
  return done;
}

}  // namespace polnav::sim
