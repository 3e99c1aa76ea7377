// What optical-flow sensor is it, and how far is it from its data sheet? YAML keys = field names.
//
// The defaults are a PX4Flow [Honegger2013]: 16 mm lens, 24 um pixels after binning, 64 x 64 of
// them; an L3GD20 gyroscope and an HRLV-MaxSonar-EZ4 sonar [L3GD20] [MB1043]. docs/optical_flow.md
// says which figures are theirs and which are our choice.
#pragma once

#include <Eigen/Core>

namespace polnav::sim {

// At measurement level, where no picture is drawn: the fit of docs/optical_flow.md.
struct OpticalFlowModelOptions {
  // What one picture's pixel noise adds to a displacement, along each axis, one sigma, over a grain
  // of contrast 0.1 whose pixels cover 0.6 mm.
  double noise_sigma_px = 0.010;
  // A picture's noise pulls the displacement before it and the one after it oppositely while the
  // ground moves by less than this from one to the next: errors of slow flow take themselves back.
  double texture_length_px = 1.5;
  // Half of the blocks have texture enough to be matched where the noise above reaches this.
  double half_matched_px = 0.043;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("noise_sigma_px", noise_sigma_px, {.min = 0.0, .max = 10.0});
    v("texture_length_px", texture_length_px, {.min = 0.01, .max = 1000.0});
    v("half_matched_px", half_matched_px, {.min = 1e-4, .max = 10.0});
  }
};

struct OpticalFlowOptions {
  double rate_hz = 50.0;
  // Pictures a second: the ground may move by 4 px from one to the next. At 250 Hz and 0.4 m that
  // is 0.6 m/s, or 85 deg/s; half the rate halves it, and the cost.
  double internal_rate_hz = 250.0;
  Eigen::Vector3d position_m = {0.2, 0.0, 0.3};  // of F in B; it looks along B's -z

  int side_px = 64;
  double focal_px = 16.0 / 0.024;
  double target_mean = 110.0;          // grey level that the exposure aims at
  double full_well_e = 80000.0;        // electrons at grey level 255, of a binned pixel
  double read_noise_e = 100.0;         // of a binned pixel
  double focal_sigma = 0.01;           // of the focal length, relative: focus and lens
  double mount_error_sigma_deg = 0.3;  // true mounting about the nominal one, each axis

  double gyro_noise_deg_s_sqrt_hz = 0.03;
  double gyro_bias_sigma_deg_s = 0.2;  // what zeroing at the start leaves, each axis
  double gyro_scale_sigma = 0.01;      // of each axis

  double range_min_m = 0.3;
  double range_max_m = 5.0;
  double range_sigma_m = 0.003;       // white
  double range_bias_sigma_m = 0.003;  // drawn once a trial; so is the scale
  double range_scale_sigma = 0.01;    // speed of sound, mostly
  double range_dropout_probability = 0.01;
  double range_beam_deg = 20.0;  // full cone, in which the nearest thing is heard

  OpticalFlowModelOptions model;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("rate_hz", rate_hz, {.min = 0.1, .max = 500.0});
    v("internal_rate_hz", internal_rate_hz, {.min = 1.0, .max = 500.0});
    v("position_m", position_m, {.min = -10.0, .max = 10.0});
    VisitCamera(v);
    v("gyro_noise_deg_s_sqrt_hz", gyro_noise_deg_s_sqrt_hz, {.min = 0.0, .max = 1.0});
    v("gyro_bias_sigma_deg_s", gyro_bias_sigma_deg_s, {.min = 0.0, .max = 20.0});
    v("gyro_scale_sigma", gyro_scale_sigma, {.min = 0.0, .max = 0.3});
    VisitRange(v);
    v("model", model);
  }

 private:
  template <typename Visitor>
  void VisitCamera(Visitor& v) {
    v("side_px", side_px, {.min = 32, .max = 256});
    v("focal_px", focal_px, {.min = 50.0, .max = 5000.0});
    v("target_mean", target_mean, {.min = 5.0, .max = 250.0});
    v("full_well_e", full_well_e, {.min = 100.0, .max = 1e7});
    v("read_noise_e", read_noise_e, {.min = 0.0, .max = 1e4});
    v("focal_sigma", focal_sigma, {.min = 0.0, .max = 0.2});
    v("mount_error_sigma_deg", mount_error_sigma_deg, {.min = 0.0, .max = 10.0});
  }

  template <typename Visitor>
  void VisitRange(Visitor& v) {
    v("range_min_m", range_min_m, {.min = 0.0, .max = 1000.0});
    v("range_max_m", range_max_m, {.min = 0.01, .max = 1000.0});
    v("range_sigma_m", range_sigma_m, {.min = 0.0, .max = 10.0});
    v("range_bias_sigma_m", range_bias_sigma_m, {.min = 0.0, .max = 10.0});
    v("range_scale_sigma", range_scale_sigma, {.min = 0.0, .max = 0.3});
    v("range_dropout_probability", range_dropout_probability, {.min = 0.0, .max = 1.0});
    v("range_beam_deg", range_beam_deg, {.min = 0.0, .max = 90.0});
  }
};

}  // namespace polnav::sim
