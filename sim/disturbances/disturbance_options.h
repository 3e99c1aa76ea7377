// What goes wrong around the vehicle, and when?
//
// An entry of the scenario's `disturbances` is one of three:
//   something for a time    start_s and duration_s, or at random again and again (mean_interval_s)
//   somebody who passes     likewise: alongside at times spread evenly over the duration
//   a stretch of the road   from start_m over length_m, for the whole run
// Sensors that fail are faults, not disturbances: see sim/faults.
#pragma once

#include <optional>
#include <string>

namespace polnav::sim {

// Others on the road. Alongside means: at the same arc length of the road.
struct PassingOptions {
  std::string kind = "car";
  int count = 1;
  double offset_m = 3.0;   // to the left of the road's centre line, seen along the drive
  double speed_m_s = 9.0;  // along the drive; negative comes towards

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("kind", kind, {"car", "bus", "pedestrian"});
    v("count", count, {.min = 1, .max = 100});
    v("offset_m", offset_m, {.min = -60.0, .max = 60.0});
    v("speed_m_s", speed_m_s, {.min = -40.0, .max = 40.0});
  }
};

// Cameras get less light: dusk, lamps going out. The gain stays what it was.
struct DarknessOptions {
  double light_share = 0.03;  // that is left

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("light_share", light_share, {.min = 0.0, .max = 1.0});
  }
};

// The gain is wrong: as after a tunnel, before the automatic has found it.
struct OverexposureOptions {
  double gain = 6.0;  // over the right one

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("gain", gain, {.min = 1.0, .max = 100.0});
  }
};

// Low sun in the lens: a veil and ghosts.
struct GlareOptions {
  double strength = 1.0;  // 1: a dusty lens; of the veil that sunlight throws over the picture [-]

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("strength", strength, {.min = 0.0, .max = 10.0});
  }
};

struct FogOptions {
  double visibility_m = 40.0;  // where contrast falls to 2 % [Koschmieder1924]

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("visibility_m", visibility_m, {.min = 2.0, .max = 1e5});
  }
};

// Of the lens: under drops, or under dirt.
struct LensCoverOptions {
  double share = 0.2;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("share", share, {.min = 0.0, .max = 1.0});
  }
};

// The wind carries a cloud over the vehicle: half way through it stands overhead.
struct CloudPassageOptions {
  double optical_depth = 10.0;  // vertical

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("optical_depth", optical_depth, {.min = 0.0, .max = 200.0});
  }
};

// A part of the road.
struct StretchOptions {
  double start_m = 0.0;  // arc length along the centre line
  double length_m = 30.0;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("start_m", start_m, {.min = 0.0, .max = 5000.0});
    v("length_m", length_m, {.min = 1.0, .max = 5000.0});
  }
};

// Exactly one of the kinds. YAML keys = field names.
struct DisturbanceOptions {
  double start_s = 0.0;
  double duration_s = 10.0;
  // Given: again and again from start_s on, with gaps drawn from an exponential distribution.
  std::optional<double> mean_interval_s;

  std::optional<PassingOptions> passing;
  std::optional<DarknessOptions> darkness;
  std::optional<OverexposureOptions> overexposure;
  std::optional<GlareOptions> glare;
  std::optional<FogOptions> fog;
  std::optional<LensCoverOptions> rain;
  std::optional<LensCoverOptions> dirt;
  std::optional<CloudPassageOptions> cloud_passage;
  std::optional<StretchOptions> low_features;
  std::optional<StretchOptions> canopy;
  std::optional<StretchOptions> tunnel;
  std::optional<StretchOptions> bridge;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("start_s", start_s, {.min = 0.0, .max = 86400.0});
    v("duration_s", duration_s, {.min = 0.01, .max = 86400.0});
    v("mean_interval_s", mean_interval_s, {.min = 0.1, .max = 86400.0});
    v("passing", passing);
    v("darkness", darkness);
    v("overexposure", overexposure);
    v("glare", glare);
    v("fog", fog);
    v("rain", rain);
    v("dirt", dirt);
    v("cloud_passage", cloud_passage);
    v("low_features", low_features);
    v("canopy", canopy);
    v("tunnel", tunnel);
    v("bridge", bridge);
  }
};

}  // namespace polnav::sim
