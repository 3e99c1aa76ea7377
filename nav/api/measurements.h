// What does a sensor say?
//
// The seam of Polnav: an estimator cannot tell whether these came from the simulator, a recording
// or a cable. A stamp is the middle of the exposure, or the end of the interval where the struct
// says so. Measurements arrive in order of simulated arrival time.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "nav/api/geometry.h"
#include "nav/api/time.h"

namespace polnav::nav {

// Means over the interval that ends at the stamp, in the IMU's own axes (= B up to misalignment);
// docs/imu.md says how they integrate.
struct ImuSample {
  TimeNs stamp = 0;
  Eigen::Vector3d gyro_rad_s = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_m_s2 = Eigen::Vector3d::Zero();  // specific force: +g upwards at rest
};

// A synchronous pair of raw (distorted) 8-bit grey images.
struct StereoImages {
  TimeNs stamp = 0;
  cv::Mat left;   // CV_8UC1
  cv::Mat right;  // CV_8UC1
};

// One feature in the rectified pair's virtual pinhole camera [px]; see nav/stereo/rectifier.h.
struct FeatureObservation {
  std::uint64_t id = 0;  // the same physical point keeps its id while it is tracked
  Eigen::Vector2d uv_left_px = Eigen::Vector2d::Zero();
  std::optional<double> u_right_px;  // absent when no stereo match was accepted
};

struct StereoFeatures {
  TimeNs stamp = 0;
  std::vector<FeatureObservation> features;
  // CV_8UC1, one row a feature, compared by Hamming distance, to know a place again; may be empty.
  cv::Mat descriptors;
};

// Six intensities behind polarizers at 0, 90, 60, 150, 120, 210 degrees: three opponent pairs
// [Zeng2020, eq. 3], counted from S's x axis towards its y axis. Full scale is 1.
struct PolarizationSample {
  TimeNs stamp = 0;
  std::array<double, 6> channel{};
};

// A raw mosaic of an imaging polarimeter.
struct PolarizationImage {
  TimeNs stamp = 0;
  cv::Mat mosaic;  // CV_8UC1 or CV_16UC1
};

// Image motion of a camera that looks down (PX4Flow's signs), integrated over the interval that
// ends at the stamp. A turn of F by a small angle about x or y reads that angle; moving at v_F over
// ground at distance d along the optical axis, flow_rad = integral of (w_x - v_y / d, w_y + v_x /
// d) dt.
struct OpticalFlowSample {
  TimeNs stamp = 0;
  TimeNs integration = 0;
  Eigen::Vector2d flow_rad = Eigen::Vector2d::Zero();
  Eigen::Vector3d gyro_rad = Eigen::Vector3d::Zero();  // F's own gyroscopes, integrated alike
  std::optional<double> range_m;  // to the ground along the optical axis; absent: no echo
  double quality = 0.0;           // 0 (none) to 1
};

// A GNSS/INS reference system's solution. Recorded for comparison: estimators ignore it.
struct ReferencePose {
  TimeNs stamp = 0;
  Pose T_WB;
  Eigen::Vector3d v_WB_m_s = Eigen::Vector3d::Zero();
  bool gnss_aided = true;  // false: inertia alone, errors grow
};

using Measurement = std::variant<ImuSample, StereoImages, StereoFeatures, PolarizationSample,
                                 PolarizationImage, OpticalFlowSample, ReferencePose>;

[[nodiscard]] inline TimeNs StampOf(const Measurement& measurement) {
  return std::visit([](const auto& m) { return m.stamp; }, measurement);
}

// The sensor's name in scenarios and results.
[[nodiscard]] inline const char* StreamName(const Measurement& measurement) {
  struct Namer {
    const char* operator()(const ImuSample&) const { return "imu"; }
    const char* operator()(const StereoImages&) const { return "stereo"; }
    const char* operator()(const StereoFeatures&) const { return "stereo_features"; }
    const char* operator()(const PolarizationSample&) const { return "polarimeter"; }
    const char* operator()(const PolarizationImage&) const { return "polarization_camera"; }
    const char* operator()(const OpticalFlowSample&) const { return "flow"; }
    const char* operator()(const ReferencePose&) const { return "reference"; }
  };
  return std::visit(Namer{}, measurement);
}

}  // namespace polnav::nav
