#include "sim/vehicle/hexapod/hexapod.h"

#include <algorithm>
#include <stdexcept>

#include "sim/vehicle/central_truth.h"

namespace polnav::sim {
namespace {

constexpr int kSettleSteps = 1500;
constexpr int kMostSettleSteps = 20000;
constexpr double kSettled_m_s = 1e-6;
constexpr int kBodySteps = static_cast<int>(Hexapod::kStep / HexapodBody::kStep);

JointAngles AnglesOf(const LegOptions& leg, const std::array<nav::Pose, kLegs>& roots,
                     const Feet& feet_B_m) {
  JointAngles angles;
  for (int i = 0; i < kLegs; ++i) {
    const auto found = AnglesFor(leg, roots[i].Inverse() * feet_B_m[i]);
    if (!found) throw std::logic_error("Hexapod: the gait is out of the legs' reach");
    angles[i] = *found;
  }
  return angles;
}

}  // namespace

Hexapod::Hexapod(const HexapodOptions& options, const Terrain& terrain, std::uint64_t seed)
    : options_(options),
      roots_(LegRoots(options)),
      gait_(options),
      path_(options, seed),
      wanted_(AnglesOf(options.leg, roots_, gait_.feet_B_m())),
      body_(options, terrain, wanted_),
      pulse_every_(nav::FromSeconds(1.0 / options.servo.command_rate_hz)) {
  if (!IsWithinReach(options, options.walk.speed_m_s,
                     nav::DegToRad(options.walk.turn_rate_deg_s))) {
    throw std::logic_error("Hexapod: the gait is out of the legs' reach");
  }
  Settle();
  poses_.fill(body_.T_WB());
  RunPhysics();
  truth_ = CentralTruth(truth_.stamp, poses_, nav::ToSeconds(kStep));
}

// The servos take up the weight.
void Hexapod::Settle() {
  int steps = 0;
  while (steps < kSettleSteps || body_.v_WB_m_s().norm() > kSettled_m_s) {
    body_.Step(wanted_);
    if (++steps > kMostSettleSteps) {
      throw std::runtime_error(
          "hexapod: does not come to rest at the start: too heavy for its servos, or too steep");
    }
  }
}

void Hexapod::CommandServos() {
  if (truth_.stamp < next_pulse_) return;
  next_pulse_ += pulse_every_;
  wanted_ = AnglesOf(options_.leg, roots_, gait_.feet_B_m());
}

void Hexapod::RunPhysics() {
  poses_ = {poses_[1], poses_[2], {}};
  const double dt_s = nav::ToSeconds(kStep);
  gait_.Step(path_.Command(nav::ToSeconds(truth_.stamp), poses_[1], dt_s), dt_s);
  CommandServos();
  for (int i = 0; i < kBodySteps; ++i) body_.Step(wanted_, push_W_n_);
  poses_[2] = body_.T_WB();
}

void Hexapod::Step() {
  truth_.stamp += kStep;
  RunPhysics();
  truth_ = CentralTruth(truth_.stamp, poses_, nav::ToSeconds(kStep));
}

}  // namespace polnav::sim
