// What does the six-channel polarization sensor on the roof say?
//
// The simulated instrument is a particular one: its gains, polarizer angles and mounting are drawn
// once a trial and stay; the estimator believes the nominal ones. Its optics are
// sky/polarimeter.h; rays that a bridge, a crown or a bus hides bring unpolarized light
// (sim/world/occlusion.h). Not in it: motion during the exposure, stray light, dirt, rain.
//
// Outdoor budget of a single heading by the plain zenith formula [Chu2021, eq. 8], at the defaults,
// sun 16.5 degrees high, car pitching and rolling by 1.5 degrees, in degrees RMS. The paper says
// "better than 2 degrees outdoors", and 0.1 degrees indoors, which is what instrument errors are
// set to; the white part stands for whatever flickers outdoors.
//   noise and quantization       0.95   white
//   gains, polarizer angles      0.1    fixed; turn with the heading as 2 psi and 4 psi
//   mounting, mostly its yaw     0.15   fixed
//   thin cloud                   0.5    correlated over some 50 s; grows with the cover
//   tilt (tan(elevation) of it)  0.5    as the car moves
//   all                          1.25
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>

#include "nav/api/calibration.h"
#include "nav/api/measurements.h"
#include "sim/random.h"
#include "sim/truth.h"
#include "sim/world/occlusion.h"
#include "sky/polarimeter.h"
#include "sky/skylight.h"

namespace polnav::sim {

// YAML keys = field names.
struct PolarimeterOptions {
  double rate_hz = 20.0;
  double fov_deg = 10.0;  // full cone; wider averages over more sky, blurs clouds
  Eigen::Vector3d position_m = {0.0, 0.0, 1.6};  // of S in B
  double exposure = 0.3;  // a channel's reading under unpolarized light of the clear zenith [-]
  double channel_sigma = 0.033;             // noise of one channel over its reading [-]
  int bits = 12;                            // of the converter
  double gain_sigma = 0.004;                // spread of the channels' gains after calibration [-]
  double polarizer_angle_sigma_deg = 0.08;  // spread of the six polarizers' angles
  double mount_error_sigma_deg = 0.15;      // true mounting about the nominal one, each axis

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("rate_hz", rate_hz, {.min = 0.1, .max = 500.0});
    v("fov_deg", fov_deg, {.min = 0.0, .max = 150.0});
    v("position_m", position_m, {.min = -10.0, .max = 10.0});
    v("exposure", exposure, {.min = 0.001, .max = 10.0});
    v("channel_sigma", channel_sigma, {.min = 0.0, .max = 1.0});
    v("bits", bits, {.min = 1, .max = 24});
    v("gain_sigma", gain_sigma, {.min = 0.0, .max = 0.3});
    v("polarizer_angle_sigma_deg", polarizer_angle_sigma_deg, {.min = 0.0, .max = 10.0});
    v("mount_error_sigma_deg", mount_error_sigma_deg, {.min = 0.0, .max = 10.0});
  }
};

// What an estimator is told: looks at B's zenith, x forward, y left.
[[nodiscard]] nav::PolarimeterCalibration NominalPolarimeter(const PolarimeterOptions& options);

class Polarimeter {
 public:
  // The sky must outlive the sensor, and what hides parts of it. Null: nothing does.
  Polarimeter(const PolarimeterOptions& options, const sky::WorldSky& sky, std::uint64_t seed,
              std::uint64_t trial, const Occlusion* occlusion = nullptr);

  // index: of the sample, from 0. Any order.
  [[nodiscard]] nav::PolarizationSample Sample(const Truth& truth, std::uint64_t index,
                                               const sky::FogAbove& fog = {}) const;

 private:
  PolarimeterOptions options_;
  const sky::WorldSky* sky_;
  const Occlusion* occlusion_;
  sky::SixChannelOptics optics_;
  Eigen::Quaterniond q_BS_;
  RandomStream noise_;
};

}  // namespace polnav::sim
