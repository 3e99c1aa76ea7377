// What does each pixel of the left camera really show?
//
// In the raw, distorted image, at the instant of the stamp (blur and rolling shutter aside).
// A pixel is the ray through its centre: exact wherever that ray meets something, also beside
// edges. Flow is analytic: the point is moved with what it belongs to, and projected into the next
// picture.
#pragma once

#include <opencv2/core/mat.hpp>
#include <vector>

#include "nav/api/calibration.h"
#include "nav/api/time.h"
#include "sim/sensors/frame_request.h"
#include "sim/world/scene.h"

namespace polnav::sim {

struct FrameTruth {
  nav::TimeNs stamp = 0;
  std::uint64_t index = 0;
  cv::Mat depth_m;   // CV_32FC1, z along the optical axis; +inf: sky
  cv::Mat instance;  // CV_16UC1, sim/world/scene.h's Label, or 256 + the actor's index
  // CV_32FC2, from here to the same point in the next picture [px]. Not a number where that point
  // is hidden or outside there. The sky is at infinity: it turns and does not shift.
  cv::Mat flow_px;
  cv::Mat moving;  // CV_8UC1, 255 where an actor moves between the two stamps
};

// First instance that is an actor's.
inline constexpr int kFirstActor = 256;

// Depth and instance as in FrameTruth.
struct TruthLayers {
  cv::Mat depth_m;
  cv::Mat instance;
};

// now, next: what the camera sees at the frame and at the next one.
[[nodiscard]] FrameTruth MakeFrameTruth(const nav::CameraCalibration& camera,
                                        const TruthLayers& now, const TruthLayers& next,
                                        const FrameTruthRequest& request,
                                        const std::vector<Actor>& actors);

}  // namespace polnav::sim
