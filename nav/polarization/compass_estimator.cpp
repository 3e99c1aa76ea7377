#include "nav/polarization/compass_estimator.h"

#include <utility>

namespace polnav::nav {

CompassEstimator::CompassEstimator(const CompassOptions& options,
                                   const PolarizationCameraCalibration& calibration, SunModel sun,
                                   const StartPrior& start)
    : compass_(options, calibration), sun_(std::move(sun)), last_rad_(start.heading_rad) {}

Report CompassEstimator::Process(const Measurement& measurement) {
  const auto* picture = std::get_if<PolarizationImage>(&measurement);
  if (picture == nullptr) return {};
  if (newest_ && picture->stamp <= *newest_) return {.outcome = Outcome::kUnusable};  // late
  newest_ = picture->stamp;
  const CompassReading reading = compass_.Read(picture->mosaic, sun_(picture->stamp));
  if (reading.status != CompassStatus::kHeading && reading.status != CompassStatus::kHalfTurn) {
    return {.outcome = Outcome::kUnusable};
  }
  double heading_rad = reading.heading_rad;
  if (reading.status == CompassStatus::kHalfTurn) {
    heading_rad = last_rad_ + WrapHalfPi(heading_rad - last_rad_);
  }
  last_rad_ = WrapPi(heading_rad);
  Estimate estimate{.stamp = picture->stamp, .T_WB = {.q = LevelAttitude(last_rad_)}};
  estimate.covariance(5, 5) = reading.sigma_rad * reading.sigma_rad;
  estimate.tracked = true;
  return {.outcome = Outcome::kUsed, .estimate = estimate};
}

}  // namespace polnav::nav
