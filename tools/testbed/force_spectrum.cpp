#include "tools/testbed/force_spectrum.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <opencv2/core.hpp>

namespace polnav::testbed {
namespace {

constexpr double kStretch_s = 10.0;
constexpr double kGap = 1.5;  // intervals of the IMU

// The power of two nearest to a stretch.
std::size_t SizeOf(double rate_hz) {
  const double exponent = std::round(std::log2(std::max(kStretch_s * rate_hz, 1.0)));
  return std::size_t{1} << static_cast<unsigned>(std::clamp(exponent, 4.0, 20.0));
}

}  // namespace

ForceSpectrum::ForceSpectrum(const nav::ImuCalibration& imu)
    : imu_(imu), size_(SizeOf(imu.rate_hz)), fade_(size_) {
  for (std::size_t i = 0; i < size_; ++i) {
    const double turn = static_cast<double>(i) / static_cast<double>(size_);
    fade_[i] = 0.5 - 0.5 * std::cos(2.0 * std::numbers::pi * turn);
  }
  for (Axis* axis : {&up_, &ahead_}) {
    axis->samples.reserve(size_);
    axis->power.assign(size_ / 2 + 1, 0.0);
  }
}

void ForceSpectrum::Add(const nav::ImuSample& sample) {
  const Eigen::Vector3d force_B = imu_.T_BI.q * sample.accel_m_s2;
  const bool gap = nav::ToSeconds(sample.stamp - last_) * imu_.rate_hz > kGap;
  last_ = sample.stamp;
  if (gap || !force_B.allFinite()) {
    up_.samples.clear();
    ahead_.samples.clear();
  }
  if (!force_B.allFinite()) return;
  up_.samples.push_back(force_B.z());
  ahead_.samples.push_back(force_B.x());
  if (up_.samples.size() < size_) return;
  TakeStretch(up_);
  TakeStretch(ahead_);
  ++stretches_;
}

// The second half begins the next.
void ForceSpectrum::TakeStretch(Axis& axis) const {
  const double mean =
      std::accumulate(axis.samples.begin(), axis.samples.end(), 0.0) / static_cast<double>(size_);
  std::vector<double> faded(size_);
  for (std::size_t i = 0; i < size_; ++i) faded[i] = fade_[i] * (axis.samples[i] - mean);
  std::vector<cv::Vec2d> spectrum;
  cv::dft(faded, spectrum, cv::DFT_COMPLEX_OUTPUT);
  for (std::size_t k = 0; k < axis.power.size(); ++k) {
    axis.power[k] += spectrum[k].dot(spectrum[k]);
  }
  axis.samples.erase(axis.samples.begin(),
                     axis.samples.begin() + static_cast<std::ptrdiff_t>(size_ / 2));
}

std::vector<double> ForceSpectrum::AmplitudesOf(const Axis& axis) const {
  const double gain = std::accumulate(fade_.begin(), fade_.end(), 0.0) / 2.0;
  std::vector<double> amplitudes;
  amplitudes.reserve(axis.power.size());
  for (const double power : axis.power) {
    amplitudes.push_back(std::sqrt(power / static_cast<double>(stretches_)) / gain);
  }
  return amplitudes;
}

std::optional<ForceLines> ForceSpectrum::Lines() const {
  if (stretches_ == 0) return std::nullopt;
  return ForceLines{.step_hz = imu_.rate_hz / static_cast<double>(size_),
                    .up_m_s2 = AmplitudesOf(up_),
                    .ahead_m_s2 = AmplitudesOf(ahead_)};
}

}  // namespace polnav::testbed
