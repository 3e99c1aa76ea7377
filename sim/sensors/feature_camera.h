// Which points would a front end follow through the stereo camera's pictures, and where?
//
// The measurement level's camera: no picture is drawn. Points of a cloud on the scene's surfaces
// are followed while the left camera sees them: within its picture and reach, from the front, with
// nothing in between (rays against the scene and its actors; a followed point is looked after every
// few frames only). They are projected through the true lenses; noise, outliers, false matches and
// losses are added (feature_options.h). A point that is lost and seen again gets a new id. What
// blinds cameras takes points away (feature_conditions.h).
// Pixels are raw (distorted); the centre of the top left one is (0, 0).
// Not in it: errors that neighbours share, motion blur.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "nav/api/calibration.h"
#include "sim/random.h"
#include "sim/sensors/feature_cloud.h"
#include "sim/sensors/feature_conditions.h"
#include "sim/sensors/feature_errors.h"
#include "sim/sensors/frame_request.h"
#include "sim/sensors/stereo_options.h"
#include "sim/world/occlusion.h"

namespace polnav::sim {

struct FeatureSighting {
  std::uint64_t id = 0;
  std::uint32_t point = 0;  // of the cloud: the truth, for whoever evaluates
  Eigen::Vector2d left_px = Eigen::Vector2d::Zero();
  std::optional<Eigen::Vector2d> right_px;
  Descriptor descriptor{};
};

struct FeatureSightings {
  nav::TimeNs stamp = 0;
  std::vector<FeatureSighting> sightings;
};

class FeatureCamera {
 public:
  // Scene and occlusion must outlive it.
  FeatureCamera(const Scene& scene, const Occlusion& occlusion, FeatureCloud cloud,
                const nav::StereoCalibration& truth, const StereoCameraOptions& options,
                std::uint64_t seed, std::uint64_t trial);

  // Frames must come one after the other: which points are followed depends on those before.
  [[nodiscard]] FeatureSightings See(const FrameRequest& request);

  [[nodiscard]] const FeatureCloud& cloud() const { return cloud_; }

 private:
  struct Track {
    std::uint64_t id = 0;
    std::uint32_t point = 0;
    int actor = -1;
    TrackErrors errors;
    double first_m = 0.0;                               // from the left eye, where it began
    bool right_sees = false;                            // nothing is in between, at the last look
    Eigen::Vector3d p_W_m = Eigen::Vector3d::Zero();    // now
    double distance_m = 0.0;                            // from the left eye, now
    Eigen::Vector2d left_px = Eigen::Vector2d::Zero();  // now, without errors
  };
  struct Eye {
    nav::Pose T_CW;
    Occlusion::View view;
  };
  // Of points: what stands still, A = W, or an actor that is there.
  struct Owner {
    nav::Pose T_WA;
    Eigen::Vector3f eye_m;  // the left camera in A
    Eigen::Vector3f axis;   // where it looks, in A
  };
  struct Frame {
    const FrameRequest& request;
    FeatureConditions conditions;
    Eye left;
    Eye right;
    std::vector<std::optional<Owner>> owners;  // what stands still, then every actor
    [[nodiscard]] const std::optional<Owner>& OwnerOf(int actor) const {
      return owners[static_cast<std::size_t>(actor + 1)];
    }
  };
  struct Candidate {
    double strength;
    int cell;
    Track track;
  };

  [[nodiscard]] Frame Open(const FrameRequest& request) const;
  [[nodiscard]] std::optional<double> Look(const Frame& frame, Track& track) const;
  [[nodiscard]] std::optional<Eigen::Vector2d> PixelIn(const nav::CameraCalibration& camera,
                                                       const Eye& eye,
                                                       const Eigen::Vector3d& p_W_m) const;
  void Follow(const Frame& frame);
  void Detect(const Frame& frame);
  void CollectFrom(const FeaturePatch& patch, const Frame& frame, const std::vector<int>& filled,
                   std::vector<Candidate>& candidates) const;
  [[nodiscard]] FeatureSightings Measure(const Frame& frame) const;
  [[nodiscard]] int CellOf(const Eigen::Vector2d& pixel) const;

  const Scene& scene_;
  const Occlusion& occlusion_;
  FeatureCloud cloud_;
  nav::StereoCalibration cameras_;
  StereoCameraOptions options_;
  double widest_tangent_;
  int per_cell_;  // of the grid, at most
  RandomStream loss_stream_;
  RandomStream noise_stream_;
  RandomStream track_stream_;
  RandomStream descriptor_stream_;
  RandomStream flip_stream_;
  RandomStream cover_stream_;
  std::vector<Track> tracks_;
  std::vector<std::uint8_t> followed_;       // by point
  std::vector<std::uint64_t> hidden_until_;  // by point: not worth a look before this frame
  std::uint64_t next_id_ = 0;
};

}  // namespace polnav::sim
