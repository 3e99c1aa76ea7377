#include "sim/vehicle/car.h"

#include <stdexcept>

#include "sim/vehicle/central_truth.h"

namespace polnav::sim {
namespace {

constexpr int kSettleSteps = 2000;
constexpr int kMostSettleSteps = 50000;
constexpr double kSettled_m_s = 1e-7;

}  // namespace

Car::Car(const CarOptions& options, const Track& track, const Terrain& terrain, std::uint64_t seed)
    : options_(options),
      chassis_(options, terrain, track.At(0.0).p_m, 0.0),
      driver_(options, track, seed),
      start_(nav::FromSeconds(options.start_delay_s)) {
  Settle();
  poses_.fill(chassis_.T_WB());
  RunPhysics();
  truth_ = CentralTruth(truth_.stamp, poses_, Chassis::kStep_s);
}

// The springs ring down and the tyres take up the slope, with the brake on.
void Car::Settle() {
  int steps = 0;
  while (steps < kSettleSteps || chassis_.v_WB_m_s().norm() > kSettled_m_s) {
    chassis_.Step(driver_.Hold());
    if (++steps > kMostSettleSteps) {
      throw std::runtime_error("car: does not come to rest at the start: too steep for its tyres");
    }
  }
}

void Car::RunPhysics() {
  poses_ = {poses_[1], poses_[2], {}};
  const bool driving = truth_.stamp >= start_;
  chassis_.Step(driving ? driver_.Drive(poses_[1], chassis_.v_WB_m_s()) : driver_.Hold());
  poses_[2] = chassis_.T_WB();
}

void Car::Step() {
  truth_.stamp += kStep;
  RunPhysics();
  truth_ = CentralTruth(truth_.stamp, poses_, Chassis::kStep_s);
}

}  // namespace polnav::sim
