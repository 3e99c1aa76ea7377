// The curves and dots of a study's report.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "tools/testbed/report/study_report.h"
#include "tools/testbed/statistics/percentile.h"
#include "tools/testbed/study/aggregate.h"

namespace polnav::testbed {
namespace {

constexpr std::size_t kCdfPoints = 200;
constexpr std::size_t kScatterPoints = 400;
constexpr std::size_t kChartedMetrics = 4;
constexpr std::size_t kChartedInputs = 4;
constexpr std::uint64_t kSeriesSamples = 1000;

// Four digits that a chart can show, and a smaller file.
double Rounded(double value) {
  if (value == 0.0 || !std::isfinite(value)) return 0.0;
  const double scale = std::pow(10.0, 5.0 - std::ceil(std::log10(std::abs(value))));
  return std::round(value * scale) / scale;
}

std::vector<std::string> ChartedMetrics(const StudyTable& table) {
  std::vector<std::string> metrics = HeadlineMetrics(table);
  if (metrics.size() > kChartedMetrics) metrics.resize(kChartedMetrics);
  return metrics;
}

Json Chart(const std::string& id, const std::string& title, const std::string& note) {
  return {{"id", id}, {"title", title}, {"note", note}, {"lines", Json::array()}};
}

Json CdfLine(const std::string& estimator, std::vector<double> values) {
  std::sort(values.begin(), values.end());
  Json line = {{"name", estimator},
               {"x", Json::array()},
               {"y", Json::array()},
               {"band", CdfBand(values.size())}};
  for (const CdfPoint& point : ThinnedCdf(values, kCdfPoints)) {
    line["x"].push_back(Rounded(point.value));
    line["y"].push_back(Rounded(point.share));
  }
  return line;
}

Json ScatterLine(const std::string& estimator, const ValuePairs& pairs) {
  Json line = {{"name", estimator}, {"x", Json::array()}, {"y", Json::array()}};
  for (std::size_t i = 0; i < pairs.a.size() && i < kScatterPoints; ++i) {
    line["x"].push_back(Rounded(pairs.a[i]));
    line["y"].push_back(Rounded(pairs.b[i]));
  }
  return line;
}

// Charts with an empty list of lines are left out.
void Keep(Json& charts, Json chart) {
  if (!chart["lines"].empty()) charts.push_back(std::move(chart));
}

// Magnitudes of the errors at each instant, over the trials.
struct SeriesStack {
  std::vector<std::vector<double>> heading;
  std::vector<std::vector<double>> position;
};

void Stack(const SQLite::Column& blob, std::vector<std::vector<double>>& instants) {
  if (blob.isNull()) return;
  const auto n = static_cast<std::size_t>(blob.getBytes()) / sizeof(float);
  if (instants.empty()) instants.resize(n);
  const char* bytes = static_cast<const char*>(blob.getBlob());
  for (std::size_t k = 0; k < std::min(n, instants.size()); ++k) {
    float value = 0.0F;
    std::memcpy(&value, bytes + k * sizeof(float), sizeof(float));
    if (std::isfinite(value)) instants[k].push_back(std::abs(static_cast<double>(value)));
  }
}

std::vector<SeriesStack> ReadSeries(const StudyTable& table, const std::string& estimator) {
  std::vector<SeriesStack> stacks(table.cases().size());
  SQLite::Statement query(table.connection(),
                          "SELECT trial, heading_deg, position_m FROM series "
                          "WHERE estimator = ? AND trial < ? ORDER BY trial");
  query.bind(1, estimator);
  query.bind(2, static_cast<std::int64_t>(kSeriesSamples * table.cases().size()));
  while (query.executeStep()) {
    const auto trial = static_cast<std::uint64_t>(query.getColumn(0).getInt64());
    Stack(query.getColumn(1), stacks[table.CaseOf(trial)].heading);
    Stack(query.getColumn(2), stacks[table.CaseOf(trial)].position);
  }
  return stacks;
}

Json SeriesLine(const std::string& estimator, std::vector<std::vector<double>>& instants,
                double duration_s) {
  Json line = {{"name", estimator},
               {"t", Json::array()},
               {"low", Json::array()},
               {"median", Json::array()},
               {"high", Json::array()}};
  for (std::size_t k = 0; k < instants.size(); ++k) {
    if (instants[k].empty()) continue;  // before the first answer
    std::sort(instants[k].begin(), instants[k].end());
    const double share = instants.size() > 1
                             ? static_cast<double>(k) / static_cast<double>(instants.size() - 1)
                             : 0.0;
    line["t"].push_back(Rounded(duration_s * share));
    line["low"].push_back(Rounded(PercentileOfSorted(instants[k], 5.0)));
    line["median"].push_back(Rounded(PercentileOfSorted(instants[k], 50.0)));
    line["high"].push_back(Rounded(PercentileOfSorted(instants[k], 95.0)));
  }
  return line;
}

std::vector<double> Durations(const StudyTable& table) {
  std::vector<double> durations(table.cases().size(), 1.0);
  if (!table.HasMetric("sim_duration_s")) return durations;
  const auto read = table.Read("", {"sim_duration_s"});
  for (std::size_t c = 0; c < read.size(); ++c) {
    const std::vector<double> present = read[c].columns[0].Present();
    if (!present.empty()) durations[c] = *std::max_element(present.begin(), present.end());
  }
  return durations;
}

// One estimator after the other, so that only one is in memory.
class ChartBuilder {
 public:
  explicit ChartBuilder(const StudyTable& table)
      : table_(table),
        metrics_(ChartedMetrics(table)),
        durations_(Durations(table)),
        charted_(std::min(table.cases().size(), kChartedCases)) {
    for (const std::string& key : table.dispersed()) {
      if (inputs_.size() == kChartedInputs) break;
      inputs_.emplace_back(key, table.ReadInput(key, 10 * kScatterPoints));
    }
    for (std::size_t c = 0; c < charted_; ++c) StartCase(c);
  }

  void Add(const std::string& estimator) {
    const std::vector<CaseColumns> read = table_.Read(estimator, metrics_);
    std::vector<SeriesStack> series = ReadSeries(table_, estimator);
    for (std::size_t c = 0; c < charted_; ++c) {
      AddCdfs(estimator, read[c], cases_[c]["cdfs"]);
      AddScatters(estimator, read[c], c);
      for (auto [instants, k] : {std::pair(&series[c].heading, 0), {&series[c].position, 1}}) {
        if (instants->empty()) continue;
        cases_[c]["series"][k]["lines"].push_back(SeriesLine(estimator, *instants, durations_[c]));
      }
    }
  }

  [[nodiscard]] Json Build() {
    Json kept = Json::array();
    for (Json& c : cases_) {
      Json charts = {{"label", c["label"]}};
      for (const char* kind : {"cdfs", "series", "scatters"}) {
        charts[kind] = Json::array();
        for (Json& chart : c[kind]) Keep(charts[kind], std::move(chart));
      }
      kept.push_back(std::move(charts));
    }
    return {{"cases", kept}};
  }

 private:
  void StartCase(std::size_t c) {
    Json json = {{"label", table_.cases()[c].label},
                 {"cdfs", Json::array()},
                 {"series", Json::array()},
                 {"scatters", Json::array()}};
    for (std::size_t m = 0; m < metrics_.size(); ++m) {
      json["cdfs"].push_back(Chart(fmt::format("cdf-{}-{}", c, m),
                                   "Trials at or below: " + metrics_[m],
                                   "Shaded: the whole true distribution lies within, with 95 %."));
      json["cdfs"].back()["metric"] = metrics_[m];
    }
    const std::string note = "Over the trials: median, and shaded the 5th to the 95th percentile.";
    json["series"].push_back(Chart(fmt::format("heading-{}", c), "Heading error over time", note));
    json["series"].back()["unit"] = "heading error, magnitude [°]";
    json["series"].push_back(
        Chart(fmt::format("position-{}", c), "Position error over time", note));
    json["series"].back()["unit"] = "position error [m]";
    for (std::size_t k = 0; k < inputs_.size(); ++k) {
      json["scatters"].push_back(Chart(
          fmt::format("scatter-{}-{}", c, k),
          metrics_.empty() ? "" : metrics_[0] + " over " + inputs_[k].first, "A dot is a trial."));
      json["scatters"].back()["x"] = inputs_[k].first;
      json["scatters"].back()["y"] = metrics_.empty() ? "" : metrics_[0];
    }
    cases_.push_back(std::move(json));
  }

  void AddCdfs(const std::string& estimator, const CaseColumns& read, Json& charts) const {
    for (std::size_t m = 0; m < metrics_.size(); ++m) {
      const std::vector<double> values = read.columns[m].Present();
      if (!values.empty()) charts[m]["lines"].push_back(CdfLine(estimator, values));
    }
  }

  void AddScatters(const std::string& estimator, const CaseColumns& read, std::size_t c) {
    if (metrics_.empty()) return;
    for (std::size_t k = 0; k < inputs_.size(); ++k) {
      const InputColumn& input = inputs_[k].second[c];
      if (!input.text.empty()) continue;
      const ValuePairs pairs =
          PairUp(input.trials, input.numbers, read.trials, read.columns[0].values);
      if (pairs.a.empty()) continue;
      cases_[c]["scatters"][k]["lines"].push_back(ScatterLine(estimator, pairs));
    }
  }

  const StudyTable& table_;
  std::vector<std::string> metrics_;
  std::vector<double> durations_;
  std::size_t charted_;
  std::vector<std::pair<std::string, std::vector<InputColumn>>> inputs_;
  std::vector<Json> cases_;
};

}  // namespace

Json StudyChartData(const StudyTable& table) {
  ChartBuilder builder(table);
  for (const std::string& estimator : table.estimators()) {
    if (!estimator.empty()) builder.Add(estimator);
  }
  return builder.Build();
}

}  // namespace polnav::testbed
