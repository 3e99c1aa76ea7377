// Single trials in a study's report: the worst, and those that did not go ok.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/testbed/report/sections.h"
#include "tools/testbed/report/study_report.h"
#include "tools/testbed/study/aggregate.h"
#include "tools/testbed/study/schema.h"

namespace polnav::testbed {
namespace {

constexpr std::size_t kWorst = 5;
constexpr int kListedFailures = 100;

// Indices of the largest, the largest first; of equal ones the first trial first.
std::vector<std::size_t> Largest(const std::vector<double>& values) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!std::isnan(values[i])) order.push_back(i);
  }
  const std::size_t count = std::min(kWorst, order.size());
  std::partial_sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(count), order.end(),
                    [&](std::size_t a, std::size_t b) {
                      return values[a] > values[b] || (values[a] == values[b] && a < b);
                    });
  order.resize(count);
  return order;
}

std::string InputsText(const StudyTable& table, std::uint64_t trial) {
  std::string text;
  for (const std::string& key : table.dispersed()) {
    SQLite::Statement query(table.connection(),
                            "SELECT " + QuotedName(key) + " FROM inputs WHERE trial = ?");
    query.bind(1, static_cast<std::int64_t>(trial));
    if (!query.executeStep() || query.getColumn(0).isNull()) continue;
    const SQLite::Column value = query.getColumn(0);
    text +=
        fmt::format("{}{} = {}", text.empty() ? "" : ", ", key,
                    value.isText() ? value.getString() : fmt::format("{:.4g}", value.getDouble()));
  }
  return text;
}

}  // namespace

std::string StudyWorstSection(const StudyTable& table) {
  std::vector<std::string> metrics = HeadlineMetrics(table);
  if (metrics.empty()) return "";
  const std::string metric = metrics.front();
  HtmlTable html{.rows = {{"case", "estimator", metric, "inputs", "run it again"}},
                 .text_columns = true};
  for (const std::string& estimator : table.estimators()) {
    if (estimator.empty()) continue;
    const std::vector<CaseColumns> read = table.Read(estimator, {metric});
    for (std::size_t c = 0; c < std::min(read.size(), kChartedCases); ++c) {
      for (const std::size_t i : Largest(read[c].columns[0].values)) {
        html.rows.push_back(
            {table.cases()[c].label, estimator, fmt::format("{:.4g}", read[c].columns[0].values[i]),
             InputsText(table, read[c].trials[i]), RerunCommand(table, read[c].trials[i])});
      }
    }
  }
  if (html.rows.size() < 2) return "";
  return "<section><h2>Worst trials</h2>" + html.Html() + "</section>";
}

std::string StudyFailureSection(const StudyTable& table) {
  HtmlTable counts{.rows = {{"case", "outcome", "trials"}}};
  for (const TableCase& c : table.cases()) {
    for (const auto& [outcome, count] : c.outcomes) {
      if (outcome != "ok") counts.rows.push_back({c.label, outcome, std::to_string(count)});
    }
  }
  if (counts.rows.size() < 2) return "";
  HtmlTable list{.rows = {{"trial", "outcome", "what went wrong", "run it again"}},
                 .text_columns = true};
  SQLite::Statement query(table.connection(),
                          "SELECT trial, outcome, detail FROM trials WHERE outcome <> 'ok' "
                          "ORDER BY trial LIMIT ?");
  query.bind(1, kListedFailures);
  while (query.executeStep()) {
    const auto trial = static_cast<std::uint64_t>(query.getColumn(0).getInt64());
    list.rows.push_back({std::to_string(trial), query.getColumn(1).getString(),
                         query.getColumn(2).getString(), RerunCommand(table, trial)});
  }
  return "<section><h2>Trials that did not go ok</h2>" + counts.Html() +
         fmt::format("<details><summary>The first {}</summary>", list.rows.size() - 1) +
         list.Html() + "</details></section>";
}

}  // namespace polnav::testbed
