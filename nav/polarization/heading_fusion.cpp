#include "nav/polarization/heading_fusion.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "nav/polarization/reading_errors.h"
#include "nav/polarization/sky_heading.h"

namespace polnav::nav {
namespace {

// The first edge carries the slow part's whole information: worth a second of readings.
constexpr int kFirstReadings = 20;

// Variance of a heading by that of the attitude.
double HeadingVariance(const Eigen::Vector2d& by_tilt, const Eigen::Matrix3d& covariance) {
  const Eigen::Vector3d by_attitude(by_tilt.x(), by_tilt.y(), 1.0);
  return by_attitude.dot(covariance * by_attitude);
}

// ... and by the instrument's errors.
double HeadingVariance(const SkyErrors& by_errors, const SkyErrors& sigmas) {
  return by_errors.cwiseProduct(sigmas).squaredNorm();
}

// Of the heading that is read. Turned about its view, the instrument sees the axis turned, and the
// heading with it.
SkyErrors ByErrors(double axis_rad) {
  SkyErrors by;
  by << 1.0, std::cos(2.0 * axis_rad), std::sin(2.0 * axis_rad), std::cos(4.0 * axis_rad),
      std::sin(4.0 * axis_rad);
  return by;
}

// So that a perfect instrument leaves no singular matrix.
constexpr double kLeastError_rad = 1e-7;

}  // namespace

HeadingFusion::HeadingFusion(const PolarizationOptions& options,
                             const PolarimeterCalibration& calibration, SunModel sun)
    : options_(options), calibration_(calibration), sun_(std::move(sun)) {}

SkyErrors HeadingFusion::ErrorSigmas() const {
  SkyErrors sigmas;
  sigmas.setConstant(std::max(kLeastError_rad, DegToRad(options_.harmonic_sigma_deg)));
  sigmas(0) = std::max(kLeastError_rad, DegToRad(options_.mount_sigma_deg));
  return sigmas;
}

Outcome HeadingFusion::Add(const PolarizationSample& sample) {
  const bool frozen = newest_ && sample.channel == newest_->channel;
  newest_ = sample;
  const auto light = UsableLight(sample, options_);
  if (!light || frozen) return Outcome::kUnusable;
  const auto same = [&](const Reading& r) { return r.stamp == sample.stamp; };
  const bool late = advanced_to_ && sample.stamp < *advanced_to_;  // no attitude is kept for it
  if (late || std::any_of(waiting_.begin(), waiting_.end(), same)) return Outcome::kUnusable;
  waiting_.push_back({sample.stamp, *light});
  return Outcome::kUsed;
}

// False: gated.
bool HeadingFusion::Take(const Reading& reading, const Eigen::Quaterniond& q_WB,
                         const Eigen::Matrix3d& covariance) {
  const Eigen::Vector3d sun = sun_(reading.stamp);
  const Eigen::Vector3d e_B = EVectorOf(reading.light, calibration_);
  const auto heading = HeadingFromEVector(e_B, q_WB, sun);
  if (!heading) return false;
  const Eigen::Vector2d by_tilt = HeadingByTilt(q_WB * e_B, sun);
  const Eigen::Vector3d look_W = q_WB * (calibration_.T_BS.q * Eigen::Vector3d::UnitZ());
  const auto [white, foreign] = ErrorsOf(reading.light, look_W, sun, options_);
  const double slow =
      DegToRad(std::hypot(options_.correlated_sigma_deg, options_.foreign_sigma_deg * foreign));
  const double innovation = WrapPi(*heading - CompassHeading(q_WB));
  const SkyErrors by_errors = ByErrors(reading.light.axis_rad);
  const double variance = white * white + slow * slow + HeadingVariance(by_tilt, covariance) +
                          HeadingVariance(by_errors, ErrorSigmas());
  const bool gated = std::abs(innovation) > options_.gate_sigmas * std::sqrt(variance);
  residuals_.push_back({reading.stamp, innovation, std::sqrt(variance), gated});
  if (gated) return false;
  const double weight = 1.0 / (white * white);
  ++sums_.readings;
  sums_.weight += weight;
  sums_.innovation_rad += weight * innovation;
  sums_.slow2_rad2 += weight * slow * slow;
  sums_.by_tilt += weight * by_tilt;
  sums_.by_errors += weight * by_errors;
  return true;
}

int HeadingFusion::Advance(TimeNs from, const Eigen::Quaterniond& q_from, TimeNs to,
                           const Eigen::Quaterniond& q_to, const Eigen::Matrix3d& covariance) {
  int gated = 0;
  residuals_.clear();
  const auto later = [&](const Reading& r) { return r.stamp > to; };
  for (const Reading& reading : waiting_) {
    if (later(reading)) continue;
    const double share =
        to > from ? std::clamp(ToSeconds(reading.stamp - from) / ToSeconds(to - from), 0.0, 1.0)
                  : 1.0;
    if (!Take(reading, q_from.slerp(share, q_to), covariance)) ++gated;
  }
  std::erase_if(waiting_, [&](const Reading& r) { return !later(r); });
  advanced_to_ = to;
  return gated;
}

std::optional<HeadingEdge> HeadingFusion::TakeEdge(TimeNs stamp, const Eigen::Quaterniond& q_WB,
                                                   const Eigen::Matrix3d& covariance) {
  const bool first = !last_edge_;
  if (sums_.readings < (first ? kFirstReadings : 1)) return std::nullopt;
  const Sums sums = std::exchange(sums_, {});
  const double mean = sums.innovation_rad / sums.weight;
  const double white2 = 1.0 / sums.weight;
  const double slow2 = sums.slow2_rad2 / sums.weight;
  const Eigen::Vector2d by_tilt = sums.by_tilt / sums.weight;
  const SkyErrors by_errors = sums.by_errors / sums.weight;
  const double expected2 = white2 + slow2 + HeadingVariance(by_tilt, covariance) +
                           HeadingVariance(by_errors, ErrorSigmas());
  if (std::abs(mean) > options_.edge_gate_sigmas * std::sqrt(expected2)) return std::nullopt;
  // The slow part counts once at the start; after that, as often as it has changed.
  const double slow_share =
      first ? 1.0
            : std::max(1.0, 2.0 * options_.correlation_time_s / ToSeconds(stamp - *last_edge_));
  last_edge_ = stamp;
  HeadingEdge edge{
      .heading_rad = WrapPi(CompassHeading(q_WB) + mean), .by_errors = by_errors, .q_WB = q_WB};
  double variance = white2 + slow2 * slow_share;
  if (options_.full_attitude) {
    edge.by_tilt = by_tilt;
  } else {
    const Eigen::Vector3d tilt(by_tilt.x(), by_tilt.y(), 0.0);
    variance += tilt.dot(covariance * tilt);
  }
  edge.sigma_rad = std::sqrt(variance);
  return edge;
}

}  // namespace polnav::nav
