// What does a sensor's calibration say, key by key?
//
// A whole sensor.yaml, or one section of a rig file. Every complaint names file, line, key and what
// was expected. Unknown keys are left alone: every calibration tool adds its own.
#pragma once

#include <string>
#include <vector>

#include "nav/api/geometry.h"
#include "tools/testbed/option_range.h"
#include "tools/testbed/yaml_document.h"

namespace polnav::testbed {

class SensorSection {
 public:
  // path: dotted, of the section; empty for the whole file.
  SensorSection(YamlDocument document, std::string path);

  [[nodiscard]] bool Has(const std::string& key) const;

  // These throw InputError when the key is missing or not what it has to be.
  [[nodiscard]] double Number(const std::string& key, OptionRange range = {}) const;
  [[nodiscard]] int Integer(const std::string& key, int min, int max) const;
  [[nodiscard]] std::vector<double> Numbers(const std::string& key, std::size_t count) const;
  [[nodiscard]] std::vector<double> AnyNumbers(const std::string& key) const;
  [[nodiscard]] std::string Word(const std::string& key, OptionChoices choices) const;

  // fallback: where the key is missing.
  [[nodiscard]] double NumberOr(const std::string& key, double fallback,
                                OptionRange range = {}) const;

  // EuRoC's rows x cols matrix, row by row.
  [[nodiscard]] std::vector<double> Matrix(const std::string& key, int size) const;

  // T_BS, a rotation and a place. q_BS_xyzw beside it, where there is one, has the rotation to the
  // last bit, which a matrix cannot; the two must agree.
  [[nodiscard]] nav::Pose MountPose() const;

  [[noreturn]] void Fail(const std::string& key, const std::string& message) const;

 private:
  [[nodiscard]] YAML::Node Take(const std::string& key, const std::string& expected) const;

  YamlDocument document_;
  std::string path_;
  YAML::Node section_;
};

// Orthonormal and right-handed, to what is left of it after printing with four digits.
[[nodiscard]] bool IsRotation(const Eigen::Matrix3d& matrix);

}  // namespace polnav::testbed
