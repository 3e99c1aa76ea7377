// Which trials does a study have, and what is each of them?
//
// Cases are scenarios x variants x points of the grid; trial = sample * cases + case. All cases
// share the values and the random streams of a sample (common random numbers). Everything here
// follows from the study file alone: any process that reads it plans the same trials.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/testbed/option_tree.h"
#include "tools/testbed/scenario.h"
#include "tools/testbed/study/dispersion.h"
#include "tools/testbed/study/sampling.h"
#include "tools/testbed/study/study_options.h"
#include "tools/testbed/yaml_document.h"

namespace polnav::testbed {

struct StudyCase {
  std::string scenario;       // name
  std::string scenario_file;  // as the study file names it
  std::string variant;
  std::vector<InputValue> grid;
  std::string label;  // unique
  std::vector<std::string> estimators;
  std::filesystem::path path;
  std::shared_ptr<const std::string> text;  // of the scenario file
  std::vector<ScenarioOverride> overrides;
  std::shared_ptr<const YamlDocument> document;  // with the overrides; read once for all trials
  std::string sha256;  // of the scenario with all its values, before dispersions
  Json paper;          // metric -> [{label, value}]: what the scenario's paper has
};

struct PlannedTrial {
  std::uint64_t trial = 0;
  std::size_t case_id = 0;
  std::uint64_t sample = 0;
  std::vector<InputValue> inputs;  // grid and dispersions, sorted by key
};

class StudyPlan {
 public:
  // Throws InputError for whatever would go wrong in every trial: unknown keys, values that can be
  // drawn but not set, criteria about what no estimator yields.
  StudyPlan(YamlDocument document, const std::filesystem::path& folder);

  [[nodiscard]] const StudyOptions& options() const { return options_; }
  [[nodiscard]] const std::vector<StudyCase>& cases() const { return cases_; }
  [[nodiscard]] sim::Level level() const;
  // Of all cases and samples.
  [[nodiscard]] std::uint64_t trial_count() const;

  [[nodiscard]] PlannedTrial At(std::uint64_t trial) const;
  // Throws InputError when the scenario refuses the trial's values.
  [[nodiscard]] Scenario ScenarioOf(const PlannedTrial& trial) const;

  // What decides the bytes of every trial; its SHA-256 tells studies apart.
  [[nodiscard]] const Json& identity() const { return identity_; }
  // For readers of the result file; docs/study_database.md.
  [[nodiscard]] Json Definition() const;
  // Keys that differ between trials, and whether by the grid.
  [[nodiscard]] std::vector<std::pair<std::string, bool>> InputKeys() const;

 private:
  void CheckBasics() const;
  void BuildCases(const std::filesystem::path& folder);
  void AddCases(const StudyCase& base, const VariantOptions& variant);
  [[nodiscard]] std::vector<ScenarioOverride> CommonOverrides() const;
  void CheckCase(StudyCase& study_case, std::size_t case_id);
  void BuildDispersions(const std::filesystem::path& folder);
  void CheckRanges() const;
  void BuildIdentity();

  YamlDocument document_;
  StudyOptions options_;
  std::vector<StudyCase> cases_;
  std::vector<Dispersion> dispersions_;
  std::unique_ptr<UnitSampler> sampler_;
  Json identity_;
};

// --trials and --level, where given, stand in place of the file's.
[[nodiscard]] StudyPlan LoadStudy(const std::filesystem::path& path,
                                  const std::optional<std::string>& trials = std::nullopt,
                                  const std::optional<std::string>& level = std::nullopt);

}  // namespace polnav::testbed
