// How does the image compass go about it? YAML keys = field names.
#pragma once

#include <string>

namespace polnav::nav {

struct CompassOptions {
  // zenith: the middle of the picture as one reading; lsq: all pixels alike; ransac_tls: pixels
  // that agree [Fan2020]; stokes: Stokes parameters weighted by what they are worth.
  // Not a key: a scenario names a compass by its method.
  std::string method = "stokes";
  double min_elevation_deg = 10.0;    // rays below see haze, houses and trees
  double radius_px = 0.0;             // of the disc about the optical axis that is used; 0: all
  double saturation = 0.97;           // pixels above, over full scale, do not count
  double zenith_patch_deg = 5.0;      // half angle of what `zenith` reads
  double ransac_threshold_deg = 2.0;  // E-vectors within agree; wider lets clouds in
  int ransac_samples = 100;           // the more, the surer that one of them is clear sky

  // What `stokes` believes of its errors, in units of Q/I.
  double clear_sigma = 0.005;  // of a clear sky's departure from the pattern
  // Polarization of light that is not the clear sky's, one sigma: what a patch of sky has in
  // common, and what its blocks have beside that.
  double patch_light_dop = 0.10;
  double lost_light_dop = 0.04;
  // What the sigma makes of it: polarization that clouds add to the clear sky between them, times
  // the share of the sky that they hide. Fitted, see docs/compass.md.
  double gap_light_dop = 0.0048;
  double correlation_deg = 20.0;    // size of a patch; larger: a larger sigma, half turns less sure
  double tilt_sigma_deg = 0.0;      // of the roll and pitch that are handed in
  double half_turn_evidence = 8.0;  // log-likelihood between two headings, for one to be chosen

  double max_sigma_deg = 5.0;       // a heading less certain than this is none
  double min_used_fraction = 0.05;  // of the blocks in view
  double min_agreement = 0.5;       // mean cosine of twice the angle to the model, by polarization
  // Of the clearest blocks, scaled to 90 degrees from the sun: below, all may be cloud, since
  // overcast skies reach 0.16 [Hegedus2007].
  double min_dop = 0.16;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("min_elevation_deg", min_elevation_deg, {.min = 0.0, .max = 80.0});
    v("radius_px", radius_px, {.min = 0.0, .max = 1e5});
    v("saturation", saturation, {.min = 0.1, .max = 1.0});
    v("zenith_patch_deg", zenith_patch_deg, {.min = 0.5, .max = 45.0});
    v("ransac_threshold_deg", ransac_threshold_deg, {.min = 0.01, .max = 45.0});
    v("ransac_samples", ransac_samples, {.min = 1, .max = 10000});
    v("clear_sigma", clear_sigma, {.min = 0.0, .max = 1.0});
    v("patch_light_dop", patch_light_dop, {.min = 0.001, .max = 1.0});
    v("lost_light_dop", lost_light_dop, {.min = 0.0, .max = 1.0});
    v("gap_light_dop", gap_light_dop, {.min = 0.0, .max = 1.0});
    v("correlation_deg", correlation_deg, {.min = 0.1, .max = 180.0});
    v("tilt_sigma_deg", tilt_sigma_deg, {.min = 0.0, .max = 45.0});
    v("half_turn_evidence", half_turn_evidence, {.min = 0.0, .max = 1000.0});
    v("max_sigma_deg", max_sigma_deg, {.min = 0.01, .max = 90.0});
    v("min_used_fraction", min_used_fraction, {.min = 0.0, .max = 1.0});
    v("min_agreement", min_agreement, {.min = 0.0, .max = 1.0});
    v("min_dop", min_dop, {.min = 0.0, .max = 1.0});
  }
};

}  // namespace polnav::nav
