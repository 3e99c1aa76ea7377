#include "sim/sensors/polarimeter.h"

#include "sim/sensors/rotation.h"

namespace polnav::sim {

nav::PolarimeterCalibration NominalPolarimeter(const PolarimeterOptions& options) {
  return {.T_BS = {Eigen::Quaterniond::Identity(), options.position_m},
          .fov_rad = nav::DegToRad(options.fov_deg)};
}

Polarimeter::Polarimeter(const PolarimeterOptions& options, const sky::WorldSky& sky,
                         std::uint64_t seed, std::uint64_t trial, const Occlusion* occlusion)
    : options_(options), sky_(&sky), occlusion_(occlusion), noise_(seed, trial, "polarimeter") {
  RandomStream::Sample draw = RandomStream(seed, trial, "polarimeter/instrument").At(0);
  optics_.fov_rad = nav::DegToRad(options.fov_deg);
  optics_.exposure = options.exposure;
  for (std::size_t i = 0; i < optics_.gain.size(); ++i) {
    optics_.gain[i] = 1.0 + options.gain_sigma * draw.Gaussian();
    optics_.angle_error_rad[i] = nav::DegToRad(options.polarizer_angle_sigma_deg) * draw.Gaussian();
  }
  q_BS_ = RotationOf(nav::DegToRad(options.mount_error_sigma_deg) * GaussianVector(draw));
}

nav::PolarizationSample Polarimeter::Sample(const Truth& truth, std::uint64_t index,
                                            const sky::FogAbove& fog) const {
  const Eigen::Quaterniond q_WS = truth.T_WB.q * q_BS_;
  const Eigen::Vector3d p_WS_m = truth.T_WB * options_.position_m;
  Occlusion::View view;
  if (occlusion_ != nullptr) {
    view = occlusion_->From(p_WS_m, q_WS * Eigen::Vector3d::UnitZ(), 0.5 * optics_.fov_rad,
                            truth.stamp);
  }
  sky::Cover cover;
  if (!view.empty()) {
    cover = [&view](const Eigen::Vector3d& ray_W) -> std::optional<double> {
      const auto hit = view.Look(ray_W);
      return hit ? std::optional(hit->radiance) : std::nullopt;
    };
  }
  const sky::SixChannels reading =
      sky::ReadSixChannels(optics_, q_WS, p_WS_m, nav::ToSeconds(truth.stamp), *sky_, cover, fog);
  RandomStream::Sample draw = noise_.At(index);
  sky::SixChannels normals{};
  for (double& normal : normals) {
    normal = draw.Gaussian();
  }
  return {truth.stamp, sky::Digitize(reading, normals, options_.channel_sigma, options_.bits)};
}

}  // namespace polnav::sim
