#include "tools/testbed/study/study_sensitivity.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "tools/testbed/statistics/sensitivity.h"
#include "tools/testbed/study/aggregate.h"

namespace polnav::testbed {
namespace {

// Text as the number of its kind, in alphabetical order.
std::vector<double> Kinds(const std::vector<std::string>& text) {
  std::map<std::string, double> kinds;
  for (const std::string& t : text) kinds.emplace(t, 0.0);
  double number = 0.0;
  for (auto& [name, kind] : kinds) kind = number++;
  std::vector<double> values;
  values.reserve(text.size());
  for (const std::string& t : text) values.push_back(kinds.at(t));
  return values;
}

Json SensitivityJson(const InputColumn& input, const CaseColumns& scores, std::size_t metric) {
  const bool text = !input.text.empty();
  const std::vector<double> numbers = text ? Kinds(input.text) : input.numbers;
  const ValuePairs pairs =
      PairUp(input.trials, numbers, scores.trials, scores.columns[metric].values);
  if (pairs.a.size() < 4) return nullptr;
  if (text) {  // no order, so no rank
    const std::vector<std::size_t> groups(pairs.a.begin(), pairs.a.end());
    const double index = FirstOrderOfGroups(groups, pairs.b);
    return {{"n", pairs.a.size()},
            {"rank_correlation", ToJson(Estimated{})},
            {"first_order", std::isfinite(index) ? Json(index) : Json(nullptr)}};
  }
  const Sensitivity s = ComputeSensitivity(pairs.a, pairs.b);
  return {{"n", s.trials},
          {"rank_correlation", ToJson(s.rank_correlation)},
          {"first_order", std::isfinite(s.first_order) ? Json(s.first_order) : Json(nullptr)}};
}

}  // namespace

void AddSensitivities(const StudyTable& table, const std::vector<std::string>& metrics,
                      Json& cases) {
  if (table.dispersed().empty()) return;
  std::vector<std::vector<InputColumn>> inputs;
  for (const std::string& key : table.dispersed()) {
    inputs.push_back(table.ReadInput(key, kSensitivityTrials));
  }
  for (const std::string& estimator : table.estimators()) {
    if (estimator.empty()) continue;
    const std::vector<CaseColumns> scores = table.Read(estimator, metrics, kSensitivityTrials);
    for (std::size_t c = 0; c < scores.size(); ++c) {
      if (scores[c].trials.empty()) continue;
      Json& sensitivity = cases[c]["estimators"][estimator]["sensitivity"];
      for (std::size_t m = 0; m < metrics.size(); ++m) {
        for (std::size_t k = 0; k < inputs.size(); ++k) {
          const Json json = SensitivityJson(inputs[k][c], scores[c], m);
          if (!json.is_null()) sensitivity[metrics[m]][table.dispersed()[k]] = json;
        }
      }
    }
  }
}

}  // namespace polnav::testbed
