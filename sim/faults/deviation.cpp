#include "sim/faults/deviation.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace polnav::sim {
namespace {

constexpr double kMilliG_m_s2 = 9.80665e-3;

using Factor = std::function<double()>;

Eigen::Vector3d Scaled(const Eigen::Vector3d& amount, const Factor& factor) {
  Eigen::Vector3d scaled = amount;
  for (double& value : scaled) value *= factor();
  return scaled;
}

// change(pixel, row, column) of each pixel, rounded and kept within full scale.
template <typename Pixel, typename Change>
cv::Mat ChangedAs(const cv::Mat& image, double full_scale, const Change& change) {
  cv::Mat changed = image.clone();
  for (int row = 0; row < image.rows; ++row) {
    auto* pixels = changed.ptr<Pixel>(row);
    for (int column = 0; column < image.cols; ++column) {
      const double value = change(static_cast<double>(pixels[column]), row, column);
      pixels[column] = static_cast<Pixel>(std::clamp(std::round(value), 0.0, full_scale));
    }
  }
  return changed;
}

template <typename Change>
cv::Mat Changed(const cv::Mat& image, double full_scale, const Change& change) {
  if (image.type() == CV_16UC1) return ChangedAs<std::uint16_t>(image, full_scale, change);
  return ChangedAs<std::uint8_t>(image, full_scale, change);
}

struct Deviator {
  const Amounts& a;
  const nav::Rig& rig;
  const Factor& factor;

  void operator()(nav::ImuSample& m) const {
    m.gyro_rad_s += nav::DegToRad(1.0) * Scaled(a.gyro_deg_s, factor);
    m.accel_m_s2 += kMilliG_m_s2 * Scaled(a.accel_mg, factor);
  }
  void operator()(nav::StereoImages& m) const {
    const auto change = [&](double value, int, int) { return value + 255.0 * a.level * factor(); };
    if (a.side != "right") m.left = Changed(m.left, 255.0, change);
    if (a.side != "left") m.right = Changed(m.right, 255.0, change);
  }
  void operator()(nav::StereoFeatures& m) const {
    for (nav::FeatureObservation& f : m.features) {
      const Eigen::Vector3d shift = Scaled(a.feature_px, factor);
      f.uv_left_px += shift.head<2>();
      if (f.u_right_px) *f.u_right_px += shift.z();
    }
  }
  void operator()(nav::PolarizationSample& m) const {
    for (int i = 0; i < 6; ++i) {
      if (a.channel != -1 && a.channel != i) continue;
      double& reading = m.channel[static_cast<std::size_t>(i)];
      reading = std::clamp(reading + a.level * factor(), 0.0, 1.0);
    }
  }
  void operator()(nav::PolarizationImage& m) const {
    const double full = FullScale(rig, m.mosaic);
    m.mosaic = Changed(m.mosaic, full, [&](double value, int row, int column) {
      const bool hit = a.channel == -1 || a.channel == 2 * (row % 2) + column % 2;
      return hit ? value + full * a.level * factor() : value;
    });
  }
  void operator()(nav::OpticalFlowSample& m) const {
    const double span_s = nav::ToSeconds(m.integration);
    m.flow_rad.x() += span_s * nav::DegToRad(a.flow_x_deg_s) * factor();
    m.flow_rad.y() += span_s * nav::DegToRad(a.flow_y_deg_s) * factor();
    m.gyro_rad += span_s * nav::DegToRad(1.0) * Scaled(a.gyro_deg_s, factor);
    const double range_shift_m = a.range_m * factor();
    if (m.range_m) m.range_m = std::max(0.0, *m.range_m + range_shift_m);
  }
  void operator()(nav::ReferencePose& m) const {
    m.T_WB.p += Scaled(a.position_m, factor);
    m.v_WB_m_s += Scaled(a.velocity_m_s, factor);
    // A heading counts clockwise, a rotation about z up counterclockwise.
    const double turn_rad = -nav::DegToRad(a.heading_deg) * factor();
    m.T_WB.q = Eigen::AngleAxisd(turn_rad, Eigen::Vector3d::UnitZ()) * m.T_WB.q;
  }
};

}  // namespace

double FullScale(const nav::Rig& rig, const cv::Mat& mosaic) {
  if (rig.polarization_camera) return std::ldexp(1.0, rig.polarization_camera->bits) - 1.0;
  return mosaic.type() == CV_16UC1 ? 65535.0 : 255.0;
}

void Deviate(const Amounts& amounts, const nav::Rig& rig, const Factor& factor,
             nav::Measurement& measurement) {
  std::visit(Deviator{amounts, rig, factor}, measurement);
}

void MultiplyNoise(double times, const nav::Rig& rig, const Factor& normal,
                   nav::Measurement& measurement) {
  const double extra = std::sqrt(times * times - 1.0);  // independent noises add by their squares
  if (auto* imu = std::get_if<nav::ImuSample>(&measurement); imu != nullptr && rig.imu) {
    // White noise of a mean over 1 / rate.
    const double root_hz = std::sqrt(rig.imu->rate_hz);
    const double gyro = extra * rig.imu->gyro_noise_rad_s_sqrt_hz * root_hz;
    const double accel = extra * rig.imu->accel_noise_m_s2_sqrt_hz * root_hz;
    imu->gyro_rad_s += Scaled(Eigen::Vector3d::Constant(gyro), normal);
    imu->accel_m_s2 += Scaled(Eigen::Vector3d::Constant(accel), normal);
    return;
  }
  auto* sky = std::get_if<nav::PolarizationImage>(&measurement);
  if (sky == nullptr || !rig.polarization_camera) {
    throw std::logic_error("MultiplyNoise: the rig does not state this sensor's noise");
  }
  const double full = FullScale(rig, sky->mosaic);
  const double electrons = rig.polarization_camera->full_well_e / full;  // a count
  const double read = rig.polarization_camera->read_noise_e;
  sky->mosaic = Changed(sky->mosaic, full, [&](double value, int, int) {
    const double sigma = std::sqrt(value * electrons + read * read) / electrons;
    return value + extra * sigma * normal();
  });
}

}  // namespace polnav::sim
