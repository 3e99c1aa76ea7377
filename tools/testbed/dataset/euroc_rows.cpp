#include "tools/testbed/dataset/euroc_rows.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <optional>

namespace polnav::testbed {
namespace {

constexpr std::size_t kPoseFields = 7;
constexpr std::size_t kWithVelocity = 10;
constexpr std::size_t kWithBiases = 16;
constexpr std::size_t kWithTurnRate = 19;

std::string Row(nav::TimeNs stamp, const std::vector<double>& values) {
  return fmt::format("{},{}", stamp, fmt::join(values, ","));
}

std::vector<double> PoseValues(const nav::Pose& T) {
  return {T.p.x(), T.p.y(), T.p.z(), T.q.w(), T.q.x(), T.q.y(), T.q.z()};
}

void Append(const Eigen::Vector3d& v, std::vector<double>& values) {
  values.insert(values.end(), {v.x(), v.y(), v.z()});
}

Eigen::Vector3d VectorAt(const TableReader& reader, const TableRow& row, std::size_t field) {
  return {reader.Number(row, field), reader.Number(row, field + 1), reader.Number(row, field + 2)};
}

nav::Pose PoseAt(const TableReader& reader, const TableRow& row) {
  Eigen::Quaterniond q(reader.Number(row, 3), reader.Number(row, 4), reader.Number(row, 5),
                       reader.Number(row, 6));
  const double length = q.norm();
  if (!(std::abs(length - 1.0) < 0.01)) {
    reader.Fail(fmt::format("the quaternion's length is {:.4g}, not 1", length));
  }
  // What was printed in full stays as it is, to the last bit.
  if (std::abs(length - 1.0) > 1e-12) q.normalize();
  return {q, VectorAt(reader, row, 0)};
}

// Nothing where a field is nan.
std::optional<sim::ImuBias> BiasAt(const TableReader& reader, const TableRow& row) {
  for (std::size_t i = kWithVelocity; i < kWithBiases; ++i) {
    if (row.fields[i] == "nan") return std::nullopt;
  }
  return sim::ImuBias{VectorAt(reader, row, kWithVelocity),
                      VectorAt(reader, row, kWithVelocity + 3)};
}

}  // namespace

const char* PictureHeader() { return "#timestamp [ns],filename"; }

const char* ImuHeader() {
  return "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],"
         "a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]";
}

const char* PolarimeterHeader() {
  return "#timestamp [ns],I_0 [],I_90 [],I_60 [],I_150 [],I_120 [],I_210 []";
}

const char* ReferenceHeader() {
  return "#timestamp [ns],p_WB_x [m],p_WB_y [m],p_WB_z [m],q_WB_w [],q_WB_x [],q_WB_y [],"
         "q_WB_z [],v_WB_x [m s^-1],v_WB_y [m s^-1],v_WB_z [m s^-1],gnss_aided []";
}

const char* FlowHeader() {
  return "#timestamp [ns],integration [ns],flow_x [rad],flow_y [rad],gyro_x [rad],gyro_y [rad],"
         "gyro_z [rad],range [m],quality []";
}

const char* TruthHeader() {
  return "#timestamp [ns],p_RS_R_x [m],p_RS_R_y [m],p_RS_R_z [m],q_RS_w [],q_RS_x [],q_RS_y [],"
         "q_RS_z [],v_RS_R_x [m s^-1],v_RS_R_y [m s^-1],v_RS_R_z [m s^-1],"
         "b_w_RS_S_x [rad s^-1],b_w_RS_S_y [rad s^-1],b_w_RS_S_z [rad s^-1],"
         "b_a_RS_S_x [m s^-2],b_a_RS_S_y [m s^-2],b_a_RS_S_z [m s^-2],"
         "w_WB_B_x [rad s^-1],w_WB_B_y [rad s^-1],w_WB_B_z [rad s^-1]";
}

std::string RowOf(const nav::ImuSample& sample) {
  std::vector<double> values;
  Append(sample.gyro_rad_s, values);
  Append(sample.accel_m_s2, values);
  return Row(sample.stamp, values);
}

std::string RowOf(const nav::PolarizationSample& sample) {
  return Row(sample.stamp, {sample.channel.begin(), sample.channel.end()});
}

std::string RowOf(const nav::ReferencePose& pose) {
  std::vector<double> values = PoseValues(pose.T_WB);
  Append(pose.v_WB_m_s, values);
  return Row(pose.stamp, values) + (pose.gnss_aided ? ",1" : ",0");
}

// The time is no double: nanoseconds stay whole.
std::string RowOf(const nav::OpticalFlowSample& sample) {
  std::vector<double> values = {sample.flow_rad.x(), sample.flow_rad.y()};
  Append(sample.gyro_rad, values);
  values.push_back(sample.range_m.value_or(std::nan("")));
  values.push_back(sample.quality);
  return fmt::format("{},{},{}", sample.stamp, sample.integration, fmt::join(values, ","));
}

std::string RowOf(const sim::Truth& truth) {
  std::vector<double> values = PoseValues(truth.T_WB);
  Append(truth.v_WB_m_s, values);
  const sim::ImuBias unknown{Eigen::Vector3d::Constant(std::nan("")),
                             Eigen::Vector3d::Constant(std::nan(""))};
  const sim::ImuBias bias = truth.imu_bias.value_or(unknown);
  Append(bias.gyro_rad_s, values);
  Append(bias.accel_m_s2, values);
  Append(truth.w_WB_B_rad_s, values);
  return Row(truth.stamp, values);
}

nav::ImuSample ImuFrom(const TableReader& reader, const TableRow& row) {
  reader.ExpectFields(row, {6});
  return {row.stamp, VectorAt(reader, row, 0), VectorAt(reader, row, 3)};
}

nav::PolarizationSample PolarimeterFrom(const TableReader& reader, const TableRow& row) {
  nav::PolarizationSample sample{.stamp = row.stamp};
  reader.ExpectFields(row, {sample.channel.size()});
  for (std::size_t i = 0; i < sample.channel.size(); ++i) {
    sample.channel[i] = reader.Number(row, i);
  }
  return sample;
}

nav::ReferencePose ReferenceFrom(const TableReader& reader, const TableRow& row) {
  reader.ExpectFields(row, {kWithVelocity + 1});
  return {.stamp = row.stamp,
          .T_WB = PoseAt(reader, row),
          .v_WB_m_s = VectorAt(reader, row, kPoseFields),
          .gnss_aided = reader.Number(row, kWithVelocity) != 0.0};
}

nav::OpticalFlowSample FlowFrom(const TableReader& reader, const TableRow& row) {
  reader.ExpectFields(row, {8});
  nav::OpticalFlowSample sample{.stamp = row.stamp};
  const double integration_ns = reader.Number(row, 0);
  if (!(integration_ns > 0.0 && integration_ns < 1e12)) {
    reader.Fail(fmt::format("a flow is integrated over {} ns; expected more than 0, less than 1e12",
                            integration_ns));
  }
  sample.integration = static_cast<nav::TimeNs>(std::llround(integration_ns));
  sample.flow_rad = {reader.Number(row, 1), reader.Number(row, 2)};
  sample.gyro_rad = VectorAt(reader, row, 3);
  if (row.fields[6] != "nan") sample.range_m = reader.Number(row, 6);
  sample.quality = reader.Number(row, 7);
  return sample;
}

sim::Truth TruthFrom(const TableReader& reader, const TableRow& row) {
  reader.ExpectFields(row, {kPoseFields, kWithVelocity, kWithBiases, kWithTurnRate});
  const std::size_t given = row.fields.size();
  sim::Truth truth{.stamp = row.stamp, .T_WB = PoseAt(reader, row)};
  if (given >= kWithVelocity) truth.v_WB_m_s = VectorAt(reader, row, kPoseFields);
  if (given >= kWithBiases) truth.imu_bias = BiasAt(reader, row);
  if (given >= kWithTurnRate) truth.w_WB_B_rad_s = VectorAt(reader, row, kWithBiases);
  return truth;
}

}  // namespace polnav::testbed
