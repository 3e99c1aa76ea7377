// At which angle does the sun stand, and what is each block worth in saying so?
//
// The estimation of stokes_fit.h from one starting angle: blocks are judged at an angle, and the
// angle follows from the blocks so judged, in turn. Angles, residuals and the pattern's parts are
// those of rayleigh_pattern.h.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "nav/polarization/compass_options.h"
#include "nav/polarization/rayleigh_pattern.h"
#include "nav/polarization/sky_blocks.h"

namespace polnav::nav {

class AngleFit {
 public:
  AngleFit(const CompassOptions& options, const SkyBlocks& sky, const Tiles& tiles,
           double sun_elevation_rad)
      : options_(options), sky_(sky), tiles_(tiles), pattern_(sky, sun_elevation_rad) {}

  // Angles at which pattern and picture agree best: maxima of their correlation.
  [[nodiscard]] std::vector<double> CoarseAngles();
  // What each block is worth at an angle, given a clear sky's greatest polarization.
  void Judge(double angle_rad, double max_dop);
  // Returns the angle; max_dop as the picture has it there.
  [[nodiscard]] double Refine(double angle_rad, double& max_dop);

  // Share of a small turn that one step from there takes back, blocks being judged anew: 1 where
  // they judge alike. Blocks that judge each other by how well they agree, and find others to agree
  // with at each angle, hold none. Judges at the angle in the end.
  [[nodiscard]] double Held(double angle_rad, double max_dop, double off_rad);

  // At the angle of the last judgement:
  // Of angle and scattering, the patches' other light eliminated: information, and each block's
  // part in the gradient's two rows.
  struct Equations {
    Eigen::Matrix2d information = Eigen::Matrix2d::Zero();
    Eigen::Array<float, Eigen::Dynamic, 2> parts;
  };
  [[nodiscard]] Equations Linearize() const;
  // Negative log-likelihood of a block.
  [[nodiscard]] Eigen::ArrayXf Cost() const;
  // Blocks that have at least half of a clear sky's polarization, and agree.
  [[nodiscard]] double Clear() const;
  // From 0 to 1.
  [[nodiscard]] Eigen::ArrayXf Weight() const { return weight_ / weight_.maxCoeff(); }
  [[nodiscard]] const RayleighPattern::Values& values() const { return values_; }
  [[nodiscard]] const RayleighPattern& pattern() const { return pattern_; }
  // Of the light scattered many times; belongs to an angle.
  [[nodiscard]] double scattering() const { return scattering_; }
  void set_scattering(double amplitude) { scattering_ = amplitude; }

 private:
  // Of Gauss-Newton: angle and scattering.
  [[nodiscard]] Eigen::Vector2d Step() const;
  [[nodiscard]] double MaxDop(double angle_rad);
  // Information about the scattering beforehand, in the blocks' own count.
  [[nodiscard]] double ScatteringPrior() const;

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

}  // namespace polnav::nav
