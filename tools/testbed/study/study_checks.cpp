#include "tools/testbed/study/study_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <sstream>

#include "tools/testbed/metrics.h"
#include "tools/testbed/option_loader.h"

namespace polnav::testbed {
namespace {

// What the JSON Schema of scenarios says about a key; null: no such key, or too free to tell.
const Json* SchemaOf(const Json& root, const std::string& key_path) {
  const Json* node = &root;
  std::stringstream stream(key_path);
  for (std::string part; std::getline(stream, part, '.');) {
    if (node->contains("properties") && (*node)["properties"].contains(part)) {
      node = &(*node)["properties"][part];
    } else if (node->contains("items") &&
               part.find_first_not_of("0123456789") == std::string::npos) {
      node = &(*node)["items"];
    } else {
      return nullptr;
    }
  }
  return node;
}

OptionRange RangeOf(const Json& schema) {
  OptionRange range;
  if (schema.contains("minimum")) range.min = schema["minimum"].get<double>();
  if (schema.contains("maximum")) range.max = schema["maximum"].get<double>();
  return range;
}

const Json& ScenarioSchema() {
  static const Json schema = OptionSchema<Scenario>();
  return schema;
}

// Checks each key's bounds. True: some key has a range that only the draws themselves can break.
bool CheckBounds(const YamlDocument& document, const Dispersion& dispersion) {
  bool look_at_draws = false;
  for (std::size_t i = 0; i < dispersion.keys().size(); ++i) {
    const std::string& key = dispersion.keys()[i];
    const Json* const schema = SchemaOf(ScenarioSchema(), key);
    if (schema == nullptr) continue;
    if (dispersion.continuous() && schema->value("type", Json()) == "integer") {
      FailAt(document, dispersion.entry(),
             fmt::format("{} is a whole number: expected discrete values or a table", key));
    }
    const OptionRange range = RangeOf(*schema);
    if (RangeText(range).empty()) continue;
    const auto bounds = dispersion.Bounds(i);
    if (!bounds) {
      look_at_draws = true;
      continue;
    }
    for (const double value : {bounds->first, bounds->second}) {
      if (range.Contains(value)) continue;
      FailAt(document, dispersion.entry(),
             fmt::format("{} may be drawn for {}, out of range, {}", value, key, RangeText(range)));
    }
  }
  return look_at_draws;
}

}  // namespace

void CheckDispersionRange(const YamlDocument& document, const Dispersion& dispersion,
                          const UnitSampler& sampler, std::size_t first_dimension,
                          std::uint64_t samples) {
  if (!CheckBounds(document, dispersion)) return;
  const std::size_t dimensions = dispersion.Dimensions().size();
  for (std::uint64_t sample = 0; sample < samples; ++sample) {
    const std::vector<double> u = sampler.At(sample);
    for (const InputValue& value :
         dispersion.At(std::span(u).subspan(first_dimension, dimensions), sample)) {
      const Json* const schema = SchemaOf(ScenarioSchema(), value.key);
      if (schema == nullptr || !value.number) continue;
      const OptionRange range = RangeOf(*schema);
      if (range.Contains(*value.number)) continue;
      FailAt(document, dispersion.entry(),
             fmt::format("sample {} draws {} for {}, out of range, {}: cut the distribution off "
                         "with min and max",
                         sample, value.text, value.key, RangeText(range)));
    }
  }
}

void CheckInputKeys(const YamlDocument& document, const std::vector<Dispersion>& dispersions,
                    const NamedLists& grid) {
  std::set<std::string> seen;
  for (const NamedLists::Item& item : grid.items) seen.insert(item.name);
  for (const Dispersion& dispersion : dispersions) {
    for (const std::string& key : dispersion.keys()) {
      if (seen.insert(key).second) continue;
      FailAt(document, dispersion.entry(), fmt::format("'{}' is varied twice", key));
    }
  }
}

namespace {

void CheckCriterionMetric(const YamlDocument& document, const std::string& key,
                          const StudyCriterion& criterion) {
  if (criterion.statistic == "ok_rate") return;
  if (IsMetric(fmt::format("estimators.{}.{}", criterion.estimator, criterion.metric))) return;
  const std::string nearest = NearestWord(criterion.metric, EstimatorMetrics());
  FailAt(document, key + ".metric",
         fmt::format("'{}' is no metric of '{}'{} (polnav list shows all)", criterion.metric,
                     criterion.estimator,
                     nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest)));
}

void CheckCriterionLimits(const YamlDocument& document, const std::string& key,
                          const StudyCriterion& c) {
  if (!c.at_most && !c.at_least && c.below.empty()) {
    FailAt(document, key, "a criterion needs at_most, at_least or below");
  }
  const bool limits = c.success_at_least || c.success_at_most;
  if (c.statistic == "success_rate" && !limits) {
    FailAt(document, key, "success_rate needs success_at_most or success_at_least");
  }
  if (c.statistic != "success_rate" && limits) {
    FailAt(document, key + ".statistic", "success_at_* belong to success_rate");
  }
  const bool rate = c.statistic == "ok_rate" || c.statistic == "success_rate";
  if (rate && !c.below.empty()) {
    FailAt(document, key + ".below", "rates are not compared in pairs: use at_least or at_most");
  }
}

// The cases a criterion is about run the estimators that it names.
void CheckCriterionCases(const YamlDocument& document, const std::string& key,
                         const StudyCriterion& criterion, const std::vector<StudyCase>& cases) {
  bool any = false;
  for (const StudyCase& c : cases) {
    if (!criterion.scenario.empty() && criterion.scenario != c.scenario) continue;
    if (!criterion.variant.empty() && criterion.variant != c.variant) continue;
    any = true;
    for (const std::string& name : {criterion.estimator, criterion.below}) {
      const bool runs =
          std::find(c.estimators.begin(), c.estimators.end(), name) != c.estimators.end();
      if (runs || name.empty()) continue;
      const std::string nearest = NearestWord(name, c.estimators);
      FailAt(document, key,
             fmt::format("estimator '{}' is not run in {}{}", name, c.label,
                         nearest.empty() ? "" : fmt::format("; did you mean '{}'?", nearest)));
    }
  }
  if (!any) FailAt(document, key, "no case is of this scenario and variant");
}

}  // namespace

void CheckStudyCriteria(const YamlDocument& document, const std::vector<StudyCriterion>& criteria,
                        const std::vector<StudyCase>& cases) {
  std::set<std::string> names;
  for (std::size_t i = 0; i < criteria.size(); ++i) {
    const StudyCriterion& criterion = criteria[i];
    const std::string key = fmt::format("criteria.{}", i);
    if (criterion.name.empty()) FailAt(document, key, "a criterion needs a name");
    if (!names.insert(criterion.name).second) {
      FailAt(document, key + ".name", fmt::format("'{}' is given twice", criterion.name));
    }
    const bool about_runs = criterion.statistic == "ok_rate";
    if (!about_runs && criterion.estimator.empty()) {
      FailAt(document, key, "a criterion needs an estimator");
    }
    CheckCriterionCases(document, key, criterion, cases);
    CheckCriterionMetric(document, key, criterion);
    CheckCriterionLimits(document, key, criterion);
  }
}

}  // namespace polnav::testbed
