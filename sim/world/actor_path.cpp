#include "sim/world/actor_path.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>

namespace polnav::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// Between keys a spline: 1.5 m holds a bend of 8 m radius to a millimetre.
constexpr double kKeyStep_m = 1.5;

nav::Pose PoseOnGround(const StreetFrame& street, const Vector2d& p, const Vector2d& towards,
                       double lift_m, Stance stance) {
  const Vector3d up = stance == Stance::kOnWheels ? street.NormalAt(p) : Vector3d::UnitZ();
  const Vector3d flat(towards.x(), towards.y(), 0.0);
  Eigen::Matrix3d axes;
  axes.col(1) = up.cross(flat).normalized();
  axes.col(0) = axes.col(1).cross(up);
  axes.col(2) = up;
  return {Eigen::Quaterniond(axes), street.OnGround(p, lift_m)};
}

// Keys every so often from begin_s, until one lies at or beyond end_s and one more does.
std::vector<ActorKey> KeysEvery(double step_s, double begin_s, double end_s,
                                const std::function<nav::Pose(double t_s)>& pose_at) {
  std::vector<ActorKey> keys;
  const auto steps = static_cast<int>(std::ceil(std::max(0.0, end_s - begin_s) / step_s)) + 1;
  for (int i = 0; i <= steps; ++i) {
    const double t_s = begin_s + i * step_s;
    keys.push_back({nav::FromSeconds(t_s), pose_at(t_s)});
  }
  return keys;
}

// A smooth curve through points, by arc length.
class Curve {
 public:
  Curve(const std::vector<Vector2d>& points, bool closed) : points_(points), closed_(closed) {
    constexpr int kSamples = 64;  // a span; chords in between are short by 1e-4 of a sharp bend
    const std::size_t spans = points.size() - (closed ? 0 : 1);
    for (std::size_t span = 0; span < spans; ++span) {
      for (int k = 0; k < kSamples; ++k) {
        Add(At(span, static_cast<double>(k) / kSamples));
      }
    }
    Add(At(spans - 1, 1.0));
  }

  [[nodiscard]] double length_m() const { return arc_m_.back(); }

  [[nodiscard]] Vector2d PointAt(double s_m) const {
    const double s = std::clamp(s_m, 0.0, arc_m_.back());
    const auto above = std::upper_bound(arc_m_.begin() + 1, arc_m_.end() - 1, s);
    const auto i = static_cast<std::size_t>(above - arc_m_.begin()) - 1;
    const double share = (s - arc_m_[i]) / (arc_m_[i + 1] - arc_m_[i]);
    return samples_[i] + share * (samples_[i + 1] - samples_[i]);
  }

 private:
  [[nodiscard]] Vector2d Point(std::ptrdiff_t i) const {
    const auto n = static_cast<std::ptrdiff_t>(points_.size());
    if (closed_) return points_[static_cast<std::size_t>((i % n + n) % n)];
    if (i < 0) return 2.0 * points_[0] - points_[1];
    if (i >= n) return 2.0 * points_.back() - points_[points_.size() - 2];
    return points_[static_cast<std::size_t>(i)];
  }

  // Uniform Catmull-Rom.
  [[nodiscard]] Vector2d At(std::size_t span, double t) const {
    const auto i = static_cast<std::ptrdiff_t>(span);
    const Vector2d a = Point(i - 1);
    const Vector2d b = Point(i);
    const Vector2d c = Point(i + 1);
    const Vector2d d = Point(i + 2);
    return 0.5 * (2.0 * b + t * (c - a) + t * t * (2.0 * a - 5.0 * b + 4.0 * c - d) +
                  t * t * t * (3.0 * b - a - 3.0 * c + d));
  }

  void Add(const Vector2d& p) {
    if (samples_.empty()) {
      arc_m_.push_back(0.0);
    } else {
      const double step = (p - samples_.back()).norm();
      if (step < 1e-9) return;
      arc_m_.push_back(arc_m_.back() + step);
    }
    samples_.push_back(p);
  }

  const std::vector<Vector2d>& points_;
  bool closed_;
  std::vector<Vector2d> samples_;
  std::vector<double> arc_m_;
};

}  // namespace

void CheckPath(const std::vector<Vector2d>& points_m) {
  if (points_m.size() < 2) {
    throw std::invalid_argument("a path needs two points or more, this one has " +
                                std::to_string(points_m.size()));
  }
  for (std::size_t i = 1; i < points_m.size(); ++i) {
    if ((points_m[i] - points_m[i - 1]).norm() < 1e-3) {
      throw std::invalid_argument("the points " + std::to_string(i - 1) + " and " +
                                  std::to_string(i) + " of the path are the same");
    }
  }
}

std::vector<ActorKey> AlongRoad(const StreetFrame& street, const RoadRun& run) {
  const double step_s = kKeyStep_m / std::max(0.1, std::abs(run.speed_m_s));
  return KeysEvery(step_s, run.begin_s, run.end_s, [&](double t_s) {
    const double s = run.s_m + run.speed_m_s * (t_s - run.at_s);
    const double ahead = run.speed_m_s < 0.0 ? -0.05 : 0.05;
    const Vector2d before = street.At(s - ahead, run.offset_m).head<2>();
    const Vector2d after = street.At(s + ahead, run.offset_m).head<2>();
    return PoseOnGround(street, street.At(s, run.offset_m).head<2>(), after - before, run.lift_m,
                        run.stance);
  });
}

std::vector<ActorKey> AlongPolyline(const StreetFrame& street, const PointRun& run) {
  CheckPath(run.points_m);
  const Curve curve(run.points_m, run.loop && run.points_m.size() > 2);
  const double lap_m = curve.length_m();
  // There and back when two points make a loop.
  const bool back_and_forth = run.loop && run.points_m.size() == 2;
  // Whole steps a lap, so that the last key is the last point.
  const double step_s = lap_m / std::max(4.0, std::ceil(lap_m / kKeyStep_m)) / run.speed_m_s;
  const double end_s = run.loop ? run.end_s : run.begin_s + lap_m / run.speed_m_s - 1.5 * step_s;
  return KeysEvery(step_s, run.begin_s, end_s, [&](double t_s) {
    double s = run.speed_m_s * (t_s - run.begin_s);
    double forward = 1.0;
    if (back_and_forth) {
      s = std::fmod(s, 2.0 * lap_m);
      if (s >= lap_m) forward = -1.0;
      s = s < lap_m ? s : 2.0 * lap_m - s;
    } else if (run.loop) {
      s = std::fmod(s, lap_m);
    }
    const Vector2d towards = forward * (curve.PointAt(s + 0.05) - curve.PointAt(s - 0.05));
    return PoseOnGround(street, curve.PointAt(s), towards, run.lift_m, run.stance);
  });
}

}  // namespace polnav::sim
