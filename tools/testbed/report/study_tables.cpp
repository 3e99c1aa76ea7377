// The tables of a study's report.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>

#include "tools/testbed/report/sections.h"
#include "tools/testbed/report/study_report.h"
#include "tools/testbed/study/aggregate.h"
#include "tools/testbed/study/study_stop.h"

namespace polnav::testbed {
namespace {

std::string Figure(const std::string& value, const std::string& label) {
  return "<div class=\"figure\"><b>" + EscapeMarkup(value) + "</b><span>" + EscapeMarkup(label) +
         "</span></div>";
}

std::string Section(const std::string& title, const HtmlTable& table, const std::string& note) {
  if (table.rows.size() < 2) return "";
  return "<section><h2>" + title + "</h2>" + table.Html() + "<p class=\"soft small\">" + note +
         "</p></section>";
}

// A paper's figure is of one run: in the column of the mean, with nothing about trials.
void AddPaper(const Json& paper, const std::string& metric, HtmlTable& table) {
  if (!paper.contains(metric)) return;
  for (const Json& row : paper[metric]) {
    table.rows.push_back({row["label"].get<std::string>(), "1",
                          fmt::format("{:g}", row["value"].get<double>()), "", "", "", ""});
    table.row_class.resize(table.rows.size() - 2);
    table.row_class.emplace_back("paper");
  }
}

std::string ErrorTable(const Json& estimators, const std::string& metric, const Json& paper) {
  HtmlTable table{.rows = {{metric, "trials", "mean", "median", "std", "95th percentile", "max"}}};
  for (const auto& [name, of] : estimators.items()) {
    if (!of.contains("metrics") || !of["metrics"].contains(metric)) continue;
    const Json& m = of["metrics"][metric];
    table.rows.push_back(
        {name, m["n"].dump(), IntervalText(m["mean"]), IntervalText(m["median"]),
         IntervalText(m["std"]), IntervalText(m["p95"]),
         m["max"].is_null() ? "–" : fmt::format("{:.4g}", m["max"].get<double>())});
  }
  if (table.rows.size() < 2) return "";
  AddPaper(paper, metric, table);
  return table.Html();
}

std::string PText(const Json& p) {
  const auto value = p.get<double>();
  return value < 1e-4 ? "< 0.0001" : fmt::format("{:.4f}", value);
}

}  // namespace

std::string StudyHeader(const StudyTable& table, const Json& aggregate) {
  std::string verdict;
  if (!aggregate["criteria"].empty()) {
    const bool holds = std::all_of(aggregate["criteria"].begin(), aggregate["criteria"].end(),
                                   [](const Json& c) { return c["passed"].get<bool>(); });
    verdict =
        fmt::format("<div style=\"flex:0 0 auto\" class=\"verdict {}\">{}</div>",
                    holds ? "pass" : "fail", holds ? "all criteria hold" : "a criterion failed");
  }
  std::uint64_t ok = 0;
  for (const TableCase& c : table.cases()) ok += c.Ok();
  const auto finished = aggregate["trials"].get<std::uint64_t>();
  return "<header><div><h1>" + EscapeMarkup(table.Meta("name")) + "</h1><p class=\"soft\">" +
         EscapeMarkup(table.Meta("description")) + "</p></div>" + verdict +
         "</header><div class=\"figures\">" +
         Figure(std::to_string(finished),
                aggregate["complete"].get<bool>() ? "trials" : "trials so far") +
         Figure(std::to_string(finished - ok), "did not go ok") +
         Figure(std::to_string(table.cases().size()), "cases") +
         Figure(table.Meta("level"), "level") + Figure(table.Meta("seed"), "seed") +
         "</div><p class=\"soft small\">In brackets: 95 % intervals. " +
         EscapeMarkup(table.Meta("polnav_version")) + ", commit " +
         EscapeMarkup(table.Meta("commit")) + ", identity <code>" +
         EscapeMarkup(table.Meta("identity").substr(0, 16)) + "</code></p>";
}

std::string StudyStopSection(const Json& aggregate) {
  const Json& stop = aggregate["stop"];
  if (stop.is_null()) return "";
  HtmlTable table{.rows = {{"what", "case", "value", "trials", "known to within", "asked", ""}},
                  .text_columns = true};
  for (const Json& c : stop["checks"]) {
    const double scale = c["relative"].get<bool>() ? 100.0 : 1.0;
    const auto width = [&](const char* key) -> std::string {
      if (c[key].is_null()) return "–";
      return fmt::format("{:.4g}{}", scale * c[key].get<double>(),
                         c["relative"].get<bool>() ? " %" : "");
    };
    table.rows.push_back({c["what"].get<std::string>(), c["case"].get<std::string>(),
                          IntervalText(c["actual"]), c["n"].dump(), width("half_width"),
                          width("asked"), c["known"].get<bool>() ? "known" : "not yet"});
  }
  std::string why = StopReason(stop);
  why.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(why.front())));
  return "<section><h2>Why it stopped</h2><p>" + EscapeMarkup(why) + ".</p>" +
         (table.rows.size() > 1 ? table.Html() : "") + "</section>";
}

std::string StudyCriteriaSection(const Json& aggregate) {
  HtmlTable table{.rows = {{"criterion", "case", "expected", "measured", "values", ""}},
                  .text_columns = true};
  for (const Json& c : aggregate["criteria"]) {
    const bool passed = c["passed"].get<bool>();
    table.rows.push_back({c["name"].get<std::string>(), c["case"].get<std::string>(),
                          c["expected"].get<std::string>(), IntervalText(c["actual"]),
                          c["n"].dump(), passed ? "holds" : "fails"});
    table.row_class.emplace_back(passed ? "pass" : "fail");
  }
  return Section("Criteria", table, "");
}

std::string StudyErrorSections(const StudyTable& table, const Json& aggregate) {
  std::string html;
  for (std::size_t c = 0; c < table.cases().size(); ++c) {
    const Json& of = aggregate["cases"][c];
    std::string tables;
    for (const std::string& metric : HeadlineMetrics(table)) {
      tables += ErrorTable(of["estimators"], metric, of["paper"]);
    }
    html += "<section><h2>" + EscapeMarkup(table.cases()[c].label) + "</h2>" + tables +
            "<p class=\"soft small\">Went ok: " + IntervalText(of["ok_rate"], 100.0) + " % of " +
            std::to_string(table.cases()[c].Finished()) +
            " trials. A paper's figures are of one drive.</p></section>";
  }
  return html;
}

std::string StudyPairSection(const Json& aggregate) {
  HtmlTable table{.rows = {{"case", "metric", "a", "b", "a lower in", "mean a - b",
                            "a lower by [%]", "sign test p", "Wilcoxon p"}}};
  for (const Json& c : aggregate["cases"]) {
    for (const Json& p : c["paired"]) {
      table.rows.push_back(
          {c["label"].get<std::string>(), p["metric"].get<std::string>(), p["a"].get<std::string>(),
           p["b"].get<std::string>(), p["lower"].dump() + " of " + p["pairs"].dump(),
           IntervalText(p["mean_difference"]), IntervalText(p["improvement"], 100.0),
           PText(p["sign_test"]), PText(p["wilcoxon"])});
    }
  }
  return Section("Compared on the same trials", table,
                 "Differences within each trial: both estimators had the same streams.");
}

std::string StudyConsistencySection(const Json& aggregate) {
  HtmlTable table{.rows = {{"case", "estimator", "", "honest", "mean over trials",
                            "chi-square bounds", "verdict"}}};
  for (const Json& c : aggregate["cases"]) {
    for (const auto& [name, of] : c["estimators"].items()) {
      if (!of.contains("consistency")) continue;
      for (const auto& [metric, e] : of["consistency"].items()) {
        table.rows.push_back({c["label"].get<std::string>(), name, metric, e["honest"].dump(),
                              IntervalText(e["mean"]),
                              fmt::format("{:.4g} to {:.4g}", e["bounds"]["lower"].get<double>(),
                                          e["bounds"]["upper"].get<double>()),
                              e["verdict"].get<std::string>()});
      }
    }
  }
  return Section("Consistency", table,
                 "Squared error (or innovation) over what the covariance says. Overconfident: "
                 "larger than believed.");
}

std::string StudySensitivitySection(const Json& aggregate) {
  HtmlTable table{.rows = {{"case", "estimator", "metric", "input", "rank correlation",
                            "share of the variance"}}};
  for (const Json& c : aggregate["cases"]) {
    for (const auto& [name, of] : c["estimators"].items()) {
      if (!of.contains("sensitivity")) continue;
      for (const auto& [metric, inputs] : of["sensitivity"].items()) {
        for (const auto& [key, s] : inputs.items()) {
          const Json& index = s["first_order"];
          table.rows.push_back(
              {c["label"].get<std::string>(), name, metric, key,
               IntervalText(s["rank_correlation"]),
               index.is_null() ? "–" : fmt::format("{:.3f}", index.get<double>())});
        }
      }
    }
  }
  const std::string section = Section(
      "Sensitivity to the dispersed inputs", table,
      "Spearman's rank correlation; share of the metric's variance that the input alone explains.");
  return section;
}

}  // namespace polnav::testbed
