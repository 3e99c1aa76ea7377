// Which columns do EuRoC's data.csv files have, and Polnav's beside them?
//
//   imu0      w_x, w_y, w_z [rad/s], a_x, a_y, a_z [m/s^2], in the IMU's own axes
//   pol0      six channels over full scale [-], in the order of nav::PolarizationSample
//   flow0     integration [ns], flow x, y [rad], gyro x, y, z [rad], range [m] (nan: no echo),
//   quality ref0      p_WB [m], q_WB (w, x, y, z), v_WB [m/s] in W, gnss_aided (1 or 0)
//   state_groundtruth_estimate0
//             p_WB, q_WB (w, x, y, z), v_WB, b_w [rad/s], b_a [m/s^2], then Polnav's w_WB [rad/s]
//             in B. Biases that are not known: nan. Reading, all after q_WB may be missing.
// Every row begins with the stamp [ns].
#pragma once

#include <string>

#include "nav/api/measurements.h"
#include "sim/truth.h"
#include "tools/testbed/dataset/table_reader.h"

namespace polnav::testbed {

[[nodiscard]] const char* PictureHeader();
[[nodiscard]] const char* ImuHeader();
[[nodiscard]] const char* PolarimeterHeader();
[[nodiscard]] const char* ReferenceHeader();
[[nodiscard]] const char* FlowHeader();
[[nodiscard]] const char* TruthHeader();

[[nodiscard]] std::string RowOf(const nav::ImuSample& sample);
[[nodiscard]] std::string RowOf(const nav::PolarizationSample& sample);
[[nodiscard]] std::string RowOf(const nav::ReferencePose& pose);
[[nodiscard]] std::string RowOf(const nav::OpticalFlowSample& sample);
[[nodiscard]] std::string RowOf(const sim::Truth& truth);

// The reader's last row; throw InputError when it is not as above.
[[nodiscard]] nav::ImuSample ImuFrom(const TableReader& reader, const TableRow& row);
[[nodiscard]] nav::PolarizationSample PolarimeterFrom(const TableReader& reader,
                                                      const TableRow& row);
[[nodiscard]] nav::ReferencePose ReferenceFrom(const TableReader& reader, const TableRow& row);
[[nodiscard]] nav::OpticalFlowSample FlowFrom(const TableReader& reader, const TableRow& row);
[[nodiscard]] sim::Truth TruthFrom(const TableReader& reader, const TableRow& row);

}  // namespace polnav::testbed
