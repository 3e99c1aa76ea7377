#include "tools/testbed/dataset/sensor_section.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/LU>
#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>

namespace polnav::testbed {
namespace {

std::optional<double> ParseFinite(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = error == std::errc() && end == text.data() + text.size() && !text.empty();
  return whole && std::isfinite(value) ? std::optional(value) : std::nullopt;
}

YAML::Node Below(const YAML::Node& root, const std::string& path) {
  YAML::Node node = root;
  std::stringstream parts(path);
  for (std::string part; std::getline(parts, part, '.');) {
    if (!node.IsMap()) return YAML::Node(YAML::NodeType::Undefined);
    const YAML::Node& here = node;
    const YAML::Node next = here[part];
    if (!next.IsDefined()) return next;
    node.reset(next);
  }
  return node;
}

Eigen::Matrix3d RotationOf(const std::vector<double>& matrix) {
  return Eigen::Map<const Eigen::Matrix<double, 4, 4, Eigen::RowMajor>>(matrix.data())
      .topLeftCorner<3, 3>();
}

}  // namespace

bool IsRotation(const Eigen::Matrix3d& matrix) {
  constexpr double kTolerance = 1e-3;
  const Eigen::Matrix3d off = matrix.transpose() * matrix - Eigen::Matrix3d::Identity();
  return off.cwiseAbs().maxCoeff() < kTolerance && matrix.determinant() > 0.0;
}

SensorSection::SensorSection(YamlDocument document, std::string path)
    : document_(std::move(document)),
      path_(std::move(path)),
      section_(Below(document_.root, path_)) {
  if (!section_.IsMap()) FailAt(document_, path_, "expected a section (key: value)");
}

void SensorSection::Fail(const std::string& key, const std::string& message) const {
  FailAt(document_, JoinKey(path_, key), message);
}

bool SensorSection::Has(const std::string& key) const {
  const YAML::Node node = Below(section_, key);
  return node.IsDefined() && !node.IsNull();
}

YAML::Node SensorSection::Take(const std::string& key, const std::string& expected) const {
  if (!Has(key)) Fail(key, "missing; expected " + expected);
  return Below(section_, key);
}

double SensorSection::Number(const std::string& key, OptionRange range) const {
  const YAML::Node node = Take(key, "a number");
  const std::optional<double> value = node.IsScalar() ? ParseFinite(node.Scalar()) : std::nullopt;
  if (!value) Fail(key, "expected a number");
  if (!range.Contains(*value)) {
    Fail(key, fmt::format("{} is out of range, {}", *value, RangeText(range)));
  }
  return *value;
}

double SensorSection::NumberOr(const std::string& key, double fallback, OptionRange range) const {
  return Has(key) ? Number(key, range) : fallback;
}

int SensorSection::Integer(const std::string& key, int min, int max) const {
  const double value =
      Number(key, {.min = static_cast<double>(min), .max = static_cast<double>(max)});
  if (value != std::floor(value)) Fail(key, fmt::format("expected a whole number, got {}", value));
  return static_cast<int>(value);
}

std::vector<double> SensorSection::AnyNumbers(const std::string& key) const {
  const YAML::Node node = Take(key, "a list of numbers");
  if (!node.IsSequence()) Fail(key, "expected a list of numbers");
  std::vector<double> values;
  for (const YAML::Node& item : node) {
    const std::optional<double> value = item.IsScalar() ? ParseFinite(item.Scalar()) : std::nullopt;
    if (!value) Fail(key, fmt::format("item {} is no number", values.size()));
    values.push_back(*value);
  }
  return values;
}

std::vector<double> SensorSection::Numbers(const std::string& key, std::size_t count) const {
  std::vector<double> values = AnyNumbers(key);
  if (values.size() != count) {
    Fail(key, fmt::format("expected {} numbers, got {}", count, values.size()));
  }
  return values;
}

std::string SensorSection::Word(const std::string& key, OptionChoices choices) const {
  const YAML::Node node = Take(key, fmt::format("one of: {}", fmt::join(choices, ", ")));
  std::string word = node.IsScalar() ? node.Scalar() : "";
  const bool known = std::any_of(choices.begin(), choices.end(),
                                 [&](const char* choice) { return word == choice; });
  if (!known) {
    Fail(key, fmt::format("'{}' is not one of: {}", word, fmt::join(choices, ", ")));
  }
  return word;
}

std::vector<double> SensorSection::Matrix(const std::string& key, int size) const {
  const auto side = static_cast<std::size_t>(size);
  (void)Integer(key + ".rows", size, size);
  (void)Integer(key + ".cols", size, size);
  return Numbers(key + ".data", side * side);
}

nav::Pose SensorSection::MountPose() const {
  const std::vector<double> m = Matrix("T_BS", 4);
  const Eigen::Matrix3d rotation = RotationOf(m);
  if (!IsRotation(rotation)) Fail("T_BS.data", "its upper left 3 x 3 is no rotation");
  const bool affine = m[12] == 0.0 && m[13] == 0.0 && m[14] == 0.0 && m[15] == 1.0;
  if (!affine) Fail("T_BS.data", "expected 0, 0, 0, 1 as the last row");
  nav::Pose T_BS{Eigen::Quaterniond(rotation).normalized(), {m[3], m[7], m[11]}};
  if (!Has("q_BS_xyzw")) return T_BS;
  const std::vector<double> xyzw = Numbers("q_BS_xyzw", 4);
  const Eigen::Quaterniond q(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
  if (!(std::abs(q.norm() - 1.0) < 1e-9) || !(q.angularDistance(T_BS.q) < 1e-7)) {
    Fail("q_BS_xyzw", "disagrees with T_BS; change both, or leave this one out");
  }
  T_BS.q = q;
  return T_BS;
}

}  // namespace polnav::testbed
