#include "tools/polnav/study_summary.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "tools/polnav/console.h"
#include "tools/testbed/report/study_report.h"
#include "tools/testbed/study/study_stop.h"

namespace polnav::testbed {
namespace {

constexpr std::array<const char*, 3> kShown{"heading_deg.rmse", "position_m.rmse", "drift_percent"};

std::string MetricText(const Json& of, const std::string& metric, const char* statistic) {
  if (!of.contains("metrics") || !of["metrics"].contains(metric)) return "-";
  return IntervalText(of["metrics"][metric][statistic]);
}

// RMSE of heading and of position of a paper's one run, in the paper's order.
struct PaperLine {
  std::string label;
  std::array<std::string, 2> rmse{"-", "-"};
};

std::vector<PaperLine> PaperLines(const Json& paper) {
  std::vector<PaperLine> rows;
  for (const std::size_t k : {0U, 1U}) {
    if (!paper.contains(kShown[k])) continue;
    for (const Json& figure : paper[kShown[k]]) {
      const auto label = figure["label"].get<std::string>();
      auto row = std::find_if(rows.begin(), rows.end(),
                              [&](const PaperLine& other) { return other.label == label; });
      if (row == rows.end()) row = rows.insert(rows.end(), {.label = label});
      row->rmse[k] = fmt::format("{:g}", figure["value"].get<double>());
    }
  }
  return rows;
}

std::string CaseText(const Json& c) {
  std::string outcomes;
  for (const auto& [outcome, count] : c["outcomes"].items()) {
    outcomes += fmt::format("{}{} {}", outcomes.empty() ? "" : ", ", count.dump(), outcome);
  }
  std::string text =
      c["label"].get<std::string>() + ": " + (outcomes.empty() ? "no trials" : outcomes) + "\n";
  TextTable table({"", "heading RMSE deg", "its 95th percentile", "position RMSE m", "drift %"});
  for (const auto& [name, of] : c["estimators"].items()) {
    table.Add({"  " + name, MetricText(of, kShown[0], "mean"), MetricText(of, kShown[0], "p95"),
               MetricText(of, kShown[1], "mean"), MetricText(of, kShown[2], "mean")});
  }
  for (const PaperLine& row : PaperLines(c["paper"])) {
    table.Add({"  " + row.label, row.rmse[0], "-", row.rmse[1], "-"});
  }
  if (!c["estimators"].empty()) text += table.Text();
  for (const Json& p : c["paired"]) {
    const auto metric = p["metric"].get<std::string>();
    if (std::find(kShown.begin(), kShown.end(), metric) == kShown.end()) continue;
    text +=
        fmt::format("  {}: {} below {} by {} %, lower in {} of {} trials\n", metric,
                    p["a"].get<std::string>(), p["b"].get<std::string>(),
                    IntervalText(p["improvement"], 100.0), p["lower"].dump(), p["pairs"].dump());
  }
  return text;
}

}  // namespace

std::string StudyCriteriaText(const Json& aggregate, bool only_failures) {
  std::string text;
  for (const Json& c : aggregate["criteria"]) {
    if (only_failures && c["passed"].get<bool>()) continue;
    text += fmt::format("{}  {} [{}]: expected {}, got {} of {} values\n",
                        c["passed"].get<bool>() ? "holds" : "FAILS", c["name"].get<std::string>(),
                        c["case"].get<std::string>(), c["expected"].get<std::string>(),
                        IntervalText(c["actual"]), c["n"].dump());
  }
  return text;
}

std::string StudySummary(const Json& aggregate, std::size_t most_cases) {
  std::string text = fmt::format("{}: {} trials{}; means over trials with 95 % intervals\n",
                                 aggregate["study"].get<std::string>(), aggregate["trials"].dump(),
                                 aggregate["complete"].get<bool>() ? "" : " so far");
  std::size_t shown = 0;
  for (const Json& c : aggregate["cases"]) {
    if (shown++ == most_cases) break;
    text += CaseText(c);
  }
  if (aggregate["cases"].size() > most_cases) {
    text += fmt::format("and {} more cases\n", aggregate["cases"].size() - most_cases);
  }
  text += StopText(aggregate["stop"]);
  return text + StudyCriteriaText(aggregate, false);
}

}  // namespace polnav::testbed
