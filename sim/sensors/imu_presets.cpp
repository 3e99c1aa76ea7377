// Figures with their sources, and which of them are our choice: docs/imu.md.
#include <stdexcept>

#include "sim/sensors/imu_options.h"

namespace polnav::sim {
namespace {

ImuOptions Icm20602() {
  ImuOptions o;
  o.gyro_noise_deg_s_sqrt_hz = 0.004;
  o.gyro_bias_sigma_deg_s = 1.0;
  o.gyro_bias_instability_deg_h = 8.0;
  o.gyro_bias_walk_deg_s_sqrt_s = 3.8e-5;
  o.gyro_scale_sigma = 0.01;
  o.gyro_g_sensitivity_deg_s_g = 0.1;
  o.gyro_temperature_bias_deg_s_k = 0.01;
  o.gyro_temperature_scale_1_k = 1.6e-4;
  o.gyro_range_deg_s = 500.0;
  o.gyro_resolution_deg_s = 1.0 / 65.5;
  o.accel_noise_mg_sqrt_hz = 0.1;
  o.accel_bias_sigma_mg = 40.0;
  o.accel_bias_instability_mg = 0.05;
  o.accel_bias_walk_mg_sqrt_s = 8.7e-4;
  o.accel_scale_sigma = 0.01;
  o.accel_temperature_bias_mg_k = 0.5;
  o.accel_temperature_scale_1_k = 1.2e-4;
  o.accel_range_g = 4.0;
  o.accel_resolution_mg = 1000.0 / 8192.0;
  o.misalignment_sigma_deg = 0.5;
  return o;
}

ImuOptions SpanCpt() {
  ImuOptions o;
  o.gyro_noise_deg_s_sqrt_hz = 0.0667 / 60.0;
  o.gyro_bias_sigma_deg_s = 3.0 / 3600.0;
  o.gyro_bias_instability_deg_h = 0.25;
  o.gyro_bias_walk_deg_s_sqrt_s = 2.4e-6;
  o.gyro_scale_sigma = 0.0015;
  o.gyro_g_sensitivity_deg_s_g = 0.0;  // light has no mass to speak of
  o.gyro_temperature_bias_deg_s_k = 5e-5;
  o.gyro_temperature_scale_1_k = 1e-5;
  o.gyro_range_deg_s = 375.0;
  o.gyro_resolution_deg_s = 6.217e-4;
  o.accel_noise_mg_sqrt_hz = 0.055;
  o.accel_bias_sigma_mg = 0.75;
  o.accel_bias_instability_mg = 0.025;
  o.accel_bias_walk_mg_sqrt_s = 4e-3;
  o.accel_scale_sigma = 0.004;
  o.accel_temperature_bias_mg_k = 0.5;
  o.accel_temperature_scale_1_k = 2e-5;
  o.accel_range_g = 10.0;
  o.accel_resolution_mg = 0.01556;
  o.misalignment_sigma_deg = 0.05;
  return o;
}

ImuOptions Hg4930() {
  ImuOptions o;
  o.gyro_noise_deg_s_sqrt_hz = 0.04 / 60.0;
  o.gyro_bias_sigma_deg_s = 7.0 / 3600.0;
  o.gyro_bias_instability_deg_h = 0.25;
  o.gyro_bias_walk_deg_s_sqrt_s = 3.8e-7;
  o.gyro_scale_sigma = 0.0003;
  o.gyro_g_sensitivity_deg_s_g = 0.001;
  o.gyro_temperature_bias_deg_s_k = 1e-5;
  o.gyro_temperature_scale_1_k = 5e-6;
  o.gyro_range_deg_s = 400.0;
  o.gyro_resolution_deg_s = 0.0;
  o.accel_noise_mg_sqrt_hz = 0.051;
  o.accel_bias_sigma_mg = 1.7;
  o.accel_bias_instability_mg = 0.025;
  o.accel_bias_walk_mg_sqrt_s = 1.4e-4;
  o.accel_scale_sigma = 0.0005;
  o.accel_temperature_bias_mg_k = 0.02;
  o.accel_temperature_scale_1_k = 5e-6;
  o.accel_range_g = 20.0;
  o.accel_resolution_mg = 0.0;
  o.misalignment_sigma_deg = 0.02;
  return o;
}

ImuOptions Perfect() {
  ImuOptions o;
  o.gyro_noise_deg_s_sqrt_hz = o.gyro_bias_sigma_deg_s = o.gyro_bias_instability_deg_h = 0.0;
  o.gyro_bias_walk_deg_s_sqrt_s = o.gyro_scale_sigma = o.gyro_g_sensitivity_deg_s_g = 0.0;
  o.gyro_temperature_bias_deg_s_k = o.gyro_temperature_scale_1_k = o.gyro_resolution_deg_s = 0.0;
  o.gyro_range_deg_s = 1e5;
  o.accel_noise_mg_sqrt_hz = o.accel_bias_sigma_mg = o.accel_bias_instability_mg = 0.0;
  o.accel_bias_walk_mg_sqrt_s = o.accel_scale_sigma = o.accel_temperature_bias_mg_k = 0.0;
  o.accel_temperature_scale_1_k = o.accel_resolution_mg = 0.0;
  o.accel_range_g = 1e4;
  o.misalignment_sigma_deg = 0.0;
  return o;
}

ImuOptions FindPreset(const std::string& name) {
  if (name == "adis16475_2") return {};
  if (name == "icm20602") return Icm20602();
  if (name == "span_cpt") return SpanCpt();
  if (name == "hg4930") return Hg4930();
  if (name == "perfect") return Perfect();
  throw std::logic_error("ImuPreset: there is no preset " + name);
}

}  // namespace

ImuOptions ImuPreset(const std::string& name) {
  ImuOptions options = FindPreset(name);
  options.preset = name;
  return options;
}

}  // namespace polnav::sim
