#include "nav/polarization/compass.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "nav/polarization/meridian_fit.h"
#include "nav/polarization/paper_methods.h"
#include "nav/polarization/stokes_fit.h"

namespace polnav::nav {
namespace {

constexpr double kOverhead_rad = 0.02;   // of the zenith: a sun there has no azimuth to speak of
constexpr double kMeanOfLeastDop = 0.5;  // of min_dop: the least mean by weight
constexpr double kPaperLeastDop = 0.02;
constexpr double kHalfTurnWithin_rad = 0.6;  // of half a turn: the rival is the same meridian's

StokesFit FromPaper(const PaperFit& paper, const SkyBlocks& sky) {
  StokesFit fit{.angle_rad = paper.angle_rad, .sigma_rad = paper.sigma_rad, .agreement = 1.0};
  int used = 0;
  for (Eigen::Index i = 0; i < sky.size(); ++i) {
    const bool is_used = paper.used[static_cast<std::size_t>(i)];
    fit.weight.push_back(is_used ? 1.0F : 0.0F);
    if (!is_used) continue;
    ++used;
    fit.dop += std::hypot(sky.q[i], sky.u[i]);
  }
  fit.dop /= std::max(used, 1);
  fit.max_dop = fit.dop;
  fit.used_fraction = static_cast<double>(used) / std::max(sky.in_view, 1);
  return fit;
}

std::optional<StokesFit> Solve(const CompassOptions& options, const InstrumentErrors& instrument,
                               const BlockView& view, const SkyBlocks& sky,
                               std::optional<double> elevation_rad) {
  std::optional<PaperFit> paper;
  if (options.method == "stokes") {
    if (elevation_rad) {
      return FitStokes(options, sky, view.tiles(), *elevation_rad, instrument);
    }
    const auto meridian = FitMeridian(options, sky, view.tiles(), instrument);
    return meridian ? std::optional(meridian->fit) : std::nullopt;
  }
  if (options.method == "lsq") paper = FitLeastSquares(sky, elevation_rad);
  if (options.method == "ransac_tls") paper = FitRansacTls(options, sky, elevation_rad);
  if (options.method == "zenith") paper = ReadZenith(options, sky, elevation_rad);
  return paper ? std::optional(FromPaper(*paper, sky)) : std::nullopt;
}

// Why a solution is none.
NoHeading Refusal(const CompassOptions& options, const StokesFit& fit) {
  // The papers' methods read clouds too; they refuse only what has no polarization at all.
  const double least = options.method == "stokes" ? options.min_dop : kPaperLeastDop;
  if (fit.max_dop < least || fit.dop < kMeanOfLeastDop * least) return NoHeading::kUnpolarized;
  if (fit.agreement < options.min_agreement) return NoHeading::kDisagrees;
  if (fit.used_fraction < options.min_used_fraction && options.method != "zenith") {
    return NoHeading::kNoSky;
  }
  if (!(fit.sigma_rad < DegToRad(options.max_sigma_deg))) return NoHeading::kUncertain;
  return NoHeading::kNotAsked;
}

CompassStatus StatusOf(const CompassOptions& options, const StokesFit& fit, bool has_sun,
                       NoHeading& reason) {
  if (!has_sun) return CompassStatus::kAxis;
  // The papers' equations give both headings [Fan2020, eq. 19].
  if (options.method != "stokes") return CompassStatus::kHalfTurn;
  if (fit.evidence > options.half_turn_evidence) return CompassStatus::kHeading;
  if (std::numbers::pi - std::abs(fit.rival_rad) < kHalfTurnWithin_rad) {
    return CompassStatus::kHalfTurn;
  }
  reason = NoHeading::kAmbiguous;
  return CompassStatus::kNone;
}

NoHeading WhyTooFew(const SkyBlocks& sky) {
  if (sky.saturated > sky.dark && 2 * sky.saturated > sky.in_view) return NoHeading::kSaturated;
  if (2 * sky.dark > sky.in_view) return NoHeading::kDark;
  return NoHeading::kNoSky;
}

const char* Why(NoHeading reason) {
  switch (reason) {
    case NoHeading::kNotAsked:
      return "";
    case NoHeading::kSaturated:
      return "saturated";
    case NoHeading::kDark:
      return "too dark";
    case NoHeading::kNoSky:
      return "too little sky";
    case NoHeading::kUnpolarized:
      return "unpolarized";
    case NoHeading::kDisagrees:
      return "not the pattern of a sky";
    case NoHeading::kUncertain:
      return "uncertain";
    case NoHeading::kAmbiguous:
      return "ambiguous";
    case NoHeading::kSunBelow:
      return "sun below the horizon";
    case NoHeading::kSunOverhead:
      return "sun overhead";
  }
  return "";
}

}  // namespace

std::string StatusText(const CompassReading& reading) {
  switch (reading.status) {
    case CompassStatus::kHeading:
      return "ok";
    case CompassStatus::kHalfTurn:
      return "half turn unknown";
    case CompassStatus::kAxis:
      return "axis";
    case CompassStatus::kNone:
      break;
  }
  return std::string("no heading: ") + Why(reading.reason);
}

Compass::Compass(const CompassOptions& options, const PolarizationCameraCalibration& calibration)
    : options_(options),
      reader_(calibration, BlockSizeFor(calibration.width_px, calibration.height_px),
              options.saturation),
      view_(options, calibration, reader_),
      instrument_(ErrorsOf(calibration, reader_, DegToRad(options.tilt_sigma_deg))) {
  if (options.method != "zenith" && options.method != "lsq" && options.method != "ransac_tls" &&
      options.method != "stokes") {
    throw std::invalid_argument("compass method '" + options.method +
                                "': known are zenith, lsq, ransac_tls, stokes");
  }
}

CompassReading Compass::Read(const cv::Mat& mosaic, const std::optional<Eigen::Vector3d>& sun_W,
                             const Tilt& tilt, CompassTrace* trace) const {
  const std::vector<StokesBlock> blocks = reader_.Read(mosaic);
  const SkyBlocks sky = view_.Select(blocks, tilt);
  if (trace != nullptr) {
    *trace = {.blocks = blocks,
              .weight = std::vector<float>(blocks.size(), 0.0F),
              .cols = reader_.cols(),
              .rows = reader_.rows()};
  }
  CompassReading reading;
  const auto none = [&reading](NoHeading reason) {
    reading.status = CompassStatus::kNone;
    reading.reason = reason;
    return reading;
  };
  std::optional<double> elevation_rad;
  if (sun_W) {
    elevation_rad = std::atan2(sun_W->z(), sun_W->head<2>().norm());
    if (*elevation_rad < 0.0) return none(NoHeading::kSunBelow);
    if (*elevation_rad > 0.5 * std::numbers::pi - kOverhead_rad)
      return none(NoHeading::kSunOverhead);
  }
  if (static_cast<double>(sky.size()) <= std::max(8.0, options_.min_used_fraction * sky.in_view)) {
    return none(WhyTooFew(sky));
  }
  const std::optional<StokesFit> fit = Solve(options_, instrument_, view_, sky, elevation_rad);
  if (!fit) return none(NoHeading::kNoSky);
  if (trace != nullptr) {
    for (std::size_t i = 0; i < sky.index.size(); ++i) {
      trace->weight[static_cast<std::size_t>(sky.index[i])] = fit->weight[i];
    }
  }
  reading.dop = fit->dop;
  reading.used_fraction = fit->used_fraction;
  reading.sigma_rad = fit->sigma_rad;
  const NoHeading refusal = Refusal(options_, *fit);
  if (refusal != NoHeading::kNotAsked) return none(refusal);
  reading.status = StatusOf(options_, *fit, sun_W.has_value(), reading.reason);
  reading.axis_rad = WrapHalfPi(fit->angle_rad);
  if (reading.status == CompassStatus::kHalfTurn && options_.method == "stokes") {
    // Off the zenith the two do not lie quite half a turn apart: the axis is either's.
    reading.sigma_rad = std::hypot(reading.sigma_rad, WrapHalfPi(fit->rival_rad));
  }
  if (sun_W) reading.heading_rad = WrapPi(std::atan2(sun_W->x(), sun_W->y()) + fit->angle_rad);
  return reading;
}

}  // namespace polnav::nav
