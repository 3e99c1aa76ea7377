#include "tools/polnav/study_progress.h"

#include <fmt/format.h>

#include <algorithm>

namespace polnav::testbed {
namespace {

constexpr int kWidth = 30;
// Lines of a log: at most one in this time, unless a tenth of the study is done.
constexpr std::chrono::seconds kLineEvery{60};

std::string DurationText(double seconds) {
  if (seconds < 90.0) return fmt::format("{:.0f} s", seconds);
  if (seconds < 90.0 * 60.0) return fmt::format("{:.0f} min", seconds / 60.0);
  return fmt::format("{:.1f} h", seconds / 3600.0);
}

std::uint64_t Tenth(const StudyCounts& counts, std::uint64_t done) {
  return counts.total == 0 ? 10 : 10 * done / counts.total;
}

}  // namespace

std::string StudyProgressText(const StudyCounts& counts, double elapsed_s) {
  std::string text = fmt::format("{} of {} trials", counts.done, counts.total);
  if (counts.failed > 0) text += fmt::format(", {} failed", counts.failed);
  const auto ran = static_cast<double>(counts.done - counts.resumed);
  if (ran > 0.0 && elapsed_s > 0.0) {
    const double left = static_cast<double>(counts.total - counts.done);
    text += fmt::format(", {:.0f} an hour", 3600.0 * ran / elapsed_s);
    if (left > 0.0) text += fmt::format(", {} left", DurationText(left * elapsed_s / ran));
  }
  return text;
}

StudyProgress::StudyProgress(const Console& console, std::string label, bool quiet)
    : console_(console), label_(std::move(label)), quiet_(quiet) {}

void StudyProgress::Show(const StudyCounts& counts) {
  if (quiet_) return;
  const auto now = Clock::now();
  const std::string text =
      StudyProgressText(counts, std::chrono::duration<double>(now - begin_).count());
  if (console_.err_is_terminal) {
    const auto filled =
        static_cast<int>(counts.total == 0 ? kWidth : kWidth * counts.done / counts.total);
    // Erases what a longer line left.
    console_.err << fmt::format("\r{} [{:#<{}}{:.<{}}] {}\x1b[K", label_, "", filled, "",
                                kWidth - filled, text)
                 << std::flush;
  } else if (!any_ || now - shown_ >= kLineEvery ||
             Tenth(counts, counts.done) > Tenth(counts, shown_done_)) {
    console_.err << fmt::format("{}: {}\n", label_, text) << std::flush;
    shown_ = now;
    shown_done_ = counts.done;
  }
  any_ = true;
}

void StudyProgress::Finish() {
  if (!quiet_ && any_ && console_.err_is_terminal) console_.err << "\n" << std::flush;
}

}  // namespace polnav::testbed
