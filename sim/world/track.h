// Which way does the road go?
//
// A closed, near-circular loop in the horizontal plane, driven counter-clockwise, that starts at
// the origin heading north. About its centre c, to the west, it is the polar curve
//   r(theta) = R (1 + h(theta)),  theta counted from east towards north, start at theta = 0,
// with h of the harmonics 2 and 3 only, h'(0) = 0. Every derivative is continuous. R is such that
// one lap has exactly the length asked for (the periodic trapezoid rule converges to rounding).
#pragma once

#include <Eigen/Core>
#include <vector>

namespace polnav::sim {

// YAML keys = field names.
struct TrackOptions {
  double length_m = 377.0;       // of one lap along the centre line
  double noncircularity = 0.06;  // relative amplitude of the radius' harmonics 2 and 3, together
  double road_width_m = 8.0;

  bool operator==(const TrackOptions&) const = default;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("length_m", length_m, {.min = 60.0, .max = 5000.0});
    v("noncircularity", noncircularity, {.min = 0.0, .max = 0.2});
    v("road_width_m", road_width_m, {.min = 3.0, .max = 30.0});
  }
};

class Track {
 public:
  explicit Track(const TrackOptions& options);

  struct Point {
    Eigen::Vector2d p_m;         // on the centre line, ENU
    Eigen::Vector2d tangent;     // unit, driving direction
    double curvature_1_m = 0.0;  // positive: turning left
  };
  // s_m: arc length from the start, any number of laps, negative too.
  [[nodiscard]] Point At(double s_m) const;

  // Nearest point of the centre line: arc length in [0, length) and signed offset [m], positive to
  // the left of the driving direction (inside the loop). It is the nearest for points closer to the
  // road than its radius of curvature; deep inside the loop it is one near the polar angle.
  struct Projection {
    double s_m = 0.0;
    double offset_m = 0.0;
    Eigen::Vector2d tangent;  // unit, driving direction, at the nearest point
  };
  [[nodiscard]] Projection Project(const Eigen::Vector2d& p_m) const;

  // How far the centre line's point of the same polar angle is: at most 1.2 times the distance from
  // the road, and much cheaper than Project. For skipping what is far from the road.
  [[nodiscard]] double RadialDistance(const Eigen::Vector2d& p_m) const;

  [[nodiscard]] double length_m() const { return options_.length_m; }
  [[nodiscard]] double road_width_m() const { return options_.road_width_m; }
  [[nodiscard]] const Eigen::Vector2d& center_m() const { return center_m_; }
  [[nodiscard]] double mean_radius_m() const { return radius_m_; }

 private:
  // The curve about the centre and its derivatives by the polar angle [m].
  struct Curve {
    Eigen::Vector2d p, d1, d2;
  };
  [[nodiscard]] Curve CurveAt(double cos_theta, double sin_theta) const;
  [[nodiscard]] double ArcAt(double theta_rad) const;  // theta in [0, 2 pi]
  [[nodiscard]] double AngleAt(double s_m) const;      // s in [0, length)
  void TabulateArc();

  TrackOptions options_;
  Eigen::Vector2d center_m_ = Eigen::Vector2d::Zero();
  double radius_m_ = 1.0;
  // Arc length and its derivative at equal steps of the polar angle; cubic in between.
  std::vector<double> arc_m_;
  std::vector<double> arc_rate_m_;
};

}  // namespace polnav::sim
