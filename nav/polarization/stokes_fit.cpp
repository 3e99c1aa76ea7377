#include "nav/polarization/stokes_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "nav/api/geometry.h"

namespace polnav::nav {
namespace {

constexpr int kCoarseAngles = 72;
constexpr int kIterations = 10;
constexpr double kConverged_rad = 1e-5;
constexpr double kLongestStep_rad = 0.1;
constexpr double kApart_rad = 0.5;       // of two maxima that are two headings
constexpr float kWorthAsking = 0.2F;     // of the pattern: below, its polarization says little
constexpr double kClearQuantile = 0.90;  // of the blocks, by polarization over the pattern's
constexpr float kCauchy2 = 4.0F;         // square of where residuals begin to count less, in sigmas
constexpr double kIndependent = 20.0;    // blocks that a picture is worth: neighbours err alike
constexpr double kScatteringSigma = 0.1;  // of light scattered many times, over all light
constexpr double kMisfit = 0.9;           // of residuals, that may be the angle's error

class Fit {
 public:
  Fit(const CompassOptions& options, const SkyBlocks& sky, const Tiles& tiles,
      double sun_elevation_rad)
      : options_(options), sky_(sky), tiles_(tiles), pattern_(sky, sun_elevation_rad) {}

  // Angles at which pattern and picture agree best: maxima of their correlation.
  [[nodiscard]] std::vector<double> CoarseAngles();
  // A clear sky's greatest polarization, as the picture has it.
  [[nodiscard]] double MaxDop(double angle_rad);
  // What each block is worth at an angle, given a clear sky's polarization.
  void Judge(double angle_rad, double max_dop);
  // Returns the angle.
  [[nodiscard]] double Refine(double angle_rad, double& max_dop);
  // Of the angle of the last judgement.
  [[nodiscard]] double Variance(double angle_rad, const InstrumentSpread& spread) const;
  // Negative log-likelihood of a block, at the angle of the last judgement.
  [[nodiscard]] Eigen::ArrayXf Cost() const {
    return 0.5F * variance_.log() +
           0.5F * kCauchy2 * (1.0F + values_.across.square() / (kCauchy2 * variance_)).log();
  }
  // Blocks that have at least half of a clear sky's polarization, and agree.
  [[nodiscard]] double Clear() const {
    return static_cast<double>(
        (lost_ < 0.5F && values_.across.square() < kCauchy2 * variance_).count());
  }
  // From 0 to 1.
  [[nodiscard]] Eigen::ArrayXf Weight() const { return weight_ / weight_.maxCoeff(); }
  [[nodiscard]] const RayleighPattern::Values& values() const { return values_; }
  // Of the light scattered many times; belongs to an angle.
  [[nodiscard]] double scattering() const { return scattering_; }
  void set_scattering(double amplitude) { scattering_ = amplitude; }

 private:
  // Of angle and scattering, the patches' other light eliminated: information, and each block's
  // part in the gradient's two rows.
  struct Equations {
    Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
    Eigen::Array<float, Eigen::Dynamic, 2> parts;
  };
  [[nodiscard]] Equations Linearize() const;
  // Information about the scattering beforehand, in the blocks' own count.
  [[nodiscard]] double ScatteringPrior() const {
    return static_cast<double>(sky_.size()) / kIndependent / (kScatteringSigma * kScatteringSigma);
  }

  static double AngleOf(int k) { return 2.0 * std::numbers::pi * k / kCoarseAngles; }
  const CompassOptions& options_;
  const SkyBlocks& sky_;
  const Tiles& tiles_;
  RayleighPattern pattern_;
  RayleighPattern::Values values_;
  double scattering_ = 0.0;
  Eigen::ArrayXf vertical_;    // residual of a unit of it
  Eigen::ArrayXf lost_;        // share of a clear sky's polarization that is missing
  Eigen::ArrayXf variance_;    // of a residual
  Eigen::ArrayXf weight_;      // one over it, less for outliers
  Eigen::ArrayXf derivative_;  // of minus the residual by the angle
};

std::vector<double> Fit::CoarseAngles() {
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

double Fit::MaxDop(double angle_rad) {
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

void Fit::Judge(double angle_rad, double max_dop) {
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

Fit::Equations Fit::Linearize() const {
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

double Fit::Refine(double angle_rad, double& max_dop) {
  scattering_ = 0.0;
  for (int i = 0; i < kIterations; ++i) {
    max_dop = MaxDop(angle_rad);
    Judge(angle_rad, max_dop);
    const Equations equations = Linearize();
    if (!(equations.information(0, 0) > 0.0)) return angle_rad;
    const Eigen::Vector2d gradient(
        (equations.parts.col(0) * values_.across).sum(),
        (equations.parts.col(1) * values_.across).sum() - ScatteringPrior() * scattering_);
    const Eigen::Vector2d step = equations.information.inverse() * gradient;
    const double turn = std::clamp(step[0], -kLongestStep_rad, kLongestStep_rad);
    angle_rad = WrapPi(angle_rad + turn);
    scattering_ += step[1];
    if (std::abs(turn) < kConverged_rad) break;
  }
  Judge(angle_rad, max_dop);
  return angle_rad;
}

double Fit::Variance(double angle_rad, const InstrumentSpread& spread) const {
  const Equations equations = Linearize();
  const Eigen::Matrix2d inverse = equations.information.inverse();
  if (!(inverse(0, 0) > 0.0)) return std::numeric_limits<double>::infinity();
  // What each block's residual does to the angle.
  const Eigen::ArrayXf pull = equations.parts.col(0) * static_cast<float>(inverse(0, 0)) +
                              equations.parts.col(1) * static_cast<float>(inverse(0, 1));
  Eigen::VectorXd patch = Eigen::VectorXd::Zero(tiles_.likeness.rows());
  Eigen::VectorXd blocks = patch;
  Eigen::VectorXd seen = patch;  // squares of what blocks of a patch do
  for (Eigen::Index i = 0; i < sky_.size(); ++i) {
    const int t = sky_.tile[static_cast<std::size_t>(i)];
    patch[t] += pull[i];
    blocks[t] += 1.0;
    seen[t] += std::pow(pull[i] * values_.across[i], 2);
  }
  // Clouds light the gaps too, the more of them there are.
  const double hidden = 1.0 - Clear() / static_cast<double>(std::max(sky_.in_view, 1));
  const double believed =
      patch.dot(tiles_.likeness * patch) *
      (std::pow(options_.pattern_sigma, 2) + std::pow(options_.gap_light_dop * hidden, 2));
  // Where no sky is clear, cloud is taken for it: residuals, as if alike over a patch, tell.
  const double model = std::max(believed, std::pow(kMisfit * hidden, 2) * blocks.dot(seen));
  // A constant q and u of the sensor, and a constant Q and U.
  const auto by_constant = [&](const Eigen::ArrayXf& part) {
    return std::pow((part * values_.my).sum(), 2) + std::pow((part * values_.mx).sum(), 2);
  };
  const double sensor = spread.stokes * spread.stokes * by_constant(pull) +
                        spread.dark * spread.dark * by_constant(pull / sky_.intensity);
  const auto by_tilt = [&](const Eigen::Vector3d& axis) {
    return std::pow((pull * pattern_.TurnAbout(axis, angle_rad) * values_.along).sum(), 2);
  };
  const double tilt = spread.tilt_rad * spread.tilt_rad *
                      (by_tilt(Eigen::Vector3d::UnitX()) + by_tilt(Eigen::Vector3d::UnitY()));
  return model + sensor + tilt + spread.turn_rad * spread.turn_rad;
}

// Log-likelihood of one angle over another: means over tiles, of which only as many count as there
// are correlation lengths in the picture.
double Evidence(const SkyBlocks& sky, const Eigen::ArrayXf& cost, const Eigen::ArrayXf& rival,
                const Eigen::MatrixXd& tile_likeness) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(tile_likeness.rows());
  Eigen::VectorXd count = Eigen::VectorXd::Zero(tile_likeness.rows());
  for (Eigen::Index i = 0; i < sky.size(); ++i) {
    const int tile = sky.tile[static_cast<std::size_t>(i)];
    sum[tile] += rival[i] - cost[i];
    count[tile] += 1.0;
  }
  double evidence = 0.0;
  for (Eigen::Index t = 0; t < sum.size(); ++t) {
    if (count[t] > 0.0) evidence += sum[t] / count[t] / tile_likeness.row(t).sum();
  }
  return evidence;
}

}  // namespace

StokesFit FitStokes(const CompassOptions& options, const SkyBlocks& sky, const Tiles& tiles,
                    double sun_elevation_rad, const InstrumentSpread& spread) {
  Fit fit(options, sky, tiles, sun_elevation_rad);
  struct Candidate {
    double angle_rad;
    double max_dop;
    double scattering;
  };
  std::vector<Candidate> candidates;
  double max_dop = 0.0;
  for (const double start : fit.CoarseAngles()) {
    Candidate candidate{};
    candidate.angle_rad = fit.Refine(start, candidate.max_dop);
    candidate.scattering = fit.scattering();
    candidates.push_back(candidate);
    max_dop = std::max(max_dop, candidate.max_dop);
  }
  // All are judged against one clear sky.
  std::size_t best = 0;
  std::vector<Eigen::ArrayXf> costs;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    fit.set_scattering(candidates[i].scattering);
    fit.Judge(candidates[i].angle_rad, max_dop);
    costs.push_back(fit.Cost());
    if (costs[i].sum() < costs[best].sum()) best = i;
  }
  StokesFit result{.angle_rad = candidates[best].angle_rad,
                   .max_dop = candidates[best].max_dop,
                   .cost = costs[best].sum()};
  result.evidence = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const double apart = WrapPi(candidates[i].angle_rad - result.angle_rad);
    if (std::abs(apart) < kApart_rad) continue;
    const double evidence = Evidence(sky, costs[best], costs[i], tiles.likeness);
    if (evidence < result.evidence) {
      result.evidence = evidence;
      result.rival_rad = apart;
    }
  }
  fit.set_scattering(candidates[best].scattering);
  fit.Judge(result.angle_rad, result.max_dop);
  result.sigma_rad = std::sqrt(fit.Variance(result.angle_rad, spread));
  const Eigen::ArrayXf dop = (sky.q.square() + sky.u.square()).sqrt();
  result.agreement = fit.values().along.sum() / std::max(dop.sum(), 1e-6F);
  const Eigen::ArrayXf weight = fit.Weight();
  result.dop = (weight * dop).sum() / weight.sum();
  result.used_fraction = fit.Clear() / static_cast<float>(std::max(sky.in_view, 1));
  result.weight.assign(weight.data(), weight.data() + weight.size());
  return result;
}

}  // namespace polnav::nav
