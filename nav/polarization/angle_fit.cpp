#include "nav/polarization/angle_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "nav/api/geometry.h"

namespace polnav::nav {
namespace {

constexpr int kCoarseAngles = 72;
constexpr int kIterations = 10;
constexpr double kConverged_rad = 1e-5;
constexpr double kLongestStep_rad = 0.1;
constexpr float kWorthAsking = 0.2F;     // of the pattern: below, its polarization says little
constexpr double kClearQuantile = 0.90;  // of the blocks, by polarization over the pattern's
constexpr float kCauchy2 = 4.0F;         // square of where residuals begin to count less, in sigmas
constexpr double kIndependent = 20.0;    // blocks that a picture is worth: neighbours err alike
constexpr double kScatteringSigma = 0.1;  // of light scattered many times, over all light

double AngleOf(int k) { return 2.0 * std::numbers::pi * k / kCoarseAngles; }

}  // namespace

double AngleFit::ScatteringPrior() const {
  return static_cast<double>(sky_.size()) / kIndependent / (kScatteringSigma * kScatteringSigma);
}

Eigen::ArrayXf AngleFit::Cost() const {
  return 0.5F * variance_.log() +
         0.5F * kCauchy2 * (1.0F + values_.across.square() / (kCauchy2 * variance_)).log();
}

double AngleFit::Clear() const {
  return static_cast<double>(
      (lost_ < 0.5F && values_.across.square() < kCauchy2 * variance_).count());
}

std::vector<double> AngleFit::CoarseAngles() {
  std::vector<double> score;
  for (int k = 0; k < kCoarseAngles; ++k) {
    pattern_.At(AngleOf(k), values_);
    score.push_back((values_.fraction * values_.along).sum());
  }
  std::vector<double> angles;
  for (int k = 0; k < kCoarseAngles; ++k) {
    const double here = score[static_cast<std::size_t>(k)];
    const double before = score[static_cast<std::size_t>((k + kCoarseAngles - 1) % kCoarseAngles)];
    const double after = score[static_cast<std::size_t>((k + 1) % kCoarseAngles)];
    if (here > before && here >= after) angles.push_back(AngleOf(k));
  }
  if (angles.empty()) angles.push_back(0.0);  // no block polarized at all
  return angles;
}

double AngleFit::MaxDop(double angle_rad) {
  pattern_.At(angle_rad, values_);
  std::vector<float> ratio;
  for (Eigen::Index i = 0; i < sky_.size(); ++i) {
    if (values_.fraction[i] > kWorthAsking) ratio.push_back(values_.along[i] / values_.fraction[i]);
  }
  if (ratio.empty()) return 0.0;
  const auto rank =
      static_cast<std::ptrdiff_t>(kClearQuantile * static_cast<double>(ratio.size() - 1));
  std::nth_element(ratio.begin(), ratio.begin() + rank, ratio.end());
  return std::clamp<double>(ratio[static_cast<std::size_t>(rank)], 0.0, 1.0);
}

void AngleFit::Judge(double angle_rad, double max_dop) {
  pattern_.At(angle_rad, values_);
  vertical_ = pattern_.VerticalAcross(values_);
  values_.across -= static_cast<float>(scattering_) * vertical_;
  const auto top = static_cast<float>(std::max(max_dop, 1e-3));
  const auto clear2 = static_cast<float>(std::pow(options_.clear_sigma, 2));
  const auto lost2 = static_cast<float>(std::pow(options_.lost_light_dop, 2));
  lost_ = (1.0F - values_.along / (top * values_.fraction.max(1e-3F))).max(0.0F).min(2.0F);
  variance_ = sky_.variance + clear2 + lost2 * lost_.square();
  weight_ = 1.0F / (variance_ + values_.across.square() / kCauchy2);
  // Next to the sun the pattern turns fast: what is brighter polarized there than it can be would
  // otherwise lead all others.
  derivative_ = values_.turn * values_.along.max(0.0F).min(top * values_.fraction);
}

AngleFit::Equations AngleFit::Linearize() const {
  const Eigen::Index size = sky_.size();
  const double loose = 1.0 / std::pow(options_.patch_light_dop, 2);
  std::vector<Eigen::Vector3d> sums(static_cast<std::size_t>(tiles_.likeness.rows()),
                                    Eigen::Vector3d(0.0, 0.0, loose));
  for (Eigen::Index i = 0; i < size; ++i) {
    const float pull = weight_[i] * lost_[i];
    sums[static_cast<std::size_t>(sky_.tile[static_cast<std::size_t>(i)])] +=
        Eigen::Vector3f(pull * derivative_[i], pull * vertical_[i], pull * lost_[i]).cast<double>();
  }
  Equations equations;
  equations.parts.resize(size, 2);
  for (Eigen::Index i = 0; i < size; ++i) {
    const Eigen::Vector3d& s =
        sums[static_cast<std::size_t>(sky_.tile[static_cast<std::size_t>(i)])];
    const Eigen::Vector2f shared = (s.head<2>() / s[2]).cast<float>();
    equations.parts(i, 0) = weight_[i] * (derivative_[i] - lost_[i] * shared[0]);
    equations.parts(i, 1) = weight_[i] * (vertical_[i] - lost_[i] * shared[1]);
  }
  for (int row = 0; row < 2; ++row) {
    equations.information(row, 0) = (equations.parts.col(row) * derivative_).sum();
    equations.information(row, 1) = (equations.parts.col(row) * vertical_).sum();
  }
  equations.information(1, 1) += ScatteringPrior();
  return equations;
}

Eigen::Vector2d AngleFit::Step() const {
  const Equations equations = Linearize();
  if (!(equations.information(0, 0) > 0.0)) return Eigen::Vector2d::Zero();
  const Eigen::Vector2d gradient(
      (equations.parts.col(0) * values_.across).sum(),
      (equations.parts.col(1) * values_.across).sum() - ScatteringPrior() * scattering_);
  return equations.information.inverse() * gradient;
}

double AngleFit::Refine(double angle_rad, double& max_dop) {
  scattering_ = 0.0;
  for (int i = 0; i < kIterations; ++i) {
    max_dop = MaxDop(angle_rad);
    Judge(angle_rad, max_dop);
    const Eigen::Vector2d step = Step();
    const double turn = std::clamp(step[0], -kLongestStep_rad, kLongestStep_rad);
    angle_rad = WrapPi(angle_rad + turn);
    scattering_ += step[1];
    if (std::abs(turn) < kConverged_rad) break;
  }
  Judge(angle_rad, max_dop);
  return angle_rad;
}

double AngleFit::Held(double angle_rad, double max_dop, double off_rad) {
  Judge(angle_rad - off_rad, max_dop);
  const double forth = Step()[0];
  Judge(angle_rad + off_rad, max_dop);
  const double back = Step()[0];
  Judge(angle_rad, max_dop);
  return (forth - back) / (2.0 * off_rad);
}

}  // namespace polnav::nav
