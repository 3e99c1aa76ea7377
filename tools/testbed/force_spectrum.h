// How does the vehicle shake its accelerometers? Amplitudes over frequency, for the report.
//
// Of the specific force up and ahead (B's z and x). The run is cut into stretches of some ten
// seconds that overlap by half, less their means and faded at both ends (Hann); what is kept is the
// root of their mean power [Welch1967], scaled so that a sine reads its amplitude [m/s^2]. Gaps and
// readings that are no numbers begin a new stretch. No more memory than two stretches, however long
// the run. A line between two frequencies reads up to 15 % low.
#pragma once

#include <optional>
#include <vector>

#include "nav/api/calibration.h"
#include "nav/api/measurements.h"

namespace polnav::testbed {

// Entry i is at i * step_hz.
struct ForceLines {
  double step_hz = 0.0;
  std::vector<double> up_m_s2;
  std::vector<double> ahead_m_s2;
};

class ForceSpectrum {
 public:
  explicit ForceSpectrum(const nav::ImuCalibration& imu);

  void Add(const nav::ImuSample& sample);

  // Nothing before a whole stretch.
  [[nodiscard]] std::optional<ForceLines> Lines() const;

 private:
  struct Axis {
    std::vector<double> samples;
    std::vector<double> power;  // summed over the stretches
  };
  void TakeStretch(Axis& axis) const;
  [[nodiscard]] std::vector<double> AmplitudesOf(const Axis& axis) const;

  nav::ImuCalibration imu_;
  std::size_t size_;  // of a stretch
  std::vector<double> fade_;
  Axis up_;
  Axis ahead_;
  std::size_t stretches_ = 0;
  nav::TimeNs last_ = 0;
};

}  // namespace polnav::testbed
