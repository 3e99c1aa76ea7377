// The aggregate of a study whose answers are known.
#include "tools/testbed/study/aggregate.h"

#include <gtest/gtest.h>

#include <sstream>

#include "tests/testbed/study/example_study.h"
#include "tools/polnav/study_summary.h"
#include "tools/testbed/report/study_report.h"
#include "tools/testbed/study/csv_export.h"
#include "tools/testbed/study/study_criteria.h"

namespace polnav::testbed {
namespace {

SQLite::Database InMemory() { return {":memory:", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE}; }

Json ExampleAggregate(const ExampleStudyOptions& options = {}) {
  SQLite::Database db = InMemory();
  FillExampleStudy(db, options);
  return Aggregate(db);
}

Interval IntervalOf(const Json& json) {
  return {json["lower"].get<double>(), json["upper"].get<double>()};
}

TEST(Aggregate, IsTheSameInWhateverOrderTrialsWereWritten) {
  EXPECT_EQ(ExampleAggregate().dump(), ExampleAggregate({.backwards = true}).dump());
  EXPECT_NE(ExampleAggregate().dump(), ExampleAggregate({.trials = 199}).dump());
}

TEST(Aggregate, FindsWhatTheStudyWasMadeOf) {
  const Json c = ExampleAggregate({.trials = 2000})["cases"][0];
  EXPECT_EQ(c["outcomes"]["failed"], 40);
  EXPECT_DOUBLE_EQ(c["ok_rate"]["value"].get<double>(), 0.98);
  const Json& first = c["estimators"]["first"];
  const Json& heading = first["metrics"]["heading_deg.rmse"];
  EXPECT_EQ(heading["n"], 1960);
  // Four standard errors: 3 / sqrt(1960) = 0.068, and 0.068 / sqrt(2) of the spread.
  EXPECT_NEAR(heading["mean"]["value"].get<double>(), 5.0, 0.27);
  EXPECT_NEAR(heading["std"]["value"].get<double>(), 3.0, 0.19);
  EXPECT_NEAR(IntervalOf(heading["mean"]).HalfWidth(), 1.96 * 0.068, 0.01);
  // First-order indices 4/9 and 1/9; their scatter is at most 2 sqrt(S) (1 - S) / sqrt(n) = 0.017.
  const Json& by = first["sensitivity"]["heading_deg.rmse"];
  EXPECT_NEAR(by["a"]["first_order"].get<double>(), 4.0 / 9.0, 0.07);
  EXPECT_NEAR(by["b"]["first_order"].get<double>(), 1.0 / 9.0, 0.07);
  EXPECT_EQ(first["consistency"]["nees.position"]["verdict"], "honest");
  EXPECT_EQ(c["estimators"]["second"]["consistency"]["nees.position"]["verdict"], "overconfident");
  // second - first is 1 + 0.5 f: its mean within four of 0.5 / sqrt(1960) = 0.011.
  EXPECT_NEAR(c["paired"][0]["mean_difference"]["value"].get<double>(), -1.0, 0.046);
  EXPECT_LT(c["paired"][0]["sign_test"].get<double>(), 1e-6);
}

TEST(StudyCriteria, AreJudgedByValueOrByTheWholeInterval) {
  const std::string both =
      R"([{"name": "value", "estimator": "first", "metric": "heading_deg.rmse",
           "statistic": "mean", "at_most": LIMIT, "judge": "value"},
          {"name": "interval", "estimator": "first", "metric": "heading_deg.rmse",
           "statistic": "mean", "at_most": LIMIT, "judge": "interval"},
          {"name": "better", "estimator": "first", "below": "second", "judge": "interval",
           "metric": "heading_deg.rmse", "statistic": "mean"},
          {"name": "rate", "statistic": "ok_rate", "at_least": 0.97},
          {"name": "missing", "estimator": "third", "metric": "heading_deg.rmse",
           "statistic": "mean", "at_most": 100}])";
  const double mean = ExampleAggregate()["cases"][0]["estimators"]["first"]["metrics"]
                                        ["heading_deg.rmse"]["mean"]["value"]
                                            .get<double>();
  std::string text = both;
  while (text.find("LIMIT") != std::string::npos) {
    text.replace(text.find("LIMIT"), 5, std::to_string(mean + 0.1));  // half-width is 0.42
  }
  const Json aggregate = ExampleAggregate({.criteria = text});
  std::vector<bool> passed;
  for (const Json& c : aggregate["criteria"]) passed.push_back(c["passed"].get<bool>());
  EXPECT_EQ(passed, (std::vector<bool>{true, false, true, true, false}));
  EXPECT_FALSE(AllCriteriaHold(aggregate));
  const std::string xml = StudyJUnitXml(aggregate);
  EXPECT_NE(xml.find("tests=\"5\" failures=\"2\""), std::string::npos);
  EXPECT_NE(xml.find("got no value"), std::string::npos);
  EXPECT_NE(StudySummary(aggregate).find("FAILS  interval"), std::string::npos);
}

TEST(StudyHtml, StandsAloneAndEscapesWhatComesFromOutside) {
  SQLite::Database db = InMemory();
  FillExampleStudy(db, {});
  const StudyTable table(db);
  const std::string html = StudyHtml(table, Aggregate(table));
  for (const char* part :
       {"cdf-0-0", "heading-0", "scatter-0-0", "polnav study linear.yaml --trial",
        "threw &lt;something&gt;", "linear &lt;problem&gt;", "overconfident"}) {
    EXPECT_NE(html.find(part), std::string::npos) << part;
  }
  for (const char* fetch : {"src=\"http", "href=", "@import", "<problem>", "<something>"}) {
    EXPECT_EQ(html.find(fetch), std::string::npos) << fetch;
  }
}

TEST(StudyCsv, HasALineAValue) {
  SQLite::Database db = InMemory();
  FillExampleStudy(db, {.trials = 50});
  std::ostringstream out;
  WriteCsv(StudyTable(db), out);
  const std::string csv = out.str();
  EXPECT_EQ(std::count(csv.begin(), csv.end(), '\n'), 1 + 49 * 2 * 3);
  EXPECT_NE(csv.find("\n0,linear <problem>,0,first,sim_duration_s,20\n"), std::string::npos);
}

TEST(StudySummaryCsv, HasALineAMetricAndThePapersFigures) {
  SQLite::Database db = InMemory();
  FillExampleStudy(db, {.paper = true});
  const StudyTable table(db);
  const Json aggregate = Aggregate(table);
  std::ostringstream out;
  WriteSummaryCsv(aggregate, out);
  std::istringstream lines(out.str());
  int count = 0;
  for (std::string line; std::getline(lines, line); ++count) {
    EXPECT_EQ(std::count(line.begin(), line.end(), ','), 32) << line;
  }
  EXPECT_EQ(count, 1 + 2 * 3 + 2);
  EXPECT_NE(out.str().find("\nlinear <problem>,Paper1999: method,heading_deg.rmse,1,4.5,,"),
            std::string::npos);
  const std::string summary = StudySummary(aggregate);
  const std::string line = summary.substr(summary.find("Paper1999: method"));
  EXPECT_NE(line.substr(0, line.find('\n')).find(" 4.5"), std::string::npos) << summary;
  // Its largest error is another quantity than the largest trial's RMSE.
  const std::string html = StudyHtml(table, aggregate);
  const auto row = html.find("Paper1999: method");
  ASSERT_NE(row, std::string::npos);
  EXPECT_EQ(html.substr(row, html.find("</tr>", row) - row).find("21"), std::string::npos);
}

}  // namespace
}  // namespace polnav::testbed
