#include "tools/testbed/stream_hash.h"

#include <variant>

namespace polnav::testbed {
namespace {

void HashVector(const Eigen::Vector3d& v, Sha256& hash) {
  hash.Update(v.data(), sizeof(double) * 3);
}

void HashPose(const nav::Pose& pose, Sha256& hash) {
  HashVector(pose.p, hash);
  hash.Update(pose.q.coeffs().data(), sizeof(double) * 4);
}

void HashImage(const cv::Mat& image, Sha256& hash) {
  for (int row = 0; row < image.rows; ++row) {
    hash.Update(image.ptr(row), static_cast<std::size_t>(image.cols) * image.elemSize());
  }
}

struct Hasher {
  Sha256& hash;

  void operator()(const nav::ImuSample& m) const {
    HashVector(m.gyro_rad_s, hash);
    HashVector(m.accel_m_s2, hash);
  }
  void operator()(const nav::StereoImages& m) const {
    HashImage(m.left, hash);
    HashImage(m.right, hash);
  }
  void operator()(const nav::StereoFeatures& m) const {
    for (const nav::FeatureObservation& f : m.features) {
      hash.UpdateValue(f.id);
      hash.Update(f.uv_left_px.data(), sizeof(double) * 2);
      hash.UpdateValue(f.u_right_px.has_value());
      hash.UpdateValue(f.u_right_px.value_or(0.0));
    }
  }
  void operator()(const nav::PolarizationSample& m) const {
    for (const double channel : m.channel) hash.UpdateValue(channel);
  }
  void operator()(const nav::PolarizationImage& m) const { HashImage(m.mosaic, hash); }
  void operator()(const nav::OpticalFlowSample& m) const {
    hash.UpdateValue(m.integration);
    hash.Update(m.flow_rad.data(), sizeof(double) * 2);
    HashVector(m.gyro_rad, hash);
    hash.UpdateValue(m.range_m.has_value());
    hash.UpdateValue(m.range_m.value_or(0.0));
    hash.UpdateValue(m.quality);
  }
  void operator()(const nav::ReferencePose& m) const {
    HashPose(m.T_WB, hash);
    HashVector(m.v_WB_m_s, hash);
    hash.UpdateValue(m.gnss_aided);
  }
};

}  // namespace

void HashMeasurement(const nav::Measurement& measurement, Sha256& hash) {
  hash.UpdateValue(nav::StampOf(measurement));
  std::visit(Hasher{hash}, measurement);
}

void HashTruth(const sim::Truth& truth, Sha256& hash) {
  hash.UpdateValue(truth.stamp);
  HashPose(truth.T_WB, hash);
  HashVector(truth.v_WB_m_s, hash);
  HashVector(truth.w_WB_B_rad_s, hash);
}

}  // namespace polnav::testbed
