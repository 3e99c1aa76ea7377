// Which sensor fails, when, and in which way?
//
// An entry names a stream (as in result.json), when its fault begins, how long it lasts, and
// exactly one kind. What time a measurement belongs to is its own stamp before any fault. YAML keys
// = field names; docs/faults.md explains each with examples.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

namespace polnav::sim {

// How far readings are moved; only what the sensor has may be given (see AmountFits).
struct Amounts {
  Eigen::Vector3d gyro_deg_s = Eigen::Vector3d::Zero();  // imu, flow
  Eigen::Vector3d accel_mg = Eigen::Vector3d::Zero();    // imu
  double level = 0.0;  // stereo, polarimeter, polarization_camera: over full scale [-]
  Eigen::Vector3d feature_px = Eigen::Vector3d::Zero();  // stereo_features: u left, v left, u right
  double flow_x_deg_s = 0.0;                             // flow
  double flow_y_deg_s = 0.0;
  double range_m = 0.0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();  // reference, in W
  Eigen::Vector3d velocity_m_s = Eigen::Vector3d::Zero();
  double heading_deg = 0.0;   // clockwise from north
  int channel = -1;           // polarimeter, polarization_camera: counted from 0; -1 is all
  std::string side = "both";  // stereo

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("gyro_deg_s", gyro_deg_s, {.min = -1e4, .max = 1e4});
    v("accel_mg", accel_mg, {.min = -1e6, .max = 1e6});
    v("level", level, {.min = -1.0, .max = 1.0});
    v("feature_px", feature_px, {.min = -1e4, .max = 1e4});
    v("flow_x_deg_s", flow_x_deg_s, {.min = -1e4, .max = 1e4});
    v("flow_y_deg_s", flow_y_deg_s, {.min = -1e4, .max = 1e4});
    v("range_m", range_m, {.min = -1e4, .max = 1e4});
    v("position_m", position_m, {.min = -1e6, .max = 1e6});
    v("velocity_m_s", velocity_m_s, {.min = -1e4, .max = 1e4});
    v("heading_deg", heading_deg, {.min = -180.0, .max = 180.0});
    v("channel", channel, {.min = -1, .max = 5});
    v("side", side, {"both", "left", "right"});
  }
};

// The last reading from before the fault comes again and again, with new stamps.
struct StuckFault {
  template <typename Visitor>
  void Visit(Visitor&) {}
};

// A constant error.
using BiasFault = Amounts;

// An error that grows from zero in proportion to time and is `Amounts` after over_s.
struct DriftFault : Amounts {
  double over_s = 1.0;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("over_s", over_s, {.min = 1e-3, .max = 86400.0});
    Amounts::Visit(v);
  }
};

// White Gaussian noise on top of the sensor's own. Either times (imu and polarization_camera, whose
// noise the rig states): the sum of both is so many times the stated; or one sigma as `Amounts`.
struct NoiseFault : Amounts {
  std::optional<double> times;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("times", times, {.min = 1.0, .max = 1e4});
    Amounts::Visit(v);
  }
};

// A channel, or a pixel of each 2x2 cell, reads the same whatever the light.
struct DeadChannelFault {
  int channel = 0;     // polarimeter 0 to 5, polarization_camera 0 to 3
  double level = 0.0;  // over full scale [-]

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("channel", channel, {.min = 0, .max = 5});
    v("level", level, {.min = 0.0, .max = 1.0});
  }
};

// What a bad cable, driver or codec leaves of a picture.
//   garbage_rows  a band of rows, at a random height, is random bytes
//   lost_blocks   blocks of 16 x 16 px are mid-grey
//   bit_flips     one random bit of a byte is the other way round
//   black         all zero
//   missing       no picture at all (stereo)
struct CorruptFault {
  std::string look = "garbage_rows";
  double share = 0.2;         // of the rows, blocks or bytes
  double probability = 1.0;   // that a picture is hit
  std::string side = "both";  // stereo

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("look", look, {"garbage_rows", "lost_blocks", "bit_flips", "black", "missing"});
    v("share", share, {.min = 0.0, .max = 1.0});
    v("probability", probability, {.min = 0.0, .max = 1.0});
    v("side", side, {"both", "left", "right"});
  }
};

// The sensor's clock: stamp + offset_s + skew_ppm * 1e-6 * (time since the fault began).
struct ClockFault {
  double offset_s = 0.0;
  double skew_ppm = 0.0;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("offset_s", offset_s, {.min = -86400.0, .max = 86400.0});
    v("skew_ppm", skew_ppm, {.min = -9e5, .max = 1e6});
  }
};

// Nothing arrives.
struct OffFault {
  template <typename Visitor>
  void Visit(Visitor&) {}
};

// A measurement does not arrive, each by itself with this probability.
struct DropFault {
  double probability = 0.5;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("probability", probability, {.min = 0.0, .max = 1.0});
  }
};

// A measurement arrives again at once: the same stamp, the same reading.
struct DuplicateFault {
  double probability = 1.0;
  int copies = 1;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("probability", probability, {.min = 0.0, .max = 1.0});
    v("copies", copies, {.min = 1, .max = 100});
  }
};

// Everything arrives late; stamps stay.
struct DelayFault {
  double delay_s = 0.1;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("delay_s", delay_s, {.min = 1e-6, .max = 3600.0});
  }
};

// Some measurements are held up and overtaken; stamps stay.
struct ReorderFault {
  double probability = 0.3;
  double hold_s = 0.2;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("probability", probability, {.min = 0.0, .max = 1.0});
    v("hold_s", hold_s, {.min = 1e-6, .max = 3600.0});
  }
};

struct FaultOptions {
  std::string sensor;
  double start_s = 0.0;              // stamps from here ...
  std::optional<double> duration_s;  // ... to before here; absent: to the end
  // Exactly one of these, in the order in which they act when several entries overlap.
  std::optional<StuckFault> stuck;
  std::optional<BiasFault> bias;
  std::optional<DriftFault> drift;
  std::optional<NoiseFault> noise;
  std::optional<DeadChannelFault> dead_channel;
  std::optional<CorruptFault> corrupt;
  std::optional<ClockFault> clock;
  std::optional<OffFault> off;
  std::optional<DropFault> drop;
  std::optional<DuplicateFault> duplicate;
  std::optional<DelayFault> delay;
  std::optional<ReorderFault> reorder;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("sensor", sensor);
    v("start_s", start_s, {.min = 0.0, .max = 1e9});
    v("duration_s", duration_s, {.min = 1e-6, .max = 1e9});
    v("stuck", stuck);
    v("bias", bias);
    v("drift", drift);
    v("noise", noise);
    v("dead_channel", dead_channel);
    v("corrupt", corrupt);
    v("clock", clock);
    v("off", off);
    v("drop", drop);
    v("duplicate", duplicate);
    v("delay", delay);
    v("reorder", reorder);
  }
};

// In the order in which they act.
enum class FaultKind {
  kStuck,
  kBias,
  kDrift,
  kNoise,
  kDeadChannel,
  kCorrupt,
  kClock,
  kOff,
  kDrop,
  kDuplicate,
  kDelay,
  kReorder
};

// The YAML key.
[[nodiscard]] const char* NameOf(FaultKind kind);
[[nodiscard]] const std::vector<FaultKind>& AllFaultKinds();

// Valid options have one.
[[nodiscard]] std::vector<FaultKind> KindsGiven(const FaultOptions& fault);

// Null unless the kind moves readings by amounts.
[[nodiscard]] const Amounts* AmountsOf(const FaultOptions& fault);

[[nodiscard]] const std::vector<std::string>& AllSensors();

// False: this kind of fault makes no sense for that sensor.
[[nodiscard]] bool KindFits(FaultKind kind, const std::string& sensor);

// The keys of those amounts that are not zero, or not their default.
[[nodiscard]] std::vector<std::string> AmountsGiven(const Amounts& amounts);
[[nodiscard]] bool AmountFits(const std::string& amount, const std::string& sensor);

// They may not be in force at once on one sensor: where nothing arrives or all stands still,
// nothing else can be seen; and one kind twice is one entry with other numbers, but for dead
// channels.
[[nodiscard]] bool ExcludeEachOther(const FaultOptions& a, const FaultOptions& b);
[[nodiscard]] bool OverlapInTime(const FaultOptions& a, const FaultOptions& b);

}  // namespace polnav::sim
