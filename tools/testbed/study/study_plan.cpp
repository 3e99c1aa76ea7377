#include "tools/testbed/study/study_plan.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

#include "tools/testbed/hash.h"
#include "tools/testbed/input_error.h"
#include "tools/testbed/option_loader.h"
#include "tools/testbed/paper_tables.h"
#include "tools/testbed/study/study_checks.h"

namespace polnav::testbed {
namespace {

constexpr std::size_t kMaxCases = 100'000;
// A study is refused at the start when none of so many first samples is a valid scenario.
constexpr std::uint64_t kSamplesTried = 10;

std::string FileText(const std::filesystem::path& path) {
  std::ifstream stream(path, std::ios::binary);
  std::stringstream text;
  if (!stream || !(text << stream.rdbuf()))
    throw InputError(path.string(), 0, "", "cannot be read");
  return text.str();
}

// Machines keep their files in different places: what a file holds counts, not where it lies.
std::string ScenarioSha256(Scenario scenario) {
  scenario.description.clear();
  if (scenario.world.scene_file) {
    scenario.world.scene_file->path = Sha256Of(FileText(scenario.world.scene_file->path));
  }
  return Sha256Of(ResolvedYaml(scenario));
}

Json PaperJson(const Scenario& scenario) {
  Json json = Json::object();
  for (const auto& [metric, figures] : PaperFigures(scenario)) {
    for (const PaperFigure& figure : figures) {
      json[metric].push_back({{"label", figure.label}, {"value", figure.value}});
    }
  }
  return json;
}

std::string LineSource(const YamlDocument& document, const std::string& key_path) {
  try {
    FailAt(document, key_path, "");
  } catch (const InputError& error) {
    return error.line() > 0 ? fmt::format("{}:{}", error.file(), error.line()) : error.file();
  }
}

}  // namespace

StudyPlan::StudyPlan(YamlDocument document, const std::filesystem::path& folder)
    : document_(std::move(document)) {
  LoadOptions(document_, options_);
  CheckBasics();
  BuildDispersions(folder);
  BuildCases(folder);
  for (std::size_t i = 0; i < cases_.size(); ++i) CheckCase(cases_[i], i);
  CheckRanges();
  CheckStudyCriteria(document_, options_.criteria, cases_);
  CheckStudyStop(document_, options_, cases_);
  BuildIdentity();
}

void StudyPlan::CheckBasics() const {
  if (options_.name.empty()) FailAt(document_, "name", "a study needs a name");
  if (options_.scenarios.empty()) {
    FailAt(document_, "scenarios", "expected a list of scenario files, relative to the study file");
  }
  std::set<std::string> names;
  for (std::size_t i = 0; i < options_.variants.size(); ++i) {
    const std::string& name = options_.variants[i].name;
    const std::string key = fmt::format("variants.{}", i);
    if (name.empty()) FailAt(document_, key, "a variant needs a name");
    if (!names.insert(name).second) FailAt(document_, key, fmt::format("'{}' comes twice", name));
  }
}

void StudyPlan::BuildDispersions(const std::filesystem::path& folder) {
  std::vector<std::string> dimensions;
  for (std::size_t i = 0; i < options_.dispersions.size(); ++i) {
    dispersions_.emplace_back(document_, fmt::format("dispersions.{}", i), options_.dispersions[i],
                              folder);
    for (const std::string& name : dispersions_.back().Dimensions()) dimensions.push_back(name);
  }
  CheckInputKeys(document_, dispersions_, options_.grid);
  const Sampling sampling = ParseSampling(options_.sampling);
  if (sampling == Sampling::kSobol && dimensions.size() > MaxSobolDimensions()) {
    FailAt(document_, "dispersions",
           fmt::format("{} dimensions; Sobol points have at most {}", dimensions.size(),
                       MaxSobolDimensions()));
  }
  sampler_ = std::make_unique<UnitSampler>(sampling, options_.seed,
                                           static_cast<std::uint64_t>(options_.trials), dimensions);
}

std::vector<ScenarioOverride> StudyPlan::CommonOverrides() const {
  std::vector<ScenarioOverride> overrides;
  for (std::size_t i = 0; i < options_.set.size(); ++i) {
    overrides.push_back({options_.set[i], LineSource(document_, fmt::format("set.{}", i))});
  }
  if (options_.duration_s) {
    overrides.push_back(
        {fmt::format("duration_s={}", *options_.duration_s), LineSource(document_, "duration_s")});
  }
  if (!options_.estimators.empty()) {
    overrides.push_back({fmt::format("estimators.run=[{}]", fmt::join(options_.estimators, ", ")),
                         LineSource(document_, "estimators")});
  }
  return overrides;
}

void StudyPlan::BuildCases(const std::filesystem::path& folder) {
  const std::vector<ScenarioOverride> common = CommonOverrides();
  std::vector<VariantOptions> variants = options_.variants;
  if (variants.empty()) variants.emplace_back();
  for (std::size_t i = 0; i < options_.scenarios.size(); ++i) {
    StudyCase base;
    base.scenario_file = options_.scenarios[i];
    base.path = (folder / base.scenario_file).lexically_normal();
    if (!std::filesystem::is_regular_file(base.path)) {
      FailAt(document_, fmt::format("scenarios.{}", i),
             fmt::format("there is no file {}", base.path.string()));
    }
    base.text = std::make_shared<const std::string>(FileText(base.path));
    base.overrides = common;
    base.scenario = LoadScenario(base.path, common, level()).name;
    for (const StudyCase& other : cases_) {
      if (other.scenario != base.scenario) continue;
      FailAt(document_, fmt::format("scenarios.{}", i),
             fmt::format("is named '{}' inside, as one above is", base.scenario));
    }
    for (const VariantOptions& variant : variants) AddCases(base, variant);
  }
}

// Every point of the grid, the last key fastest.
void StudyPlan::AddCases(const StudyCase& base, const VariantOptions& variant) {
  StudyCase start = base;
  start.variant = variant.name;
  start.label = base.scenario + (variant.name.empty() ? "" : ", ") + variant.name;
  const auto found =
      std::find_if(options_.variants.begin(), options_.variants.end(),
                   [&](const VariantOptions& other) { return other.name == variant.name; });
  const auto index = found - options_.variants.begin();
  for (std::size_t i = 0; i < variant.set.size(); ++i) {
    start.overrides.push_back(
        {variant.set[i], LineSource(document_, fmt::format("variants.{}.set.{}", index, i))});
  }
  std::vector<StudyCase> points{start};
  for (const NamedLists::Item& item : options_.grid.items) {
    std::vector<StudyCase> finer;
    for (const StudyCase& point : points) {
      for (const std::string& value : item.values) {
        StudyCase& next = finer.emplace_back(point);
        next.grid.push_back(TextInput(item.name, value));
        next.label.append(", ").append(item.name).append("=").append(value);
        next.overrides.push_back({item.name + "=" + value, LineSource(document_, "grid")});
      }
    }
    points = std::move(finer);
    if (cases_.size() + points.size() > kMaxCases) {
      FailAt(document_, "grid", fmt::format("more than {} cases", kMaxCases));
    }
  }
  cases_.insert(cases_.end(), points.begin(), points.end());
}

void StudyPlan::CheckCase(StudyCase& study_case, std::size_t case_id) {
  const Scenario scenario =
      ParseScenario(*study_case.text, study_case.path.string(), study_case.overrides, level());
  study_case.estimators = scenario.estimators.run;
  if (study_case.estimators.empty()) {
    throw InputError(study_case.path.string(), 0, "estimators.run", "a study needs an estimator");
  }
  study_case.sha256 = ScenarioSha256(scenario);
  study_case.paper = PaperJson(scenario);
  YamlDocument document = ParseYaml(*study_case.text, study_case.path.string());
  for (const auto& [assignment, source] : study_case.overrides) {
    ApplyOverride(document, assignment, source);
  }
  study_case.document = std::make_shared<const YamlDocument>(std::move(document));
  if (dispersions_.empty()) return;
  std::optional<InputError> first_error;
  const auto tried = std::min(kSamplesTried, static_cast<std::uint64_t>(options_.trials));
  for (std::uint64_t sample = 0; sample < tried; ++sample) {
    try {
      (void)ScenarioOf(At(sample * cases_.size() + case_id));
      return;
    } catch (const InputError& error) {
      if (!first_error) first_error = error;
    }
  }
  throw InputError(*first_error);
}

void StudyPlan::CheckRanges() const {
  std::size_t dimension = 0;
  for (const Dispersion& dispersion : dispersions_) {
    CheckDispersionRange(document_, dispersion, *sampler_, dimension,
                         static_cast<std::uint64_t>(options_.trials));
    dimension += dispersion.Dimensions().size();
  }
}

sim::Level StudyPlan::level() const {
  return options_.level == "measurement" ? sim::Level::kMeasurement : sim::Level::kImage;
}

std::uint64_t StudyPlan::trial_count() const {
  return cases_.size() * static_cast<std::uint64_t>(options_.trials);
}

PlannedTrial StudyPlan::At(std::uint64_t trial) const {
  PlannedTrial planned{.trial = trial,
                       .case_id = static_cast<std::size_t>(trial % cases_.size()),
                       .sample = trial / cases_.size(),
                       .inputs = {}};
  planned.inputs = cases_[planned.case_id].grid;
  const std::vector<double> u = sampler_->At(planned.sample);
  std::size_t dimension = 0;
  for (const Dispersion& dispersion : dispersions_) {
    const std::size_t count = dispersion.Dimensions().size();
    const auto values = dispersion.At(std::span(u).subspan(dimension, count), planned.sample);
    planned.inputs.insert(planned.inputs.end(), values.begin(), values.end());
    dimension += count;
  }
  std::sort(planned.inputs.begin(), planned.inputs.end(),
            [](const InputValue& a, const InputValue& b) { return a.key < b.key; });
  return planned;
}

Scenario StudyPlan::ScenarioOf(const PlannedTrial& trial) const {
  const StudyCase& study_case = cases_[trial.case_id];
  std::vector<ScenarioOverride> overrides;
  for (const Dispersion& dispersion : dispersions_) {
    for (const std::string& key : dispersion.keys()) {
      const auto input = std::find_if(trial.inputs.begin(), trial.inputs.end(),
                                      [&](const InputValue& value) { return value.key == key; });
      overrides.push_back({key + "=" + input->text, LineSource(document_, dispersion.entry())});
    }
  }
  return testbed::ScenarioOf(*study_case.document, overrides, level());
}

std::vector<std::pair<std::string, bool>> StudyPlan::InputKeys() const {
  std::vector<std::pair<std::string, bool>> keys;
  for (const NamedLists::Item& item : options_.grid.items) keys.emplace_back(item.name, true);
  for (const Dispersion& dispersion : dispersions_) {
    for (const std::string& key : dispersion.keys()) keys.emplace_back(key, false);
  }
  return keys;
}

void StudyPlan::BuildIdentity() {
  Json values = OptionValues(options_);
  identity_ = {{"level", options_.level},
               {"seed", options_.seed},
               {"sampling", options_.sampling},
               {"dispersions", values["dispersions"]},
               {"series", values["series"]}};
  // The strata of a Latin hypercube depend on how many there are.
  if (options_.sampling == "latin_hypercube") identity_["trials"] = options_.trials;
  for (std::size_t i = 0; i < dispersions_.size(); ++i) {
    const std::string sha256 = dispersions_[i].TableSha256();
    if (!sha256.empty()) identity_["dispersions"][i]["table"]["file"] = sha256;
  }
  identity_["cases"] = Json::array();
  for (const StudyCase& c : cases_) {
    identity_["cases"].push_back({{"label", c.label}, {"scenario_sha256", c.sha256}});
  }
}

Json StudyPlan::Definition() const {
  Json definition = {{"study", OptionValues(options_)}, {"cases", Json::array()}};
  for (const StudyCase& c : cases_) {
    Json grid = Json::object();
    for (const InputValue& value : c.grid) {
      grid[value.key] = value.number ? Json(*value.number) : Json(value.text);
    }
    definition["cases"].push_back({{"scenario", c.scenario},
                                   {"scenario_file", c.scenario_file},
                                   {"variant", c.variant},
                                   {"grid", grid},
                                   {"label", c.label},
                                   {"estimators", c.estimators},
                                   {"paper", c.paper}});
  }
  return definition;
}

StudyPlan LoadStudy(const std::filesystem::path& path, const std::optional<std::string>& trials,
                    const std::optional<std::string>& level) {
  YamlDocument document = ReadYaml(path);
  if (trials) ApplyOverride(document, "trials=" + *trials, "--trials " + *trials);
  if (level) ApplyOverride(document, "level=" + *level, "--level " + *level);
  return StudyPlan(std::move(document), path.parent_path());
}

}  // namespace polnav::testbed
