#include "tools/testbed/report.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <opencv2/core/version.hpp>

#include "tools/testbed/report/assets.h"
#include "tools/testbed/report/chart_data.h"
#include "tools/testbed/report/sections.h"

namespace polnav::testbed {

std::string ScriptSafe(const Json& data) {
  std::string text;
  for (const char c : data.dump()) {
    if (c == '<') {
      text += "\\u003c";
    } else {
      text += c;
    }
  }
  return text;
}

std::string VersionText() {
  return fmt::format("Polnav {} (GCC {}, Eigen {}.{}.{}, OpenCV {})", POLNAV_VERSION, __VERSION__,
                     EIGEN_WORLD_VERSION, EIGEN_MAJOR_VERSION, EIGEN_MINOR_VERSION, CV_VERSION);
}

std::string HtmlReport(const ReportInput& input) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\"><title>" +
      EscapeMarkup(input.scenario.name) + " – Polnav</title>\n<style>\n";
  html.append(ReportCss()).append("</style></head>\n<body><main>\n");
  html += HeaderSection(input) + "\n" + ErrorSections(input) + "\n" + CriteriaSection(input) +
          "\n" + ChartSections(input) + "\n" + DiagnosticSections(input) + "\n" +
          FaultSection(input) + "\n" + PictureSection(input) + "\n" +
          TimingAndStreamSections(input) + "\n" + AgainSection(input);
  html.append("\n</main>\n<script>").append(ChartJs()).append("</script>\n<script>const run = ");
  html += ScriptSafe(ChartData(input.record, input.scenario));
  return html.append(";\n")
      .append(ChartsJs())
      .append(ReportJs())
      .append("</script>\n</body></html>\n");
}

}  // namespace polnav::testbed
