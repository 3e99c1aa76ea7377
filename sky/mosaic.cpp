#include "sky/mosaic.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace polnav::sky {

Cell ParseLayout(const std::string& text) {
  const auto unknown = [&text] {
    return std::invalid_argument("mosaic layout '" + text +
                                 "': expected each of 0, 45, 90, 135 once, first row / second "
                                 "row, such as 90,45/135,0");
  };
  Cell angle{};
  Cell seen{};
  std::size_t begin = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const std::size_t end = text.find_first_of(",/", begin);
    const char expected = k == 1 ? '/' : ',';
    if (k < 3 ? end == std::string::npos || text[end] != expected : end != std::string::npos) {
      throw unknown();
    }
    const std::string word = text.substr(begin, end - begin);
    const std::array<const char*, 4> known = {"0", "45", "90", "135"};
    const auto found = std::find(known.begin(), known.end(), word);
    if (found == known.end()) throw unknown();
    const auto index = static_cast<std::size_t>(found - known.begin());
    if (seen[index]++ > 0.0) throw unknown();
    angle[k] = -0.25 * std::numbers::pi * static_cast<double>(index);
    begin = end + 1;
  }
  return angle;
}

Eigen::Matrix<double, 4, 3> AnalyzerMatrix(const Cell& angle_rad, const Cell& gain) {
  Eigen::Matrix<double, 4, 3> matrix;
  for (int k = 0; k < 4; ++k) {
    const auto i = static_cast<std::size_t>(k);
    matrix.row(k) = gain[i] * Eigen::RowVector3d(1.0, std::cos(2.0 * angle_rad[i]),
                                                 std::sin(2.0 * angle_rad[i]));
  }
  return matrix;
}

}  // namespace polnav::sky
