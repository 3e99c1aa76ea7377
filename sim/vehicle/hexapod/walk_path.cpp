#include "sim/vehicle/hexapod/walk_path.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sim/random.h"
#include "sim/vehicle/approach.h"

namespace polnav::sim {
namespace {

constexpr double kAcceleration_m_s2 = 0.15;
constexpr double kTurnAcceleration_rad_s2 = 1.0;
constexpr double kCourseGain_1_s = 1.0;  // turn rate by course error
constexpr double kAlignFrom_m = 0.3;     // steers for a point so far ahead on the line
constexpr double kArrived_m = 0.01;
constexpr double kTurned_rad = 0.02;
constexpr int kWaves = 6;
constexpr double kShortest_s = 3.0;
constexpr double kLongest_s = 20.0;

double CourseOf(const nav::Pose& T_WB) {
  const Eigen::Vector3d x_W = T_WB.q * Eigen::Vector3d::UnitX();
  return std::atan2(x_W.y(), x_W.x());
}

}  // namespace

WalkPath::WalkPath(const HexapodOptions& options, std::uint64_t seed)
    : options_(options.walk), start_m_(options.start_east_m, options.start_north_m) {
  double course = 0.5 * std::numbers::pi - nav::DegToRad(options.start_heading_deg);
  if (options_.path == "wander") {
    speed_waves_ = DrawWaves(seed, "vehicle/walk/speed");
    turn_waves_ = DrawWaves(seed, "vehicle/walk/turn");
  }
  const int sides = options_.path == "square" ? 4 : options_.path == "straight" ? 1 : 0;
  Eigen::Vector2d corner = start_m_;
  for (int side = 0; side < sides; ++side) {
    corner += options_.length_m * Eigen::Vector2d(std::cos(course), std::sin(course));
    if (sides > 1) course += 0.5 * std::numbers::pi;
    corners_.push_back({corner, course});
  }
}

std::vector<WalkPath::Wave> WalkPath::DrawWaves(std::uint64_t seed, const char* stream) {
  const RandomStream random(seed, 0, stream);
  std::vector<Wave> waves;
  for (int i = 0; i < kWaves; ++i) {
    auto sample = random.At(i);
    const double period_s =
        kShortest_s * std::pow(kLongest_s / kShortest_s, (i + sample.Uniform()) / kWaves);
    waves.push_back({2.0 * std::numbers::pi / period_s, 2.0 * std::numbers::pi * sample.Uniform(),
                     1.0 / std::sqrt(static_cast<double>(kWaves))});
  }
  return waves;
}

WalkCommand WalkPath::Command(double t_s, const nav::Pose& T_WB, double dt_s) {
  Wanted wanted;
  if (t_s >= options_.start_delay_s) {
    wanted = options_.path == "wander" ? Wander(t_s, T_WB) : ToCorners(T_WB);
  }
  given_.speed_m_s = Approach(given_.speed_m_s, wanted.speed_m_s, kAcceleration_m_s2 * dt_s);
  given_.turn_rate_rad_s =
      Approach(given_.turn_rate_rad_s, wanted.turn_rate_rad_s, kTurnAcceleration_rad_s2 * dt_s);
  return {{given_.speed_m_s, 0.0}, given_.turn_rate_rad_s};
}

WalkPath::Wanted WalkPath::Wander(double t_s, const nav::Pose& T_WB) const {
  const auto sum = [t_s](const std::vector<Wave>& waves) {
    double total = 0.0;  // variance one half
    for (const Wave& wave : waves) {
      total += wave.amplitude * std::sin(wave.w_rad_s * t_s + wave.phase_rad);
    }
    return total;
  };
  const double fastest = nav::DegToRad(options_.turn_rate_deg_s);
  Wanted wanted{
      .speed_m_s = options_.speed_m_s * std::clamp(0.6 + 0.6 * sum(speed_waves_), 0.0, 1.0),
      .turn_rate_rad_s = fastest * std::clamp(sum(turn_waves_), -1.0, 1.0)};
  const Eigen::Vector2d home = start_m_ - T_WB.p.head<2>();
  if (home.norm() > options_.radius_m) {
    const double error = nav::WrapPi(std::atan2(home.y(), home.x()) - CourseOf(T_WB));
    wanted.turn_rate_rad_s = std::clamp(kCourseGain_1_s * error, -fastest, fastest);
  }
  return wanted;
}

WalkPath::Wanted WalkPath::ToCorners(const nav::Pose& T_WB) {
  if (finished()) return {};
  const double fastest = nav::DegToRad(options_.turn_rate_deg_s);
  const auto turn_to = [&](double course) {
    const double error = nav::WrapPi(course - CourseOf(T_WB));
    return std::clamp(kCourseGain_1_s * error, -fastest, fastest);
  };
  const Corner& corner = corners_[leg_];
  if (turning_) {
    if (std::abs(nav::WrapPi(corner.course_rad - CourseOf(T_WB))) < kTurned_rad) {
      turning_ = false;
      ++leg_;
    }
    return {.turn_rate_rad_s = turn_to(corner.course_rad)};
  }
  const Eigen::Vector2d from = leg_ == 0 ? start_m_ : corners_[leg_ - 1].p_m;
  const Eigen::Vector2d along = (corner.p_m - from).normalized();
  const double left_m = along.dot(corner.p_m - T_WB.p.head<2>());
  if (left_m < kArrived_m) {
    turning_ = true;
    return {};
  }
  const Eigen::Vector2d ahead = corner.p_m - (left_m - kAlignFrom_m) * along - T_WB.p.head<2>();
  // Slows down as it comes near, so as to stop there.
  return {.speed_m_s = std::min(options_.speed_m_s, std::sqrt(kAcceleration_m_s2 * left_m)),
          .turn_rate_rad_s = turn_to(std::atan2(ahead.y(), ahead.x()))};
}

}  // namespace polnav::sim
