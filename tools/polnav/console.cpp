#include "tools/polnav/console.h"

#include <fmt/format.h>

#include <algorithm>

namespace polnav::testbed {

Progress::Progress(const Console& console, std::string label, bool quiet)
    : console_(console), label_(std::move(label)), quiet_(quiet) {}

void Progress::Show(double fraction) {
  const int percent = static_cast<int>(100.0 * std::clamp(fraction, 0.0, 1.0));
  if (quiet_ || percent <= shown_percent_) return;
  if (console_.err_is_terminal) {
    constexpr int kWidth = 40;
    const int filled = percent * kWidth / 100;
    console_.err << fmt::format("\r{} [{:#<{}}{:.<{}}] {:3} %", label_, "", filled, "",
                                kWidth - filled, percent)
                 << std::flush;
  } else {
    if (percent / 10 <= shown_percent_ / 10 && shown_percent_ >= 0) return;
    console_.err << fmt::format("{}: {} %\n", label_, percent) << std::flush;
  }
  shown_percent_ = percent;
}

void Progress::Finish() {
  Show(1.0);
  if (!quiet_ && console_.err_is_terminal) console_.err << "\n" << std::flush;
}

std::string TextTable::Text() const {
  std::vector<std::size_t> widths;
  for (const auto& row : rows_) {
    widths.resize(std::max(widths.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], row[i].size());
  }
  std::string text;
  for (const auto& row : rows_) {
    std::string line = "  ";
    for (std::size_t i = 0; i < row.size(); ++i) {
      line += i == 0 ? fmt::format("{:<{}}", row[i], widths[i])
                     : fmt::format("  {:>{}}", row[i], widths[i]);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

}  // namespace polnav::testbed
