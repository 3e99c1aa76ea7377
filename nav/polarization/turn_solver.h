// Which errors of the camera explain the pictures of a turn?
//
// Robust least squares (Ceres) over all blocks' residuals (turn_residual.h), each error with the
// given calibration's sigma as prior; headings that nobody stated are solved for along with them.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "nav/api/calibration.h"
#include "nav/polarization/compass_options.h"
#include "nav/polarization/stokes_blocks.h"
#include "nav/polarization/turn_residual.h"

namespace polnav::nav {

struct TurnView {
  std::vector<ChannelBlock> channels;
  double sun_azimuth_rad = 0.0;
  double sun_elevation_rad = 0.0;
  double heading_rad = 0.0;  // as the compass reads it
  std::optional<double> stated_rad;
};

// Of the camera, less what was given.
struct TurnErrors {
  std::array<double, 12> instrument{};
  std::array<double, 6> view{};  // mounting, lens
  double scattering = 0.0;       // of the sky of the turn: not the camera's
};

class TurnSolver {
 public:
  TurnSolver(const CompassOptions& options, const PolarizationCameraCalibration& given)
      : options_(options),
        given_(given),
        reader_(given, BlockSizeFor(given.width_px, given.height_px), options.saturation) {}

  [[nodiscard]] const BlockReader& reader() const { return reader_; }
  // Of every third block each way.
  [[nodiscard]] std::vector<TurnResidual> ResidualsOf(const TurnView& view) const;
  // Throws std::invalid_argument when the views do not fix the camera. covariance: of what is left,
  // when asked for; by patches of sky, each alike in all pictures (mirror_patches.h).
  [[nodiscard]] TurnErrors Solve(const std::vector<TurnView>& views,
                                 InstrumentCovariance* covariance) const;

 private:
  CompassOptions options_;
  PolarizationCameraCalibration given_;
  BlockReader reader_;
};

}  // namespace polnav::nav
