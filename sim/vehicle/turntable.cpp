#include "sim/vehicle/turntable.h"

#include <cmath>
#include <numbers>

#include "sim/random.h"
#include "sim/sensors/rotation.h"

namespace polnav::sim {

Turntable::Turntable(const TurntableOptions& options, const Terrain& terrain, std::uint64_t seed)
    : options_(options), step_s_(2.0 * std::abs(options.step_deg) / options.peak_rate_deg_s) {
  RandomStream::Sample draw = RandomStream(seed, 0, "tilt").At(0);
  const double sigma = nav::DegToRad(options.tilt_sigma_deg);
  const double east = sigma * draw.Gaussian();
  const double north = sigma * draw.Gaussian();
  q_tilt_ = RotationOf({east, north, 0.0});
  truth_.T_WB.p = options.position_m;
  truth_.T_WB.p.z() += terrain.Height(options.position_m.x(), options.position_m.y());
  UpdateTruth();
}

void Turntable::Step(nav::TimeNs step) {
  truth_.stamp += step;
  UpdateTruth();
}

void Turntable::UpdateTruth() {
  const double cycle_s = options_.dwell_s + step_s_;
  const double t_s = nav::ToSeconds(truth_.stamp);
  const double done = cycle_s > 0.0 ? std::floor(t_s / cycle_s) : 0.0;
  const double turning_s = t_s - done * cycle_s - options_.dwell_s;
  double share = 0.0;
  double share_rate_1_s = 0.0;
  if (turning_s > 0.0 && step_s_ > 0.0) {
    const double phase = 2.0 * std::numbers::pi * turning_s / step_s_;
    share = turning_s / step_s_ - std::sin(phase) / (2.0 * std::numbers::pi);
    share_rate_1_s = (1.0 - std::cos(phase)) / step_s_;
  }
  const double heading_deg = options_.start_heading_deg + (done + share) * options_.step_deg;
  truth_.T_WB.q = q_tilt_ * nav::LevelAttitude(nav::DegToRad(heading_deg));
  // Compass headings grow clockwise, z turns counterclockwise.
  truth_.w_WB_B_rad_s.z() = -nav::DegToRad(options_.step_deg) * share_rate_1_s;
}

}  // namespace polnav::sim
