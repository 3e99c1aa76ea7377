// How does the stereo estimator behave? YAML keys = field names.
#pragma once

#include "nav/graph/loop_closing.h"
#include "nav/inertial/options.h"

namespace polnav::nav {

// What a calibration misses of the pair's zero of disparity; see nav/stereo/disparity_zero.h.
struct DisparityZeroOptions {
  // What calibrations miss, one sigma. 0: they are right, and nothing is estimated.
  double sigma_px = 0.1;
  // What all answers get wrong alike, because lens and tracking depart from their models; as much
  // as that, where nobody knows better. Larger trusts the calibration more.
  double systematic_px = 0.1;
  double drift_px = 0.003;      // of z from one pair of frames to the next
  double point_sigma_px = 0.3;  // of a followed point, and of a disparity
  double flow_px = 6.0;         // median motion between the two frames of a pair
  int min_points = 30;          // seen in both

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("sigma_px", sigma_px, {.min = 0.0, .max = 5.0});
    v("drift_px", drift_px, {.min = 0.0, .max = 1.0});
    v("systematic_px", systematic_px, {.min = 0.0, .max = 5.0});
    v("point_sigma_px", point_sigma_px, {.min = 0.01, .max = 5.0});
    v("flow_px", flow_px, {.min = 0.5, .max = 100.0});
    v("min_points", min_points, {.min = 8, .max = 1000});
  }
};

// The front end: corners spread over the image, followed by Lucas-Kanade in the left image and
// matched along its row of the right one, both checked both ways.
struct TrackerOptions {
  int max_features = 300;  // more: steadier and slower
  int grid_columns = 16;   // the image is cut into cells that share the features evenly
  int grid_rows = 9;
  int min_distance_px = 10;       // between features
  double corner_quality = 0.001;  // of a cell's corner over the image's best [-]
  // Sigma of a blur before tracking; 0: none. Takes noise and aliasing from the patches, and
  // detail.
  double smoothing_px = 0.8;
  // Patch side. A large one scatters less and bears blur, but the ground before a car bends in the
  // picture as it comes nearer, which no stretch takes up: 15 px shift it by 0.02 to 0.07 px.
  int window_px = 11;
  int pyramid_levels = 3;  // above full size; 3 bears motions of about 60 px
  // A track is held against the picture where it began until its depth has changed by this ratio
  // or it lies further than this from where the last picture says; then it begins anew.
  double reference_scale = 1.25;
  double reference_px = 3.0;
  double forward_backward_px = 0.6;  // a track must come back to where it was
  double epipolar_px = 1.2;          // rows of left and right may differ by, where no pictures are
  double stereo_correlation = 0.8;   // of the two patches of a stereo match; higher: fewer, surer
  double max_disparity_px = 120.0;
  DisparityZeroOptions zero;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("max_features", max_features, {.min = 20, .max = 2000});
    v("grid_columns", grid_columns, {.min = 1, .max = 100});
    v("grid_rows", grid_rows, {.min = 1, .max = 100});
    v("min_distance_px", min_distance_px, {.min = 2, .max = 100});
    v("corner_quality", corner_quality, {.min = 1e-6, .max = 1.0});
    v("smoothing_px", smoothing_px, {.min = 0.0, .max = 3.0});
    v("window_px", window_px, {.min = 5, .max = 41});
    v("pyramid_levels", pyramid_levels, {.min = 0, .max = 8});
    v("reference_scale", reference_scale, {.min = 1.0, .max = 4.0});
    v("reference_px", reference_px, {.min = 0.0, .max = 10.0});
    v("forward_backward_px", forward_backward_px, {.min = 0.05, .max = 10.0});
    v("epipolar_px", epipolar_px, {.min = 0.1, .max = 10.0});
    v("stereo_correlation", stereo_correlation, {.min = 0.0, .max = 1.0});
    v("max_disparity_px", max_disparity_px, {.min = 1.0, .max = 1000.0});
    v("zero", zero);
  }
};

struct StereoOptions {
  TrackerOptions tracker;
  // Four times what tracking scatters by: its errors are alike from frame to frame and from point
  // to point (patches on ground that comes nearer drift all one way), and a larger sigma is how the
  // window knows. Disparities, each found anew, err more independently. Larger trusts vision less.
  double pixel_sigma_px = 1.5;
  double disparity_sigma_px = 0.8;
  double flow_gate_sigmas = 4.0;  // A of [Chu2021, eq. 12]: departure from the predicted flow
  double inlier_sigmas = 1.2;     // departure from the solved pose that makes an outlier
  int min_inliers = 12;           // fewer: the frame is not tracked, the estimate coasts
  int window_keyframes = 8;       // longer: less drift, slower (cost grows with its square)
  double keyframe_distance_m = 1.4;
  double keyframe_angle_deg = 4.0;
  double keyframe_overlap = 0.5;  // a keyframe too when fewer of the last one's points are left
  int max_iterations = 6;         // of the bundle adjustment, a keyframe
  bool use_imu = true;            // where the rig has one
  InertialOptions inertial;
  LoopOptions loops;  // only where the estimator closes loops

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("tracker", tracker);
    v("pixel_sigma_px", pixel_sigma_px, {.min = 0.01, .max = 10.0});
    v("disparity_sigma_px", disparity_sigma_px, {.min = 0.01, .max = 10.0});
    v("flow_gate_sigmas", flow_gate_sigmas, {.min = 1.0, .max = 100.0});
    v("inlier_sigmas", inlier_sigmas, {.min = 1.0, .max = 20.0});
    v("min_inliers", min_inliers, {.min = 4, .max = 1000});
    v("window_keyframes", window_keyframes, {.min = 3, .max = 50});
    v("keyframe_distance_m", keyframe_distance_m, {.min = 0.01, .max = 100.0});
    v("keyframe_angle_deg", keyframe_angle_deg, {.min = 0.1, .max = 90.0});
    v("keyframe_overlap", keyframe_overlap, {.min = 0.0, .max = 1.0});
    v("max_iterations", max_iterations, {.min = 1, .max = 100});
    v("use_imu", use_imu);
    v("inertial", inertial);
    v("loops", loops);
  }
};

}  // namespace polnav::nav
