#include "nav/polarization/polarimeter_compass.h"

#include <cmath>
#include <utility>

#include "nav/polarization/reading_errors.h"
#include "nav/polarization/six_channel.h"
#include "nav/polarization/sky_heading.h"

namespace polnav::nav {

PolarimeterCompass::PolarimeterCompass(const PolarizationOptions& options,
                                       const PolarimeterCalibration& calibration, SunModel sun,
                                       const StartPrior& start)
    : options_(options),
      calibration_(calibration),
      sun_(std::move(sun)),
      last_rad_(start.heading_rad) {}

Report PolarimeterCompass::Process(const Measurement& measurement) {
  const auto* sample = std::get_if<PolarizationSample>(&measurement);
  if (sample == nullptr) return {};
  if (newest_ && sample->stamp <= *newest_) return {.outcome = Outcome::kUnusable};  // late
  newest_ = sample->stamp;
  const auto light = UsableLight(*sample, options_);
  const auto heading = light ? HeadingFromEVector(EVectorOf(*light, calibration_),
                                                  LevelAttitude(last_rad_), sun_(sample->stamp))
                             : std::nullopt;
  if (!heading) return {.outcome = Outcome::kUnusable};
  last_rad_ = *heading;
  Estimate estimate{.stamp = sample->stamp, .T_WB = {.q = LevelAttitude(last_rad_)}};
  const double sigma_rad = std::hypot(DegToRad(options_.reading_sigma_deg), SlowSigma(options_));
  estimate.covariance(5, 5) = sigma_rad * sigma_rad;
  estimate.tracked = true;
  return {.outcome = Outcome::kUsed, .estimate = estimate};
}

}  // namespace polnav::nav
