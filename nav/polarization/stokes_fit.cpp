#include "nav/polarization/stokes_fit.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>

#include "nav/api/geometry.h"
#include "nav/polarization/angle_fit.h"
#include "nav/polarization/angle_sigma.h"

namespace polnav::nav {
namespace {

// The turn by which a fit's hold is tried: about its sigma, within floats' and small angles' reach.
constexpr double kLeastOff_rad = 1e-4;
constexpr double kMostOff_rad = 0.1;
constexpr double kApart_rad = 0.5;  // of two maxima that are two headings

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

// Blocks that are judged by how well they agree find others to agree with at another angle: the sky
// then holds the angle less than they say. An error of the instrument is alike in all of them, and
// turns the angle by as much whichever they are.
double SigmaOf(const AngleVariance& variance, double angle_rad, double max_dop, AngleFit& fit) {
  const double off_rad =
      std::clamp(std::sqrt(variance.sky + variance.instrument), kLeastOff_rad, kMostOff_rad);
  const double held = std::min(fit.Held(angle_rad, max_dop, off_rad), 1.0);
  if (!(held > 0.0)) return std::numeric_limits<double>::infinity();
  return std::sqrt(variance.sky / (held * held) + variance.instrument);
}

}  // namespace

StokesFit FitStokes(const CompassOptions& options, const SkyBlocks& sky, const Tiles& tiles,
                    double sun_elevation_rad, const InstrumentErrors& instrument) {
  AngleFit fit(options, sky, tiles, sun_elevation_rad);
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
  result.sigma_rad = SigmaOf(VarianceOf(options, sky, tiles, fit, result.angle_rad, instrument),
                             result.angle_rad, result.max_dop, fit);
  const Eigen::ArrayXf dop = (sky.q.square() + sky.u.square()).sqrt();
  result.agreement = fit.values().along.sum() / std::max(dop.sum(), 1e-6F);
  const Eigen::ArrayXf weight = fit.Weight();
  result.dop = (weight * dop).sum() / weight.sum();
  result.used_fraction = fit.Clear() / static_cast<float>(std::max(sky.in_view, 1));
  result.weight.assign(weight.data(), weight.data() + weight.size());
  return result;
}

}  // namespace polnav::nav
