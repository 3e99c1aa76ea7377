// What would the front end have made of the pictures that measurement level does not draw?
//
// The simulator says where true cameras see points; the estimators are told what that means by the
// nominal calibration, as nav/stereo/tracker.h tells them.
#pragma once

#include "nav/api/measurements.h"
#include "nav/stereo/options.h"
#include "nav/stereo/rectifier.h"
#include "sim/sensors/feature_camera.h"

namespace polnav::testbed {

class SightingsRectifier {
 public:
  // describe: with descriptors, which loop closing needs and nothing else.
  SightingsRectifier(const nav::TrackerOptions& options, const nav::StereoCalibration& nominal,
                     bool describe)
      : options_(options), rectifier_(nominal), describe_(describe) {}

  // A right sighting that is off its row or nearer than the front end searches is no match.
  [[nodiscard]] nav::StereoFeatures Rectify(const sim::FeatureSightings& seen) const;

 private:
  nav::TrackerOptions options_;
  nav::StereoRectifier rectifier_;
  bool describe_;
};

// False: a stamp that is not after the newest one's, or the newest features to the last bit, which
// noise forbids: a frozen driver. Nothing seen twice is no such thing.
[[nodiscard]] bool IsNews(const nav::StereoFeatures& features, const nav::StereoFeatures& newest);

}  // namespace polnav::testbed
