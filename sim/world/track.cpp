#include "sim/world/track.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

namespace polnav::sim {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr int kSteps = 2048;

// r / R and its first two derivatives by the polar angle. The sine terms make the loop's halves
// differ; their weights (3 and -2) keep the slope at theta = 0 zero, so that it starts due north.
struct Radius {
  double r, d1, d2;
};

Radius RelativeRadius(double c, double s, double amplitude) {
  constexpr double kCos2 = 0.45;
  constexpr double kCos3 = 0.30;
  constexpr double kSin2 = 0.15;
  constexpr double kSin3 = -0.10;
  const double c2 = c * c - s * s;
  const double s2 = 2.0 * c * s;
  const double c3 = c2 * c - s2 * s;
  const double s3 = s2 * c + c2 * s;
  const double e2 = kCos2 * c2 + kSin2 * s2;
  const double e3 = kCos3 * c3 + kSin3 * s3;
  return {1.0 + amplitude * (e2 + e3),
          amplitude * (2.0 * (kSin2 * c2 - kCos2 * s2) + 3.0 * (kSin3 * c3 - kCos3 * s3)),
          -amplitude * (4.0 * e2 + 9.0 * e3)};
}

}  // namespace

Track::Track(const TrackOptions& options) : options_(options) {
  double length_of_unit = 0.0;
  for (int i = 0; i < kSteps; ++i) {
    const double theta = kTurn * i / kSteps;
    length_of_unit += CurveAt(std::cos(theta), std::sin(theta)).d1.norm() * kTurn / kSteps;
  }
  radius_m_ = options_.length_m / length_of_unit;
  if (options_.road_width_m > 0.8 * radius_m_) {
    throw std::invalid_argument("track: road_width_m " + std::to_string(options_.road_width_m) +
                                " is too wide for a loop of length_m " +
                                std::to_string(options_.length_m));
  }
  center_m_ = -CurveAt(1.0, 0.0).p;
  TabulateArc();
}

// Simpson's rule between the nodes: its error, (step / 2)^5 / 90 times the fourth derivative, is
// below 1e-13 of the radius. The last node closes the lap exactly.
void Track::TabulateArc() {
  const auto rate = [this](double theta) {
    return CurveAt(std::cos(theta), std::sin(theta)).d1.norm();
  };
  const double step = kTurn / kSteps;
  arc_m_.assign(kSteps + 1, 0.0);
  arc_rate_m_.assign(kSteps + 1, rate(0.0));
  for (int i = 1; i <= kSteps; ++i) {
    arc_rate_m_[i] = rate(step * i);
    const double middle = rate(step * (i - 0.5));
    arc_m_[i] = arc_m_[i - 1] + step / 6.0 * (arc_rate_m_[i - 1] + 4.0 * middle + arc_rate_m_[i]);
  }
  arc_m_.back() = options_.length_m;
}

Track::Curve Track::CurveAt(double c, double s) const {
  const Radius rel = RelativeRadius(c, s, options_.noncircularity);
  const Eigen::Vector2d radial(c, s);
  const Eigen::Vector2d around(-s, c);
  return {radius_m_ * rel.r * radial, radius_m_ * (rel.d1 * radial + rel.r * around),
          radius_m_ * ((rel.d2 - rel.r) * radial + 2.0 * rel.d1 * around)};
}

double Track::ArcAt(double theta_rad) const {
  const double step = kTurn / kSteps;
  const int i = std::clamp(static_cast<int>(theta_rad / step), 0, kSteps - 1);
  const double t = theta_rad / step - i;
  const double t2 = t * t;
  const double t3 = t2 * t;
  return (2.0 * t3 - 3.0 * t2 + 1.0) * arc_m_[i] + (3.0 * t2 - 2.0 * t3) * arc_m_[i + 1] +
         step * ((t3 - 2.0 * t2 + t) * arc_rate_m_[i] + (t3 - t2) * arc_rate_m_[i + 1]);
}

// Newton from the chord of the table's interval: two steps leave less than a nanometre.
double Track::AngleAt(double s_m) const {
  const double step = kTurn / kSteps;
  const auto above = std::upper_bound(arc_m_.begin() + 1, arc_m_.end() - 1, s_m);
  const auto i = above - arc_m_.begin() - 1;
  double theta = step * (i + (s_m - arc_m_[i]) / (arc_m_[i + 1] - arc_m_[i]));
  for (int iteration = 0; iteration < 2; ++iteration) {
    theta -= (ArcAt(theta) - s_m) / CurveAt(std::cos(theta), std::sin(theta)).d1.norm();
  }
  return theta;
}

Track::Point Track::At(double s_m) const {
  const double lap = options_.length_m;
  const double theta = AngleAt(std::clamp(s_m - lap * std::floor(s_m / lap), 0.0, lap));
  const Curve curve = CurveAt(std::cos(theta), std::sin(theta));
  const double speed = curve.d1.norm();
  const double cross = curve.d1.x() * curve.d2.y() - curve.d1.y() * curve.d2.x();
  return {center_m_ + curve.p, curve.d1 / speed, cross / (speed * speed * speed)};
}

// Newton on (curve - p) . curve' = 0 from the polar angle. Past the centre of curvature the true
// derivative turns negative; holding it up keeps the step bounded there.
Track::Projection Track::Project(const Eigen::Vector2d& p_m) const {
  const Eigen::Vector2d q = p_m - center_m_;
  double theta = q.squaredNorm() > 0.0 ? std::atan2(q.y(), q.x()) : 0.0;
  Curve curve = CurveAt(std::cos(theta), std::sin(theta));
  for (int iteration = 0; iteration < 10; ++iteration) {
    const double d1_sq = curve.d1.squaredNorm();
    const Eigen::Vector2d gap = curve.p - q;
    const double slope = std::max(d1_sq + gap.dot(curve.d2), 0.25 * d1_sq);
    const double step = gap.dot(curve.d1) / slope;
    theta -= step;
    curve = CurveAt(std::cos(theta), std::sin(theta));
    if (std::abs(step) < 1e-6) break;  // converges quadratically: the rest is below 1e-12
  }
  const Eigen::Vector2d tangent = curve.d1.normalized();
  const Eigen::Vector2d gap = q - curve.p;
  theta -= kTurn * std::floor(theta / kTurn);
  const double s = ArcAt(std::min(theta, kTurn));
  return {s < options_.length_m ? s : 0.0, tangent.x() * gap.y() - tangent.y() * gap.x(), tangent};
}

double Track::RadialDistance(const Eigen::Vector2d& p_m) const {
  const Eigen::Vector2d q = p_m - center_m_;
  const double rho = q.norm();
  if (rho == 0.0) return radius_m_;
  const Radius rel = RelativeRadius(q.x() / rho, q.y() / rho, options_.noncircularity);
  return std::abs(rho - radius_m_ * rel.r);
}

}  // namespace polnav::sim
