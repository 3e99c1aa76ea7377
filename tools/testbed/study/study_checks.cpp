#include "tools/testbed/study/study_checks.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <sstream>

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

}  // namespace polnav::testbed
