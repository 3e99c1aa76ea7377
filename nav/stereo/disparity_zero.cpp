#include "nav/stereo/disparity_zero.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>

#include "nav/stereo/reprojection.h"

namespace polnav::nav {
namespace {

using Vector7d = Eigen::Matrix<double, 7, 1>;
using Matrix7d = Eigen::Matrix<double, 7, 7>;
// By which the answers of one pair and the next differ beyond the noise of their points.
constexpr double kPairSigma_px = 0.1;

using Matrix37d = Eigen::Matrix<double, 3, 7>;

struct Unknowns {
  Eigen::Matrix3d R = Eigen::Matrix3d::Identity();
  Eigen::Vector3d t = Eigen::Vector3d::Zero();
  double zero_px = 0.0;
};

struct Term {
  Eigen::Vector3d residual;  // seen minus predicted (u, v, d), in sigmas
  Matrix37d by_unknowns;     // (rotation, t, zero)
  bool in_front = false;
};

Term TermOf(const RectifiedCamera& camera, const TwiceSeen& point, const Unknowns& x,
            double sigma_px) {
  const double f = camera.f_px;
  const double fb = f * camera.baseline_m;
  const double rho = (point.before.z() - x.zero_px) / fb;
  const Eigen::Vector3d turned = x.R * Eigen::Vector3d((point.before.x() - camera.cx_px) / f,
                                                       (point.before.y() - camera.cy_px) / f, 1.0);
  const Eigen::Vector3d q = turned + rho * x.t;
  Term term;
  term.in_front = q.z() > 0.05;
  if (!term.in_front) return term;
  const double inv = 1.0 / q.z();
  const Eigen::Vector3d predicted(f * q.x() * inv + camera.cx_px, f * q.y() * inv + camera.cy_px,
                                  fb * rho * inv + x.zero_px);
  Eigen::Matrix3d by_q;                          // of the prediction
  by_q << f * inv, 0.0, -f * q.x() * inv * inv,  //
      0.0, f * inv, -f * q.y() * inv * inv,      //
      0.0, 0.0, -fb * rho * inv * inv;
  Eigen::Vector3d by_d = by_q * x.t / fb;  // of the prediction by the first disparity
  by_d.z() += inv;
  term.by_unknowns.leftCols<3>() = by_q * Skew(turned);
  term.by_unknowns.middleCols<3>(3) = -rho * by_q;
  term.by_unknowns.col(6) = by_d - Eigen::Vector3d::UnitZ();
  // The first disparity's noise moves all three predictions together.
  const Eigen::Matrix3d covariance =
      sigma_px * sigma_px * (Eigen::Matrix3d::Identity() + by_d * by_d.transpose());
  const Eigen::LLT<Eigen::Matrix3d> whiten(covariance);
  term.residual = whiten.matrixL().solve(point.after - predicted);
  whiten.matrixL().solveInPlace(term.by_unknowns);
  return term;
}

struct Normal {
  Matrix7d H = Matrix7d::Zero();
  Vector7d g = Vector7d::Zero();
};

// Cauchy's weights: what moves by itself is soon left out.
Normal Linearize(const RectifiedCamera& camera, const std::vector<TwiceSeen>& points,
                 const Unknowns& x, double sigma_px, double kernel_sigmas) {
  Normal n;
  for (const TwiceSeen& point : points) {
    const Term term = TermOf(camera, point, x, sigma_px);
    if (!term.in_front) continue;
    const double weight =
        1.0 / (1.0 + term.residual.squaredNorm() / (kernel_sigmas * kernel_sigmas));
    n.H += weight * term.by_unknowns.transpose() * term.by_unknowns;
    n.g += weight * term.by_unknowns.transpose() * term.residual;
  }
  return n;
}

double Length(const TwiceSeen& point) {
  return (point.after.head<2>() - point.before.head<2>()).norm();
}

}  // namespace

ZeroMeasurement MeasureZero(const RectifiedCamera& camera, const std::vector<TwiceSeen>& points,
                            double point_sigma_px, double first_guess_px) {
  const ZeroMeasurement nothing{first_guess_px, std::numeric_limits<double>::infinity()};
  Unknowns x{.zero_px = first_guess_px};
  // From "did not move" the first steps see large residuals everywhere: the kernel narrows.
  Normal n;
  for (const double kernel : {300.0, 100.0, 30.0, 10.0, 4.0, 3.0, 3.0, 3.0, 3.0}) {
    n = Linearize(camera, points, x, point_sigma_px, kernel);
    // A thousandth of a sigma's worth of information on each keeps what is not seen in place.
    n.H.diagonal().array() += 1e-6;
    const Vector7d step = -n.H.ldlt().solve(n.g);
    if (!step.allFinite()) return nothing;
    x.R = ExpRotation(step.head<3>()).toRotationMatrix() * x.R;
    x.t += step.segment<3>(3);
    x.zero_px += step(6);
  }
  const double variance = n.H.ldlt().solve(Vector7d::Unit(6))(6);
  if (!(variance > 0.0) || !std::isfinite(x.zero_px)) return nothing;
  return {x.zero_px, std::sqrt(variance)};
}

DisparityZero::DisparityZero(const DisparityZeroOptions& options, const RectifiedCamera& camera)
    : options_(options),
      camera_(camera),
      sum_sigma_px_(std::hypot(options.sigma_px, options.systematic_px)) {}

double DisparityZero::zero_px() const {
  if (!(options_.sigma_px > 0.0)) return 0.0;
  const double ratio = options_.systematic_px / options_.sigma_px;
  return sum_px_ / (1.0 + ratio * ratio);
}

void DisparityZero::Add(const StereoFeatures& features) {
  if (!(options_.sigma_px > 0.0)) return;
  Seen seen;
  std::vector<TwiceSeen> points;
  for (const FeatureObservation& f : features.features) {
    if (!f.u_right_px) continue;
    const Eigen::Vector3d now(f.uv_left_px.x(), f.uv_left_px.y(), f.uv_left_px.x() - *f.u_right_px);
    seen[f.id] = now;
    const auto before = reference_.find(f.id);
    if (before != reference_.end()) points.push_back({before->second, now});
  }
  if (static_cast<int>(points.size()) < options_.min_points) {
    reference_ = std::move(seen);
    return;
  }
  const auto middle = points.begin() + static_cast<std::ptrdiff_t>(points.size() / 2);
  std::nth_element(points.begin(), middle, points.end(),
                   [](const auto& a, const auto& b) { return Length(a) < Length(b); });
  if (Length(*middle) < options_.flow_px) return;
  reference_ = std::move(seen);
  Fuse(MeasureZero(camera_, points, options_.point_sigma_px, sum_px_));
}

void DisparityZero::Fuse(const ZeroMeasurement& measured) {
  const double variance = measured.sigma_px * measured.sigma_px + kPairSigma_px * kPairSigma_px;
  const double prior = sum_sigma_px_ * sum_sigma_px_ + options_.drift_px * options_.drift_px;
  // Three sigmas off both: the pair was misled, by a lorry that fills the view for instance.
  const double off = measured.zero_px - sum_px_;
  if (!(std::abs(off) < 3.0 * std::sqrt(prior + variance))) return;
  const double gain = prior / (prior + variance);
  sum_px_ += gain * off;
  sum_sigma_px_ = std::sqrt((1.0 - gain) * prior);
}

}  // namespace polnav::nav
