#include "tools/testbed/study/study_stop.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/testbed/statistics/stopping.h"
#include "tools/testbed/study/aggregate.h"
#include "tools/testbed/study/study_statistic.h"

namespace polnav::testbed {
namespace {

struct Asked {
  StudyStatistic statistic;
  StoppingRule rule;
  std::vector<TrialValues> values;  // of each case
};

std::vector<Asked> AskedOf(const StudyTable& table) {
  std::vector<Asked> all;
  if (!table.study().contains("stop")) return all;
  for (const Json& json : table.study()["stop"]) {
    Asked asked{.statistic = ParseStudyStatistic(json), .rule = {}, .values = {}};
    asked.values = ReadValues(table, asked.statistic);
    asked.rule.relative = !json.contains("half_width") || json["half_width"].is_null();
    asked.rule.half_width =
        json.at(asked.rule.relative ? "relative_half_width" : "half_width").get<double>();
    asked.rule.more_looks = MoreLooks(asked.statistic.statistic);
    all.push_back(std::move(asked));
  }
  return all;
}

// Those of the first `samples` of a case.
std::span<const double> FirstOf(const TrialValues& values, std::uint64_t samples,
                                std::uint64_t cases) {
  const auto end = std::lower_bound(values.trials.begin(), values.trials.end(), samples * cases);
  return std::span(values.values).first(static_cast<std::size_t>(end - values.trials.begin()));
}

bool IsNarrow(const Asked& asked, const StatisticOfTrials& of) {
  return JudgedHalfWidth(of.actual, of.n, asked.rule.relative) <= asked.rule.half_width;
}

StopCheck Check(const StudyTable& table, const Asked& asked, const TrialValues& values,
                std::uint64_t samples) {
  const std::uint64_t cases = table.cases().size();
  const auto after = [&](std::uint64_t look) {
    return Compute(asked.statistic, FirstOf(values, look, cases), table.seed());
  };
  const StatisticOfTrials of = after(samples);
  const auto decisive = LookBefore(samples, asked.rule.more_looks);
  return {.what = NameOf(asked.statistic),
          .actual = of.actual,
          .n = of.n,
          .half_width = JudgedHalfWidth(of.actual, of.n, asked.rule.relative),
          .asked = asked.rule.half_width,
          .relative = asked.rule.relative,
          .known = decisive && IsNarrow(asked, *decisive == samples ? of : after(*decisive))};
}

StopLook LookAt(const StudyTable& table, const std::vector<Asked>& all, std::uint64_t samples) {
  StopLook look{.samples = samples, .checks = {}};
  for (const Asked& asked : all) {
    for (std::size_t c = 0; c < asked.values.size(); ++c) {
      if (!IsAbout(asked.statistic, table.cases()[c])) continue;
      look.checks.push_back(Check(table, asked, asked.values[c], samples));
      look.checks.back().label = table.cases()[c].label;
    }
  }
  return look;
}

// Samples of which every case has finished.
std::uint64_t FinishedSamples(const StudyTable& table) {
  SQLite::Statement query(table.connection(), "SELECT trial FROM trials ORDER BY trial");
  std::int64_t trial = 0;
  while (query.executeStep() && query.getColumn(0).getInt64() == trial) ++trial;
  return static_cast<std::uint64_t>(trial) / table.cases().size();
}

std::string CheckText(const Json& check) {
  const bool relative = check["relative"].get<bool>();
  const auto width = [&](const char* key) -> std::string {
    if (check[key].is_null()) return "unknown";
    const auto value = check[key].get<double>();
    return relative ? fmt::format("{:.4g} %", 100.0 * value) : fmt::format("{:.4g}", value);
  };
  return fmt::format("  {} [{}]: to within {}, asked {}\n", check["what"].get<std::string>(),
                     check["case"].get<std::string>(), width("half_width"), width("asked"));
}

}  // namespace

bool StopLook::Enough() const {
  return std::all_of(checks.begin(), checks.end(), [](const StopCheck& c) { return c.known; });
}

StopLook LookAt(const StudyTable& table, std::uint64_t samples) {
  return LookAt(table, AskedOf(table), samples);
}

std::optional<StudyStop> StopOf(const StudyTable& table) {
  const std::vector<Asked> all = AskedOf(table);
  if (all.empty()) return std::nullopt;
  StudyStop stop;
  const std::uint64_t finished = FinishedSamples(table);
  for (std::size_t n = NextLook(0); n <= finished; n = NextLook(n)) {
    stop.last = LookAt(table, all, n);
    if (!stop.last.Enough()) continue;
    stop.stopped_at = n;
    return stop;
  }
  return stop;
}

Json ToJson(const std::optional<StudyStop>& stop) {
  if (!stop) return nullptr;
  Json checks = Json::array();
  for (const StopCheck& c : stop->last.checks) {
    checks.push_back({{"case", c.label},
                      {"what", c.what},
                      {"n", c.n},
                      {"actual", ToJson(c.actual)},
                      {"half_width", std::isfinite(c.half_width) ? Json(c.half_width) : Json()},
                      {"asked", c.asked},
                      {"relative", c.relative},
                      {"known", c.known}});
  }
  return {{"stopped_at", stop->stopped_at ? Json(*stop->stopped_at) : Json()},
          {"looked_at", stop->last.samples},
          {"checks", checks}};
}

std::string StopReason(const Json& stop) {
  const auto samples = stop["looked_at"].get<std::uint64_t>();
  if (samples == 0) {
    return fmt::format("not looked at yet: the first look is after {} trials of each case",
                       kFirstLook);
  }
  if (stop["stopped_at"].is_null()) {
    return fmt::format("not known well enough at the last look, after {} trials of each case",
                       samples);
  }
  return fmt::format("stopped after {} trials of each case, known well enough", samples);
}

std::string StopText(const Json& stop) {
  if (stop.is_null()) return "";
  std::string text = StopReason(stop) + (stop["checks"].empty() ? "\n" : ":\n");
  for (const Json& check : stop["checks"]) text += CheckText(check);
  return text;
}

}  // namespace polnav::testbed
