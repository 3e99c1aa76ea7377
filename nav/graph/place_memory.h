// Has the vehicle been here before, and how does it stand to that place now?
//
// Keyframes are remembered with binary descriptors and the depths of their points, the first visit
// only. Near one of them again, features are matched by descriptor, and the pose from which the
// remembered points look as they do now is a return: a relative pose, whatever either is in W.
// Finds only places that lie where the estimate says, within the search radius: a vehicle that is
// lost by more is not found.
#pragma once

#include <opencv2/core/mat.hpp>
#include <optional>
#include <vector>

#include "nav/api/measurements.h"
#include "nav/graph/pose_graph.h"
#include "nav/stereo/pose_solver.h"

namespace polnav::nav {

struct PlaceOptions {
  double min_age_s = 20.0;       // a place younger than this is still in the window
  double spacing_m = 2.5;        // between remembered keyframes
  double search_radius_m = 5.0;  // larger bears more drift between visits
  double search_angle_deg = 20.0;
  double match_radius_px = 60.0;  // between where a point should be and where it is seen
  int min_inliers = 25;
  double position_sigma_m = 0.10;  // of a return
  double angle_sigma_deg = 0.3;
  double correlation_time_s = 3.0;  // returns nearer in time than this err alike

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("min_age_s", min_age_s, {.min = 0.0, .max = 3600.0});
    v("spacing_m", spacing_m, {.min = 0.1, .max = 100.0});
    v("search_radius_m", search_radius_m, {.min = 0.1, .max = 100.0});
    v("search_angle_deg", search_angle_deg, {.min = 1.0, .max = 180.0});
    v("match_radius_px", match_radius_px, {.min = 1.0, .max = 1000.0});
    v("min_inliers", min_inliers, {.min = 6, .max = 1000});
    v("position_sigma_m", position_sigma_m, {.min = 0.001, .max = 100.0});
    v("angle_sigma_deg", angle_sigma_deg, {.min = 0.001, .max = 45.0});
    v("correlation_time_s", correlation_time_s, {.min = 0.0, .max = 3600.0});
  }
};

class PlaceMemory {
 public:
  explicit PlaceMemory(const PlaceOptions& options) : options_(options) {}

  // How the graph's last node, which sees `features`, stands to a place it knows. Nothing when
  // none is near or too little matches.
  [[nodiscard]] std::optional<RelativeEdge> Recognize(const RectifiedCamera& camera,
                                                      const std::vector<GraphNode>& nodes,
                                                      const StereoFeatures& features,
                                                      const PoseSolverOptions& solver);

  // Remembers the graph's last node unless a remembered one is near.
  void Remember(const RectifiedCamera& camera, const std::vector<GraphNode>& nodes,
                const StereoFeatures& features);

 private:
  struct Place {
    std::size_t node;
    std::vector<Eigen::Vector3d> landmarks;  // see reprojection.h, hosted here
    cv::Mat descriptors;                     // one row a landmark
  };

  [[nodiscard]] const Place* Nearest(const std::vector<GraphNode>& nodes) const;
  [[nodiscard]] std::vector<LandmarkView> Match(const RectifiedCamera& camera, const Place& place,
                                                const Pose& T_WBh, const Pose& T_WB,
                                                const StereoFeatures& features) const;

  PlaceOptions options_;
  std::vector<Place> places_;
  std::optional<TimeNs> last_return_;
};

}  // namespace polnav::nav
