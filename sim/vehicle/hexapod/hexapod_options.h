// What hexapod is it, how does it walk, and where?
//
// Defaults: a walker of the size and weight of the kits with 18 MG996R servos [TowerProMG996R].
// docs/hexapod.md has the sizes and masses with their reasons. YAML keys = field names.
#pragma once

#include <Eigen/Core>
#include <string>

namespace polnav::sim {

// A position servo: a DC motor behind gears, driven in proportion to the angle that is missing.
struct ServoOptions {
  double stall_torque_n_m = 0.92;      // at 4.8 V
  double no_load_speed_deg_s = 353.0;  // at 4.8 V: 0.17 s for 60 degrees
  double full_torque_error_deg = 6.0;  // larger: softer legs, more sag and sway
  double dead_band_deg = 0.45;         // 5 us of pulse
  double gear_friction_n_m = 0.03;
  double rotor_inertia_kg_m2 = 5e-4;  // behind the gears, as the joint feels it
  double command_rate_hz = 50.0;      // pulses; the angle asked for stays between two of them

  bool operator==(const ServoOptions&) const = default;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("stall_torque_n_m", stall_torque_n_m, {.min = 0.01, .max = 100.0});
    v("no_load_speed_deg_s", no_load_speed_deg_s, {.min = 1.0, .max = 5000.0});
    v("full_torque_error_deg", full_torque_error_deg, {.min = 1.0, .max = 45.0});
    v("dead_band_deg", dead_band_deg, {.min = 0.0, .max = 5.0});
    v("gear_friction_n_m", gear_friction_n_m, {.min = 0.0, .max = 0.3});
    v("rotor_inertia_kg_m2", rotor_inertia_kg_m2, {.min = 2e-4, .max = 0.01});
    v("command_rate_hz", command_rate_hz, {.min = 10.0, .max = 500.0});
  }
};

// Three links a leg: coxa (turns about the vertical), femur and tibia (both up and down).
struct LegOptions {
  double coxa_m = 0.045;  // joint to joint
  double femur_m = 0.075;
  double tibia_m = 0.115;  // to the foot's centre
  double coxa_kg = 0.075;  // each with the servo that moves the next link
  double femur_kg = 0.075;
  double tibia_kg = 0.030;
  double foot_radius_m = 0.008;
  double foot_stiffness_n_m = 6000.0;  // rubber
  double foot_damping_n_s_m = 40.0;
  double foot_friction = 0.8;     // peak force over load [-]
  double joint_range_deg = 90.0;  // to both sides of the middle; the tibia's middle is 90 down

  bool operator==(const LegOptions&) const = default;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("coxa_m", coxa_m, {.min = 0.01, .max = 0.5});
    v("femur_m", femur_m, {.min = 0.02, .max = 1.0});
    v("tibia_m", tibia_m, {.min = 0.02, .max = 1.0});
    v("coxa_kg", coxa_kg, {.min = 0.01, .max = 10.0});
    v("femur_kg", femur_kg, {.min = 0.01, .max = 10.0});
    v("tibia_kg", tibia_kg, {.min = 0.01, .max = 10.0});
    v("foot_radius_m", foot_radius_m, {.min = 0.002, .max = 0.1});
    v("foot_stiffness_n_m", foot_stiffness_n_m, {.min = 100.0, .max = 1e6});
    v("foot_damping_n_s_m", foot_damping_n_s_m, {.min = 1.0, .max = 1e4});
    v("foot_friction", foot_friction, {.min = 0.0, .max = 3.0});
    v("joint_range_deg", joint_range_deg, {.min = 5.0, .max = 170.0});
  }
};

// Tripod gait: three feet on the ground, three in the air, in turns.
struct GaitOptions {
  double cycle_s = 0.8;          // both tripods once: two steps
  double swing_share = 0.45;     // of the cycle that a foot is in the air; below one half: all six
                                 // stand for a moment between two steps
  double lift_m = 0.025;         // how high a foot is raised
  double body_height_m = 0.085;  // of the coxa's plane above the feet
  double reach_m = 0.135;        // from a leg's root to its foot at rest, seen from above

  bool operator==(const GaitOptions&) const = default;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("cycle_s", cycle_s, {.min = 0.2, .max = 10.0});
    v("swing_share", swing_share, {.min = 0.1, .max = 0.5});
    v("lift_m", lift_m, {.min = 0.002, .max = 0.3});
    v("body_height_m", body_height_m, {.min = 0.01, .max = 1.0});
    v("reach_m", reach_m, {.min = 0.02, .max = 1.0});
  }
};

// Where it goes. stand: nowhere. straight: length_m ahead. square: to the left, sides of length_m,
// turning on the spot at the corners, back to the start. wander: speed and turn rate change all the
// time at random, within radius_m of the start.
struct WalkOptions {
  std::string path = "wander";
  double length_m = 2.4;
  double radius_m = 3.0;
  double speed_m_s = 0.12;
  double turn_rate_deg_s = 25.0;
  double start_delay_s = 2.0;  // stands still, so that sensors can be levelled

  bool operator==(const WalkOptions&) const = default;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("path", path, {"stand", "straight", "square", "wander"});
    v("length_m", length_m, {.min = 0.1, .max = 1000.0});
    v("radius_m", radius_m, {.min = 0.5, .max = 100.0});
    v("speed_m_s", speed_m_s, {.min = 0.01, .max = 2.0});
    v("turn_rate_deg_s", turn_rate_deg_s, {.min = 1.0, .max = 180.0});
    v("start_delay_s", start_delay_s, {.min = 0.0, .max = 600.0});
  }
};

struct HexapodOptions {
  double body_kg = 1.03;  // with the battery, the electronics and the coxas' six servos
  Eigen::Vector3d body_size_m = {0.26, 0.16, 0.05};
  double start_east_m = 0.0;  // in W
  double start_north_m = 0.0;
  double start_heading_deg = 0.0;
  LegOptions leg;
  ServoOptions servo;
  GaitOptions gait;
  WalkOptions walk;

  bool operator==(const HexapodOptions&) const = default;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("body_kg", body_kg, {.min = 0.1, .max = 100.0});
    v("body_size_m", body_size_m, {.min = 0.02, .max = 3.0});
    v("start_east_m", start_east_m, {.min = -1e4, .max = 1e4});
    v("start_north_m", start_north_m, {.min = -1e4, .max = 1e4});
    v("start_heading_deg", start_heading_deg, {.min = -360.0, .max = 360.0});
    v("leg", leg);
    v("servo", servo);
    v("gait", gait);
    v("walk", walk);
  }
};

}  // namespace polnav::sim
