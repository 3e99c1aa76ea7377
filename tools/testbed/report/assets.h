// What does every report carry along? Chart.js, and our own style and script.
#pragma once

#include <string_view>

namespace polnav::testbed {

[[nodiscard]] std::string_view ChartJs();
[[nodiscard]] std::string_view ReportCss();
[[nodiscard]] std::string_view ChartsJs();  // before either of the two scripts below
[[nodiscard]] std::string_view ReportJs();
[[nodiscard]] std::string_view StudyJs();  // of a study's report

}  // namespace polnav::testbed
