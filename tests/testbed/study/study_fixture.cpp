#include "tests/testbed/study/study_fixture.h"

#include <algorithm>
#include <fstream>

#include "sim/random.h"
#include "tests/testbed/example_run.h"
#include "tools/testbed/hash.h"
#include "tools/testbed/input_error.h"

namespace polnav::testbed {

StudyFolder::StudyFolder() { std::ofstream(File("example.yaml")) << ExampleScenarioYaml(); }

std::string StudyFolder::WriteStudy(const std::string& lines, const std::string& name) const {
  std::ofstream(File(name)) << "name: test\nscenarios: [example.yaml]\nlevel: measurement\n"
                            << lines;
  return File(name);
}

std::string StudyFolder::ErrorOf(const std::string& lines) const {
  try {
    (void)Plan(lines);
  } catch (const InputError& error) {
    std::string text = error.what();
    const std::string folder = folder_.path().string() + "/";
    for (auto at = text.find(folder); at != std::string::npos; at = text.find(folder)) {
      text.erase(at, folder.size());
    }
    return text;
  }
  return "no error";
}

RunRecord DrawnRun(const Scenario& scenario, const RunOptions& options,
                   const std::function<void(double)>&) {
  RunRecord record;
  record.sim_duration_s = 2.0;
  for (int i = 0; i <= 20; ++i) {
    sim::Truth truth{.stamp = i * 100'000'000LL};
    truth.T_WB.p = {0.6 * i, 0.01 * i * i, 0.0};
    record.truth.push_back(truth);
  }
  for (const std::string& name : scenario.estimators.run) {
    EstimatorRun run{.name = name};
    auto draw = sim::RandomStream(options.seed, options.trial, name).At(0);
    const double error_rad = 0.01 * draw.Gaussian() / scenario.sky.clear.max_dop;
    for (const sim::Truth& truth : record.truth) {
      nav::Estimate e{.stamp = truth.stamp, .T_WB = truth.T_WB};
      e.T_WB.q = nav::LevelAttitude(nav::CompassHeading(truth.T_WB.q) + error_rad);
      e.T_WB.p.x() += draw.Gaussian();
      e.covariance = nav::Matrix6d::Identity() * 1e-3;
      e.tracked = true;
      run.estimates.push_back(e);
    }
    run.sha256 = HashOf(run.estimates);
    record.estimators.push_back(std::move(run));
  }
  record.streams["imu"] = {options.trial, Sha256Of(std::to_string(options.trial))};
  return record;
}

std::string AggregateText(const std::string& file) {
  StudyDatabase study = StudyDatabase::OpenToRead(file);
  std::string text;
  for (const auto& [table, order] : {std::pair{"cases", "case_id"},
                                     {"input_keys", "key"},
                                     {"trials", "trial"},
                                     {"inputs", "trial"},
                                     {"scores", "estimator, trial"},
                                     {"series", "estimator, trial"}}) {
    std::vector<std::string> names = ColumnsOf(study.connection(), "main", table);
    std::sort(names.begin(), names.end());
    std::string list;
    for (const std::string& name : names) {
      if (name == "wall_s" || name == "peak_rss_mb" || name == "detail") continue;
      list += (list.empty() ? "quote(" : ", quote(") + QuotedName(name) + ")";
      text += name + " ";
    }
    SQLite::Statement query(study.connection(),
                            "SELECT " + list + " FROM " + table + " ORDER BY " + order);
    while (query.executeStep()) {
      for (int i = 0; i < query.getColumnCount(); ++i) text += query.getColumn(i).getString() + ",";
      text += "\n";
    }
  }
  return text;
}

}  // namespace polnav::testbed
