#include "tools/testbed/tum.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <sstream>

#include "tools/testbed/decimal_time.h"
#include "tools/testbed/input_error.h"

namespace polnav::testbed {
namespace {

std::optional<double> ParseFinite(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size();
  return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

StampedPose ParseLine(const std::string& line, const std::string& file, int number) {
  std::istringstream stream(line);
  const std::vector<std::string> words{std::istream_iterator<std::string>(stream), {}};
  if (words.size() != 8) {
    throw InputError(file, number, "",
                     fmt::format("expected 't x y z qx qy qz qw', got {} words", words.size()));
  }
  const std::optional<nav::TimeNs> stamp = ParseDecimalSeconds(words[0]);
  if (!stamp) throw InputError(file, number, "", fmt::format("'{}' is no time", words[0]));
  std::array<double, 7> v{};
  for (std::size_t i = 0; i < v.size(); ++i) {
    const std::optional<double> value = ParseFinite(words[i + 1]);
    if (!value) throw InputError(file, number, "", fmt::format("'{}' is no number", words[i + 1]));
    v[i] = *value;
  }
  Eigen::Quaterniond q(v[6], v[3], v[4], v[5]);
  if (std::abs(q.norm() - 1.0) > 0.01) {
    throw InputError(file, number, "",
                     fmt::format("the quaternion's length is {:.4g}, not 1", q.norm()));
  }
  return {*stamp, {q.normalized(), {v[0], v[1], v[2]}}};
}

}  // namespace

std::string ToTum(const Trajectory& trajectory) {
  std::string text = "# t_s x_m y_m z_m qx qy qz qw (T_WB: body into world, ENU)\n";
  for (const auto& [stamp, T_WB] : trajectory) {
    const nav::TimeNs magnitude = stamp < 0 ? -stamp : stamp;
    text += fmt::format("{}{}.{:09} {:.15g} {:.15g} {:.15g} {:.15g} {:.15g} {:.15g} {:.15g}\n",
                        stamp < 0 ? "-" : "", magnitude / nav::kNsPerSecond,
                        magnitude % nav::kNsPerSecond, T_WB.p.x(), T_WB.p.y(), T_WB.p.z(),
                        T_WB.q.x(), T_WB.q.y(), T_WB.q.z(), T_WB.q.w());
  }
  return text;
}

Trajectory ParseTum(std::string_view text, const std::string& file) {
  Trajectory trajectory;
  std::istringstream stream{std::string(text)};
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    line.erase(std::min(line.find('#'), line.size()));
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    trajectory.push_back(ParseLine(line, file, number));
    const std::size_t n = trajectory.size();
    if (n > 1 && trajectory[n - 1].stamp <= trajectory[n - 2].stamp) {
      throw InputError(file, number, "", "the time does not increase");
    }
  }
  if (trajectory.empty()) throw InputError(file, 0, "", "holds no pose");
  return trajectory;
}

Trajectory ReadTum(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) throw InputError(path.string(), 0, "", "no such file");
  if (!std::filesystem::is_regular_file(path)) throw InputError(path.string(), 0, "", "no file");
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw InputError(path.string(), 0, "", "cannot be read");
  const std::string text{std::istreambuf_iterator<char>(stream), {}};
  return ParseTum(text, path.string());
}

}  // namespace polnav::testbed
