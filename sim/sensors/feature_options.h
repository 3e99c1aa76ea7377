// What does a front end make of the stereo camera's pictures, where none are drawn?
//
// Only at measurement level; docs/measurement_level.md says what is simulated and what is not. YAML
// keys = field names.
#pragma once

namespace polnav::sim {

struct FeatureOptions {
  int max_features = 300;  // followed at once
  int grid_columns = 16;   // the left image is cut into cells that share the features evenly
  int grid_rows = 9;
  // Points that may be followed a steradian of the picture, on any surface from any distance: a
  // third of what fills the grid leaves cells empty, three times as much none but the sky's.
  double points_per_sr = 700.0;
  double max_distance_m = 250.0;  // none is seen from further away
  // Errors of a sighting, along each axis; the defaults are what nav/stereo/tracker.h does in the
  // pictures of five_laps (docs/measurement_level.md).
  double pixel_sigma_px = 0.08;  // white, of where the point is: in the left and in the right image
  double match_sigma_px = 0.15;  // white, of the right image against the left one
  // A track follows a patch whose middle is not the point, but beside it by so much (one sigma of
  // each axis, drawn once a track). As the patch grows, that distance grows with it, and the track
  // leaves its point by the difference. This makes errors alike from frame to frame.
  double patch_sigma_px = 4.0;
  double loss_probability = 0.01;        // that a point is lost from one frame to the next
  double right_loss_probability = 0.01;  // that no stereo match is found, in each frame
  // Of the sightings, in the left and in the right image each by itself: somewhere else, uniform
  // within a disc of outlier_px about the true place.
  double outlier_share = 0.01;
  double outlier_px = 10.0;
  // Of the points: matched all along with something else on the row, uniform within outlier_px.
  double false_match_share = 0.01;
  int flipped_bits = 20;  // of a descriptor's 256, drawn anew in each sighting; some fall twice

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("max_features", max_features, {.min = 20, .max = 2000});
    v("grid_columns", grid_columns, {.min = 1, .max = 100});
    v("grid_rows", grid_rows, {.min = 1, .max = 100});
    v("points_per_sr", points_per_sr, {.min = 1.0, .max = 20000.0});
    v("max_distance_m", max_distance_m, {.min = 1.0, .max = 1000.0});
    v("pixel_sigma_px", pixel_sigma_px, {.min = 0.0, .max = 20.0});
    v("match_sigma_px", match_sigma_px, {.min = 0.0, .max = 20.0});
    v("patch_sigma_px", patch_sigma_px, {.min = 0.0, .max = 50.0});
    v("loss_probability", loss_probability, {.min = 0.0, .max = 1.0});
    v("right_loss_probability", right_loss_probability, {.min = 0.0, .max = 1.0});
    v("outlier_share", outlier_share, {.min = 0.0, .max = 1.0});
    v("outlier_px", outlier_px, {.min = 0.0, .max = 500.0});
    v("false_match_share", false_match_share, {.min = 0.0, .max = 1.0});
    v("flipped_bits", flipped_bits, {.min = 0, .max = 256});
  }
};

}  // namespace polnav::sim
