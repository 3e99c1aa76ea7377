// What is the sky camera, and how far is it from its data sheet? YAML keys = field names.
//
// Instrument errors are what is left after a laboratory calibration of an IMX250MZR-class sensor:
// our choice, made before any compass was run on the pictures.
#pragma once

#include <Eigen/Core>
#include <string>

namespace polnav::sim {

// What stands between the camera and the sky: a wall of unpolarized light all around, whose height
// is drawn once a trial as a sum of eight harmonics of azimuth. Heights are above the true horizon.
struct ObstacleOptions {
  double mean_deg = 0.0;       // height of the wall
  double roughness_deg = 0.0;  // one sigma of its height over azimuth
  double radiance = 0.3;       // relative to the clear zenith

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("mean_deg", mean_deg, {.min = -90.0, .max = 80.0});
    v("roughness_deg", roughness_deg, {.min = 0.0, .max = 45.0});
    v("radiance", radiance, {.min = 0.0, .max = 10.0});
  }
};

struct PolarizationCameraOptions {
  double rate_hz = 1.0;
  int width_px = 640;
  int height_px = 512;
  int bits = 12;
  std::string layout = "90,45/135,0";  // sky/mosaic.h
  std::string lens = "pinhole";        // nav/api/lens.h
  double focal_px = 400.0;
  Eigen::Vector3d position_m = {0.0, 0.0, 1.6};  // of S in B
  bool auto_exposure = true;     // brightest two per cent of the sky at 0.8 of full scale
  double exposure = 0.3;         // else: a pixel's reading under unpolarized radiance 1 [-]
  double full_well_e = 10500.0;  // electrons at full scale
  double read_noise_e = 2.5;
  double gain_sigma = 0.002;                // spread of the four channels' gains [-]
  double offset_sigma = 0.0005;             // of their dark readings over full scale [-]
  double polarizer_angle_sigma_deg = 0.08;  // of their polarizers
  double focal_sigma = 0.002;               // of the focal length, relative [-]
  double center_sigma_px = 1.0;             // of the optical axis
  double mount_error_sigma_deg = 0.05;      // true mounting about the nominal one, each axis
  double flare = 0.002;  // veil of unpolarized light one degree from the sun, clear zenith is 1 [-]
  int sky_step_px = 4;   // the sky is evaluated at every so many pixels and interpolated
  ObstacleOptions obstacles;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("rate_hz", rate_hz, {.min = 0.001, .max = 100.0});
    v("width_px", width_px, {.min = 16, .max = 8192});
    v("height_px", height_px, {.min = 16, .max = 8192});
    v("bits", bits, {.min = 8, .max = 16});
    v("layout", layout);
    v("lens", lens, {"pinhole", "equidistant"});
    v("focal_px", focal_px, {.min = 1.0, .max = 1e5});
    v("position_m", position_m, {.min = -10.0, .max = 10.0});
    v("auto_exposure", auto_exposure);
    v("exposure", exposure, {.min = 1e-6, .max = 1e3});
    v("full_well_e", full_well_e, {.min = 10.0, .max = 1e7});
    v("read_noise_e", read_noise_e, {.min = 0.0, .max = 1e4});
    v("gain_sigma", gain_sigma, {.min = 0.0, .max = 0.3});
    v("offset_sigma", offset_sigma, {.min = 0.0, .max = 0.1});
    v("polarizer_angle_sigma_deg", polarizer_angle_sigma_deg, {.min = 0.0, .max = 10.0});
    v("focal_sigma", focal_sigma, {.min = 0.0, .max = 0.1});
    v("center_sigma_px", center_sigma_px, {.min = 0.0, .max = 100.0});
    v("mount_error_sigma_deg", mount_error_sigma_deg, {.min = 0.0, .max = 10.0});
    v("flare", flare, {.min = 0.0, .max = 10.0});
    v("sky_step_px", sky_step_px, {.min = 1, .max = 64});
    v("obstacles", obstacles);
  }
};

}  // namespace polnav::sim
