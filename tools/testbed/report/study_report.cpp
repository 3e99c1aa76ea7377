#include "tools/testbed/report/study_report.h"

#include <fmt/format.h>

#include "tools/testbed/report/assets.h"
#include "tools/testbed/report/sections.h"

namespace polnav::testbed {
namespace {

std::string ChartSection(const Json& data) {
  std::string html;
  for (const Json& c : data["cases"]) {
    std::string cards;
    for (const char* kind : {"cdfs", "series", "scatters"}) {
      for (const Json& chart : c[kind]) {
        cards += ChartCard(chart["id"].get<std::string>(),
                           EscapeMarkup(chart["title"].get<std::string>()),
                           EscapeMarkup(chart["note"].get<std::string>()));
      }
    }
    if (cards.empty()) continue;
    html += "<h2>" + EscapeMarkup(c["label"].get<std::string>()) + "</h2><div class=\"columns\">" +
            cards + "</div>";
  }
  return html;
}

}  // namespace

std::string RerunCommand(const StudyTable& table, std::uint64_t trial) {
  return fmt::format("polnav study {} --trial {}", table.Meta("study_file"), trial);
}

std::string IntervalText(const Json& estimated, double scale) {
  if (!estimated.is_object() || estimated["value"].is_null()) return "–";
  const auto text = [&](const char* key, const char* open) -> std::string {
    return estimated[key].is_null() ? open
                                    : fmt::format("{:.4g}", scale * estimated[key].get<double>());
  };
  return text("value", "–") + " [" + text("lower", "-∞") + ", " + text("upper", "∞") + "]";
}

std::string StudyHtml(const StudyTable& table, const Json& aggregate) {
  const Json data = StudyChartData(table);
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><title>" +
      EscapeMarkup(table.Meta("name")) + " – Polnav study</title>\n<style>\n";
  html.append(ReportCss()).append("</style></head>\n<body><main>\n");
  html += StudyHeader(table, aggregate) + "\n" + StudyStopSection(aggregate) + "\n" +
          StudyCriteriaSection(aggregate) + "\n" + StudyErrorSections(table, aggregate) + "\n" +
          StudyPairSection(aggregate) + "\n" + StudyConsistencySection(aggregate) + "\n" +
          ChartSection(data) + "\n" + StudySensitivitySection(aggregate) + "\n" +
          StudyWorstSection(table) + "\n" + StudyFailureSection(table);
  html.append("\n</main>\n<script>").append(ChartJs()).append("</script>\n<script>const study = ");
  html += ScriptSafe(data);
  return html.append(";\n")
      .append(ChartsJs())
      .append(StudyJs())
      .append("</script>\n</body></html>\n");
}

}  // namespace polnav::testbed
