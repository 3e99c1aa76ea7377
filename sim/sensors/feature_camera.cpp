#include "sim/sensors/feature_camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sim/sensors/feature_errors.h"
#include "sim/sensors/lens.h"
#include "sim/sensors/lens_warp.h"
#include "sim/world/actor.h"

namespace polnav::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Eigen::Vector3f;
using Sample = RandomStream::Sample;

constexpr double kNearest_m = 0.3;
// A followed point is let go when its strength falls below this; a new one has at least 1.
constexpr double kLeastStrength = 0.7;
// Frames from one look for something in between to the next; of the right camera twice as many.
constexpr std::uint64_t kLookEvery = 5;
constexpr std::uint64_t kHiddenFor = 10;  // frames that a hidden point is not looked for

// Below which no point of the patch can be seen; infinite when all are turned away.
float LeastReach(const FeaturePatch& patch, const Vector3f& to_center) {
  const float distance = to_center.norm();
  const float nearest = std::max(0.0F, distance - patch.radius_m);
  // The greatest of normal times way to the eye.
  const float slant =
      patch.depth_m - to_center.dot(patch.axis) + (distance + patch.radius_m) * patch.spread;
  if (slant <= 0.0F) return std::numeric_limits<float>::infinity();
  return nearest * std::max(1.0F, std::sqrt(nearest / slant));
}

bool IsInside(const nav::CameraCalibration& camera, const Vector2d& pixel) {
  return pixel.x() >= 1.0 && pixel.y() >= 1.0 && pixel.x() <= camera.width_px - 2.0 &&
         pixel.y() <= camera.height_px - 2.0;
}

}  // namespace

FeatureCamera::FeatureCamera(const Scene& scene, const Occlusion& occlusion, FeatureCloud cloud,
                             const nav::StereoCalibration& truth,
                             const StereoCameraOptions& options, std::uint64_t seed,
                             std::uint64_t trial)
    : scene_(scene),
      occlusion_(occlusion),
      cloud_(std::move(cloud)),
      cameras_(truth),
      options_(options),
      widest_tangent_(1.05 *
                      std::tan(std::max(AngleOfField(truth.left), AngleOfField(truth.right)))),
      per_cell_(std::max(1, options.features.max_features /
                                (options.features.grid_columns * options.features.grid_rows))),
      loss_stream_(seed, trial, "stereo/features/loss"),
      noise_stream_(seed, trial, "stereo/features/noise"),
      track_stream_(seed, trial, "stereo/features/tracks"),
      descriptor_stream_(seed, trial, "stereo/features/descriptors"),
      flip_stream_(seed, trial, "stereo/features/flips"),
      cover_stream_(seed, trial, "stereo/features/cover"),
      followed_(cloud_.points.size(), 0),
      hidden_until_(cloud_.points.size(), 0) {}

FeatureSightings FeatureCamera::See(const FrameRequest& request) {
  const Frame frame = Open(request);
  Follow(frame);
  Detect(frame);
  return Measure(frame);
}

FeatureCamera::Frame FeatureCamera::Open(const FrameRequest& request) const {
  const auto eye = [&](const nav::CameraCalibration& camera) {
    const nav::Pose T_WC = request.T_WB * camera.T_BC;
    return Eye{T_WC.Inverse(), occlusion_.Around(T_WC.p, request.stamp)};
  };
  Frame frame{request,
              {request.conditions, options_, cover_stream_, request.stamp},
              eye(cameras_.left),
              eye(cameras_.right),
              {}};
  const auto add = [&](const std::optional<nav::Pose>& T_WA) {
    frame.owners.emplace_back();
    if (!T_WA) return;
    const nav::Pose T_CA = frame.left.T_CW * *T_WA;
    frame.owners.back() = Owner{*T_WA, T_CA.Inverse().p.cast<float>(),
                                (T_CA.q.conjugate() * Vector3d::UnitZ()).cast<float>()};
  };
  add(nav::Pose{});
  for (const Actor& actor : scene_.actors) add(PoseOf(actor.path, request.stamp));
  return frame;
}

std::optional<Vector2d> FeatureCamera::PixelIn(const nav::CameraCalibration& camera, const Eye& eye,
                                               const Vector3d& p_W_m) const {
  const Vector3d p_C = eye.T_CW * p_W_m;
  // Beyond its field a distortion may fold back.
  if (p_C.z() < kNearest_m || p_C.head<2>().norm() > widest_tangent_ * p_C.z()) return std::nullopt;
  const Vector2d pixel = ProjectToPixel(camera, p_C);
  if (!IsInside(camera, pixel)) return std::nullopt;
  return pixel;
}

// Where the left camera would have it, whatever is in between. Its strength: the square of its
// reach over what it takes to see it; nothing when it is outside or turned away.
std::optional<double> FeatureCamera::Look(const Frame& frame, Track& track) const {
  const std::optional<Owner>& owner = frame.OwnerOf(track.actor);
  if (!owner) return std::nullopt;
  const FeaturePoint& point = cloud_.points[track.point];
  track.p_W_m = owner->T_WA * point.p_m.cast<double>();
  const auto pixel = PixelIn(cameras_.left, frame.left, track.p_W_m);
  if (!pixel || frame.conditions.Saturates(point.brightness)) return std::nullopt;
  if (frame.conditions.IsCovered(0, *pixel)) return std::nullopt;
  track.left_px = *pixel;
  const Vector3d to_eye = frame.left.view.eye_W_m() - track.p_W_m;
  const double distance = to_eye.norm();
  const double cosine = to_eye.dot(owner->T_WA.q * point.normal.cast<double>()) / distance;
  track.distance_m = distance;
  const double share = frame.conditions.ContrastShare(distance) * point.reach_m / distance;
  return share * share * cosine;
}

void FeatureCamera::Follow(const Frame& frame) {
  Sample draw = loss_stream_.At(frame.request.index);
  std::vector<Track> kept;
  for (Track& track : tracks_) {
    const bool lost = draw.Uniform() < options_.features.loss_probability;
    const std::optional<double> strength = Look(frame, track);
    bool keep = !lost && strength && *strength > kLeastStrength;
    const std::uint64_t turn = (frame.request.index + track.id) % (2 * kLookEvery);
    if (keep && turn % kLookEvery == 0) keep = !frame.left.view.Hides(track.p_W_m);
    if (keep && turn == 0) track.right_sees = !frame.right.view.Hides(track.p_W_m);
    if (keep) {
      kept.push_back(track);
    } else {
      followed_[track.point] = 0;
    }
  }
  tracks_ = std::move(kept);
}

int FeatureCamera::CellOf(const Vector2d& pixel) const {
  const FeatureOptions& o = options_.features;
  const int column = std::min(static_cast<int>(pixel.x() * o.grid_columns / options_.width_px),
                              o.grid_columns - 1);
  const int row =
      std::min(static_cast<int>(pixel.y() * o.grid_rows / options_.height_px), o.grid_rows - 1);
  return row * o.grid_columns + column;
}

// Points of a patch that might fill a place; those within the picture's circle are worth a look.
void FeatureCamera::CollectFrom(const FeaturePatch& patch, const Frame& frame,
                                const std::vector<int>& filled,
                                std::vector<Candidate>& candidates) const {
  const std::optional<Owner>& owner = frame.OwnerOf(patch.actor);
  if (!owner) return;
  const auto tangent = static_cast<float>(widest_tangent_);
  const float cosine = 1.0F / std::sqrt(1.0F + tangent * tangent);
  const Vector3f to_center = patch.center_m - owner->eye_m;
  const float z_center = to_center.dot(owner->axis);
  // How far the ball's middle is outside the cone.
  const float aside = (to_center - z_center * owner->axis).norm();
  if (cosine * (aside - tangent * z_center) > patch.radius_m) return;
  const float least_reach = LeastReach(patch, to_center);
  for (std::uint32_t i = patch.begin; i < patch.end; ++i) {
    const FeaturePoint& point = cloud_.points[i];
    if (point.reach_m < least_reach) break;  // and all that follow
    const Vector3f v = point.p_m - owner->eye_m;
    const float distance2 = v.squaredNorm();
    const float z = v.dot(owner->axis);
    if (z < 0.0F || z * z < cosine * cosine * distance2) continue;
    const float slant = -v.dot(point.normal) * point.reach_m * point.reach_m;
    if (slant < distance2 * std::sqrt(distance2)) continue;
    if (followed_[i] != 0 || hidden_until_[i] > frame.request.index) continue;
    Candidate candidate{.track = {.point = i, .actor = patch.actor}};
    const std::optional<double> strength = Look(frame, candidate.track);
    if (!strength || *strength < 1.0) continue;
    candidate.strength = *strength;
    candidate.cell = CellOf(candidate.track.left_px);
    if (filled[static_cast<std::size_t>(candidate.cell)] < per_cell_) {
      candidates.push_back(candidate);
    }
  }
}

// Fills the grid's empty places with the strongest points that nothing hides.
void FeatureCamera::Detect(const Frame& frame) {
  const FeatureOptions& o = options_.features;
  std::vector<int> filled(static_cast<std::size_t>(o.grid_columns * o.grid_rows), 0);
  for (const Track& track : tracks_) ++filled[static_cast<std::size_t>(CellOf(track.left_px))];
  std::vector<Candidate> candidates;
  for (const FeaturePatch& patch : cloud_.patches) CollectFrom(patch, frame, filled, candidates);
  std::sort(candidates.begin(), candidates.end(), [](const Candidate& a, const Candidate& b) {
    return std::pair(-a.strength, a.track.point) < std::pair(-b.strength, b.track.point);
  });
  for (Candidate& candidate : candidates) {
    if (static_cast<int>(tracks_.size()) >= o.max_features) return;
    int& count = filled[static_cast<std::size_t>(candidate.cell)];
    if (count >= per_cell_) continue;
    Track& track = candidate.track;
    if (frame.left.view.Hides(track.p_W_m)) {
      hidden_until_[track.point] = frame.request.index + kHiddenFor;
      continue;
    }
    track.id = next_id_++;
    track.errors = DrawTrackErrors(o, track_stream_.At(track.id));
    track.first_m = track.distance_m;
    track.right_sees = !frame.right.view.Hides(track.p_W_m);
    followed_[track.point] = 1;
    ++count;
    tracks_.push_back(track);
  }
}

FeatureSightings FeatureCamera::Measure(const Frame& frame) const {
  const FeatureOptions& o = options_.features;
  Sample draw = noise_stream_.At(frame.request.index);
  Sample flips = flip_stream_.At(frame.request.index);
  FeatureSightings seen{.stamp = frame.request.stamp, .sightings = {}};
  for (const Track& track : tracks_) {
    FeatureSighting& sighting = seen.sightings.emplace_back();
    sighting.id = track.id;
    sighting.point = track.point;
    const SightingErrors errors = DrawSightingErrors(o, draw);
    const Vector2d slip = Slip(track.errors, track.first_m, track.distance_m);
    sighting.left_px = track.left_px + slip + errors.left_px;
    const std::optional<Vector2d> right = PixelIn(cameras_.right, frame.right, track.p_W_m);
    if (right && !errors.right_lost && track.right_sees && !frame.conditions.IsCovered(1, *right)) {
      sighting.right_px =
          *right + slip + errors.right_px + Vector2d(track.errors.false_match_px, 0.0);
    }
    sighting.descriptor = DescriptorOf(descriptor_stream_.At(track.point), o.flipped_bits, flips);
  }
  return seen;
}

}  // namespace polnav::sim
