#include "tools/testbed/study/study_criteria.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/testbed/result.h"
#include "tools/testbed/statistics/rate.h"
#include "tools/testbed/study/aggregate.h"

namespace polnav::testbed {
namespace {

constexpr const char* kOkRate = "ok_rate";

// "stereo heading_deg.rmse mean <= 1.5, the whole 95 % interval"
std::string ExpectedText(const StudyCriterionText& c) {
  std::string text = NameOf(c.asked);
  if (c.below) text += " < 0";
  if (c.at_most) text += fmt::format(" <= {}", *c.at_most);
  if (c.at_least) text += fmt::format(" >= {}", *c.at_least);
  return c.judge == "interval" ? text + ", the whole 95 % interval" : text;
}

bool Holds(const StudyCriterionText& criterion, const Estimated& actual) {
  if (std::isnan(actual.value)) return false;
  const bool interval = criterion.judge == "interval";
  const double low = interval ? actual.interval.lower : actual.value;
  const double high = interval ? actual.interval.upper : actual.value;
  return (!criterion.at_most || high <= *criterion.at_most) &&
         (!criterion.at_least || low >= *criterion.at_least) && (!criterion.below || high < 0.0);
}

StatisticOfTrials OkRate(const TableCase& c) {
  const std::uint64_t n = c.Finished();
  if (n == 0) return {};
  const double share = static_cast<double>(c.Ok()) / static_cast<double>(n);
  return {{share, ExactRateInterval(c.Ok(), n)}, n};
}

void Judge(const StudyTable& table, const StudyCriterionText& criterion,
           std::vector<StudyVerdict>& verdicts) {
  const bool about_runs = criterion.asked.statistic == kOkRate;
  const std::vector<TrialValues> values = about_runs
                                              ? std::vector<TrialValues>(table.cases().size())
                                              : ReadValues(table, criterion.asked);
  for (std::size_t c = 0; c < table.cases().size(); ++c) {
    const TableCase& the_case = table.cases()[c];
    if (!IsAbout(criterion.asked, the_case)) continue;
    const StatisticOfTrials measured =
        about_runs ? OkRate(the_case) : Compute(criterion.asked, values[c].values, table.seed());
    verdicts.push_back({.name = criterion.name,
                        .label = the_case.label,
                        .expected = ExpectedText(criterion),
                        .n = measured.n,
                        .actual = measured.actual,
                        .passed = Holds(criterion, measured.actual)});
  }
}

// Cases whose ok_rate no criterion is about, and in which a trial did not go ok.
void JudgeTheRest(const StudyTable& table, const std::vector<StudyCriterionText>& criteria,
                  std::vector<StudyVerdict>& verdicts) {
  const StudyCriterionText every{.name = "every trial goes ok",
                                 .asked = {.statistic = kOkRate},
                                 .judge = "value",
                                 .at_least = 1.0};
  for (const TableCase& c : table.cases()) {
    const bool judged = std::any_of(criteria.begin(), criteria.end(), [&](const auto& criterion) {
      return criterion.asked.statistic == kOkRate && IsAbout(criterion.asked, c);
    });
    const StatisticOfTrials measured = OkRate(c);
    if (judged || measured.n == c.Ok()) continue;
    verdicts.push_back({.name = every.name,
                        .label = c.label,
                        .expected = ExpectedText(every),
                        .n = measured.n,
                        .actual = measured.actual,
                        .passed = false});
  }
}

}  // namespace

std::vector<StudyCriterionText> CriteriaOf(const StudyTable& table) {
  std::vector<StudyCriterionText> criteria;
  if (!table.study().contains("criteria")) return criteria;
  for (const Json& json : table.study()["criteria"]) {
    StudyCriterionText c{.name = json.value("name", ""),
                         .asked = ParseStudyStatistic(json),
                         .judge = json.value("judge", "value"),
                         .at_most = NumberAt(json, "at_most"),
                         .at_least = NumberAt(json, "at_least")};
    c.asked.minus = json.value("below", "");
    c.below = !c.asked.minus.empty();
    criteria.push_back(std::move(c));
  }
  return criteria;
}

std::vector<StudyVerdict> JudgeCriteria(const StudyTable& table) {
  std::vector<StudyVerdict> verdicts;
  const std::vector<StudyCriterionText> criteria = CriteriaOf(table);
  for (const StudyCriterionText& criterion : criteria) Judge(table, criterion, verdicts);
  JudgeTheRest(table, criteria, verdicts);
  return verdicts;
}

Json ToJson(const StudyVerdict& verdict) {
  return {{"name", verdict.name},
          {"case", verdict.label},
          {"expected", verdict.expected},
          {"n", verdict.n},
          {"actual", ToJson(verdict.actual)},
          {"passed", verdict.passed}};
}

bool AllCriteriaHold(const Json& aggregate) {
  return std::all_of(aggregate["criteria"].begin(), aggregate["criteria"].end(),
                     [](const Json& c) { return c["passed"].get<bool>(); });
}

std::string StudyJUnitXml(const Json& aggregate) {
  const Json& criteria = aggregate["criteria"];
  const auto failures = std::count_if(criteria.begin(), criteria.end(),
                                      [](const Json& c) { return !c["passed"].get<bool>(); });
  const std::string suite = EscapeMarkup(aggregate["study"].get<std::string>());
  std::string xml = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites>\n"
      "  <testsuite name=\"{}\" tests=\"{}\" failures=\"{}\" errors=\"0\" skipped=\"0\">\n",
      suite, criteria.size(), failures);
  for (const Json& c : criteria) {
    const std::string name =
        c["name"].get<std::string>() + " [" + c["case"].get<std::string>() + "]";
    xml +=
        fmt::format("    <testcase classname=\"polnav.{}\" name=\"{}\"", suite, EscapeMarkup(name));
    if (c["passed"].get<bool>()) {
      xml += "/>\n";
      continue;
    }
    const Json& actual = c["actual"];
    const std::string got = actual["value"].is_null()
                                ? "no value"
                                : fmt::format("{} [{}, {}] of {} values", actual["value"].dump(),
                                              actual["lower"].dump(), actual["upper"].dump(),
                                              c["n"].get<std::size_t>());
    xml +=
        fmt::format(">\n      <failure message=\"{}\"/>\n    </testcase>\n",
                    EscapeMarkup("expected " + c["expected"].get<std::string>() + ", got " + got));
  }
  return xml + "  </testsuite>\n</testsuites>\n";
}

}  // namespace polnav::testbed
