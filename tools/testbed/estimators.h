// Which estimators can a scenario run, and what must the vehicle carry for them?
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <variant>

#include "nav/polarization/compass_estimator.h"
#include "nav/polarization/polarimeter_compass.h"
#include "nav/stereo/estimator.h"
#include "nav/ukf/paper_ukf.h"
#include "nav/ukf/ukf.h"
#include "tools/testbed/scenario.h"

namespace polnav::testbed {

struct EstimatorInfo {
  std::string_view name;
  std::string_view description;
  bool needs_stereo = false;
  bool needs_polarimeter = false;
  bool needs_polarization_camera = false;
  bool needs_imu = false;
  bool needs_optical_flow = false;
  bool heading_only = false;      // a compass
  bool estimates_biases = false;  // of the IMU, and says so
};

inline constexpr std::array<EstimatorInfo, 11> kEstimators{{
    {.name = "stereo",
     .description = "stereo visual odometry in a sliding window, without the sky",
     .needs_stereo = true},
    {.name = "stereo_polarization",
     .description = "stereo and polarized skylight, tightly coupled [Chu2021]",
     .needs_stereo = true,
     .needs_polarimeter = true},
    {.name = "polarization",
     .description = "heading from single readings of the point polarimeter, level [Chu2021]",
     .needs_polarimeter = true,
     .heading_only = true},
    {.name = "compass_lsq",
     .description = "heading from sky images: least squares over all pixels, Fan2020's baseline",
     .needs_polarization_camera = true,
     .heading_only = true},
    {.name = "compass_ransac_tls",
     .description = "heading from sky images: RANSAC and total least squares [Fan2020]",
     .needs_polarization_camera = true,
     .heading_only = true},
    {.name = "compass_stokes",
     .description = "heading from sky images: Stokes parameters weighted by what they are worth",
     .needs_polarization_camera = true,
     .heading_only = true},
    {.name = "compass_zenith",
     .description = "heading from sky images: the middle of the picture as one reading",
     .needs_polarization_camera = true,
     .heading_only = true},
    {.name = "ukf_paper",
     .description = "walking: IMU, optical flow and sky in a Kalman filter, as printed [Zeng2020]",
     .needs_polarimeter = true,
     .needs_imu = true,
     .needs_optical_flow = true},
    {.name = "ukf_paper_no_polarization",
     .description = "the same without the sky [Zeng2020]",
     .needs_imu = true,
     .needs_optical_flow = true},
    {.name = "ukf",
     .description = "walking: IMU, optical flow and sky, with biases, on the manifold",
     .needs_polarimeter = true,
     .needs_imu = true,
     .needs_optical_flow = true,
     .estimates_biases = true},
    {.name = "ukf_no_polarization",
     .description = "the same without the sky",
     .needs_imu = true,
     .needs_optical_flow = true,
     .estimates_biases = true},
}};

// Null when there is none of that name; InfoOf then throws std::logic_error.
[[nodiscard]] const EstimatorInfo* FindInfo(std::string_view name);
[[nodiscard]] const EstimatorInfo& InfoOf(std::string_view name);

using AnyEstimator = std::variant<nav::StereoEstimator, nav::PolarimeterCompass,
                                  nav::CompassEstimator, nav::PaperUkf, nav::Ukf>;

// The scenario names it and the rig carries what it needs.
[[nodiscard]] AnyEstimator MakeEstimator(const std::string& name, const Scenario& scenario,
                                         const nav::Rig& rig, const nav::StartPrior& start);

[[nodiscard]] bool ClosesLoops(const Scenario& scenario, const std::string& name);

// An estimator that runs closes loops: features need descriptors.
[[nodiscard]] bool WantsDescriptors(const Scenario& scenario);

// The estimators' sun: from the place and date they are told, not from the simulator.
[[nodiscard]] nav::SunModel SunFor(const sky::SiteOptions& site);

}  // namespace polnav::testbed
