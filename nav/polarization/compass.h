// Which way is north, by one polarized picture of the sky?
//
// The estimator's sky is Rayleigh's (sky/rayleigh.h); everything else counts as error.
//   sun_W    unit vector towards the sun, ENU; without one only the solar meridian is found
//   tilt     roll and pitch of B; a neglected tilt eps turns the heading by eps tan(sun elevation)
//   axis     of the solar meridian, from B's x axis towards its y axis, mod pi: the heading is the
//            sun's compass azimuth plus this, or half a turn away
// Half a turn: a wide picture under a sun that is neither at the horizon nor overhead tells the sun
// from the opposite azimuth, since the E-vectors off the zenith lean. How much depends on the
// picture, so the reading says when it does not.
#pragma once

#include <Eigen/Core>
#include <opencv2/core/mat.hpp>
#include <optional>
#include <string>
#include <vector>

#include "nav/api/calibration.h"
#include "nav/polarization/compass_options.h"
#include "nav/polarization/instrument_errors.h"
#include "nav/polarization/sky_blocks.h"
#include "nav/polarization/stokes_blocks.h"

namespace polnav::nav {

enum class CompassStatus {
  kHeading,   // heading_rad
  kHalfTurn,  // heading_rad or its opposite: the picture does not tell
  kAxis,      // no sun was given: axis_rad only
  kNone,      // nothing; reason says why
};

enum class NoHeading {
  kNotAsked,     // there is a heading
  kSaturated,    // too few blocks below full scale
  kDark,         // too few blocks with light
  kNoSky,        // too few blocks above the lowest elevation, or that agree
  kUnpolarized,  // overcast, or no sky at all
  kDisagrees,    // polarized, but not as a sky with the sun there
  kUncertain,    // sigma above the greatest allowed
  kAmbiguous,    // several headings, not half a turn apart, fit alike
  kSunBelow,     // below the horizon
  kSunOverhead,  // too near the zenith to give a direction
};

struct CompassReading {
  CompassStatus status = CompassStatus::kNone;
  NoHeading reason = NoHeading::kNotAsked;
  double heading_rad = 0.0;    // of B's x axis, compass; valid for kHeading and kHalfTurn
  double sigma_rad = 0.0;      // of heading and axis; model errors included
  double axis_rad = 0.0;       // in (-pi/2, pi/2]; valid unless kNone
  double dop = 0.0;            // mean degree of polarization of the blocks used
  double used_fraction = 0.0;  // of the blocks in view, by weight
};

// "ok", "half turn unknown", "axis" or "no heading: why".
[[nodiscard]] std::string StatusText(const CompassReading& reading);

// For pictures of what was done.
struct CompassTrace {
  std::vector<StokesBlock> blocks;
  std::vector<float> weight;  // a block, 0 to 1
  int cols = 0;
  int rows = 0;
};

class Compass {
 public:
  // Throws std::invalid_argument on a method or picture size that there is not.
  Compass(const CompassOptions& options, const PolarizationCameraCalibration& calibration);

  // Throws std::invalid_argument when the mosaic is not as calibrated.
  [[nodiscard]] CompassReading Read(const cv::Mat& mosaic,
                                    const std::optional<Eigen::Vector3d>& sun_W,
                                    const Tilt& tilt = {}, CompassTrace* trace = nullptr) const;

 private:
  CompassOptions options_;
  BlockReader reader_;
  BlockView view_;
  InstrumentErrors instrument_;
};

}  // namespace polnav::nav
