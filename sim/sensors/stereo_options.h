// How is the stereo camera built and mounted, and how well is it calibrated?
#pragma once

#include <Eigen/Core>
#include <string>

#include "sim/sensors/feature_options.h"

namespace polnav::sim {

// What separates the estimator's calibration from the truth; one sigma each. A pair is calibrated
// together: some thousand corners seen to 0.1 px hold its disparity to about 0.01 px, while what
// both cameras have in common is known less well.
struct StereoCalibrationErrorOptions {
  double focal_sigma_px = 0.15;     // of both cameras alike, x and y alike
  double center_sigma_px = 0.1;     // of both cameras alike
  double distortion_sigma = 0.001;  // of k1 and k2, both alike; of the other two a tenth
  double relative_share = 0.03;     // share of the above by which the right one differs besides
  double relative_rotation_sigma_deg = 0.001;  // right to left camera, each axis
  double baseline_sigma_m = 0.0001;
  // Both cameras to the body, each axis: what a hand-eye calibration against an IMU leaves. A level
  // drive seen through a wrong pitch climbs: 0.02 degrees are 0.13 m in 377 m.
  double mount_rotation_sigma_deg = 0.02;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("focal_sigma_px", focal_sigma_px, {.min = 0.0, .max = 50.0});
    v("center_sigma_px", center_sigma_px, {.min = 0.0, .max = 50.0});
    v("distortion_sigma", distortion_sigma, {.min = 0.0, .max = 0.1});
    v("relative_share", relative_share, {.min = 0.0, .max = 1.0});
    v("relative_rotation_sigma_deg", relative_rotation_sigma_deg, {.min = 0.0, .max = 5.0});
    v("baseline_sigma_m", baseline_sigma_m, {.min = 0.0, .max = 0.1});
    v("mount_rotation_sigma_deg", mount_rotation_sigma_deg, {.min = 0.0, .max = 10.0});
  }
};

// YAML keys = field names.
struct StereoCameraOptions {
  double rate_hz = 10.0;
  int width_px = 672;
  int height_px = 376;
  double focal_px = 350.0;  // shorter sees more, and less of each thing
  double baseline_m = 0.12;
  // radtan (k1 k2 p1 p2) or equidistant (k1 k2 k3 k4): see nav::DistortionModel. The field may
  // reach 70 degrees from the axis in the corners, whatever the model.
  std::string model = "radtan";
  double k1 = -0.17;
  double k2 = 0.025;
  double k3 = 0.0;  // equidistant only
  double k4 = 0.0;
  double p1 = 0.0003;  // radtan only
  double p2 = -0.0002;
  Eigen::Vector3d position_m = {0.2, 0.06, 1.2};  // of the left camera in B
  double pitch_down_deg = 5.0;
  // Grey value per radiance of the clear zenith, over 255. Zero: fixed once, so that views to all
  // four sides from the world's origin have a mean of target_mean; the sky may saturate.
  double exposure = 0.0;
  double target_mean = 110.0;
  // Darkness towards the corners: 0 none, 1 the cos^4 law of a plain lens (45 degrees from the axis
  // a quarter of the light). None by default: cameras correct for what they know of it.
  double vignetting = 0.0;
  // The gain follows the mean grey of the left picture towards target_mean, the error falling by e
  // in each time constant; above the fixed gain, noise grows with it. False: fixed.
  bool auto_exposure = false;
  double auto_exposure_time_constant_s = 0.5;
  double exposure_time_s = 0.0;    // blurs what moves; 0: an instant
  double rolling_shutter_s = 0.0;  // from the first row to the last; 0: all at once
  // Depth, instances and flow of the left camera besides the pictures; see
  // sim/sensors/frame_truth.h.
  bool ground_truth = false;
  double full_well_e = 6000.0;  // electrons at grey 255; fewer give more shot noise
  double read_noise_e = 6.0;
  StereoCalibrationErrorOptions calibration_error;
  FeatureOptions features;  // only at measurement level, where no pictures are drawn

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("rate_hz", rate_hz, {.min = 0.1, .max = 120.0});
    v("width_px", width_px, {.min = 32, .max = 2048});
    v("height_px", height_px, {.min = 32, .max = 2048});
    v("focal_px", focal_px, {.min = 16.0, .max = 4000.0});
    v("baseline_m", baseline_m, {.min = 0.01, .max = 2.0});
    v("model", model, {"radtan", "equidistant"});
    v("k1", k1, {.min = -0.3, .max = 0.5});
    v("k2", k2, {.min = -0.2, .max = 0.5});
    v("k3", k3, {.min = -0.2, .max = 0.5});
    v("k4", k4, {.min = -0.2, .max = 0.5});
    v("p1", p1, {.min = -0.01, .max = 0.01});
    v("p2", p2, {.min = -0.01, .max = 0.01});
    v("position_m", position_m, {.min = -10.0, .max = 10.0});
    v("pitch_down_deg", pitch_down_deg, {.min = -90.0, .max = 90.0});
    v("exposure", exposure, {.min = 0.0, .max = 1000.0});
    v("target_mean", target_mean, {.min = 5.0, .max = 250.0});
    v("vignetting", vignetting, {.min = 0.0, .max = 1.0});
    v("auto_exposure", auto_exposure);
    v("auto_exposure_time_constant_s", auto_exposure_time_constant_s, {.min = 0.01, .max = 60.0});
    v("exposure_time_s", exposure_time_s, {.min = 0.0, .max = 0.1});
    v("rolling_shutter_s", rolling_shutter_s, {.min = 0.0, .max = 0.1});
    v("ground_truth", ground_truth);
    v("full_well_e", full_well_e, {.min = 10.0, .max = 1e6});
    v("read_noise_e", read_noise_e, {.min = 0.0, .max = 1000.0});
    v("calibration_error", calibration_error);
    v("features", features);
  }
};

}  // namespace polnav::sim
