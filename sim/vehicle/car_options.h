// What car is it, and how is it driven?
#pragma once

namespace polnav::sim {

// YAML keys = field names. The defaults are a compact car at a walking-pace survey.
struct CarOptions {
  double speed_m_s = 6.0;
  double mass_kg = 1200.0;
  double wheelbase_m = 2.6;              // front axle to rear axle; the centre of mass is half way
  double track_width_m = 1.5;            // left wheel to right wheel
  double cg_height_m = 0.55;             // above the ground, at rest
  double suspension_frequency_hz = 1.5;  // heave; lower is softer: more pitch and roll
  double suspension_damping_ratio = 0.35;  // higher settles faster and passes more of the bumps
  double max_steer_deg = 35.0;             // of the wheels
  double friction = 0.9;                   // of the tyres, peak force over load [-]
  int laps = 5;
  double start_delay_s = 2.0;     // stands still, so that sensors can be levelled
  double lateral_wander_m = 0.3;  // bound of the smooth weaving about the road's centre line

  bool operator==(const CarOptions&) const = default;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("speed_m_s", speed_m_s, {.min = 0.5, .max = 20.0});
    v("mass_kg", mass_kg, {.min = 200.0, .max = 5000.0});
    v("wheelbase_m", wheelbase_m, {.min = 1.0, .max = 6.0});
    v("track_width_m", track_width_m, {.min = 0.8, .max = 2.5});
    v("cg_height_m", cg_height_m, {.min = 0.2, .max = 1.5});
    v("suspension_frequency_hz", suspension_frequency_hz, {.min = 0.8, .max = 5.0});
    v("suspension_damping_ratio", suspension_damping_ratio, {.min = 0.05, .max = 2.0});
    v("max_steer_deg", max_steer_deg, {.min = 5.0, .max = 60.0});
    v("friction", friction, {.min = 0.1, .max = 2.0});
    v("laps", laps, {.min = 1, .max = 1000});
    v("start_delay_s", start_delay_s, {.min = 0.0, .max = 600.0});
    v("lateral_wander_m", lateral_wander_m, {.min = 0.0, .max = 2.0});
  }
};

}  // namespace polnav::sim
