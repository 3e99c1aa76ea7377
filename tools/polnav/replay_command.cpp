#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "tools/polnav/commands.h"
#include "tools/polnav/overrides.h"
#include "tools/polnav/run_output.h"
#include "tools/testbed/dataset/replay.h"
#include "tools/testbed/dataset/replay_settings.h"
#include "tools/testbed/input_error.h"
#include "tools/testbed/result.h"

namespace polnav::testbed {
namespace {

constexpr std::size_t kProblemsShown = 10;

// A world that the scenario fixes is scored as it is; one that only the dataset knows is fitted.
Alignment AlignmentFor(const ReplayArguments& arguments, const DatasetInfo& info) {
  const std::string name = !arguments.align.empty()     ? arguments.align
                           : info.scenario_file.empty() ? "se3"
                                                        : "none";
  if (name == "yaw") return Alignment::kYaw;
  return name == "se3" ? Alignment::kSe3 : Alignment::kNone;
}

void Warn(const Console& console, const std::string& text) {
  console.err << "warning: " << text << "\n";
}

void WarnAbout(const ReplayOutcome& outcome, const Console& console) {
  const std::size_t count = outcome.problems.size();
  for (std::size_t i = 0; i < std::min(count, kProblemsShown); ++i) {
    Warn(console, outcome.problems[i] + "; the frame is skipped");
  }
  if (count > kProblemsShown) {
    Warn(console, fmt::format("... and {} frames more", count - kProblemsShown));
  }
  if (count > 0) Warn(console, fmt::format("{} frames are skipped", count));
  if (outcome.before_start > 0) {
    Warn(console, fmt::format("{} measurements from before the first true pose are passed over",
                              outcome.before_start));
  }
}

void TellAssumptions(const DatasetInfo& info, const Scenario& settings, const Console& console) {
  if (!info.has_truth) {
    console.err << "no truth in the dataset: start at the origin looking north, no scores\n";
  }
  if (info.scenario_file.empty() && NeedsSun(settings)) {
    Warn(console,
         fmt::format("no scenario.yaml says where and when this was: the sun is computed "
                     "for {} N, {} E from {} on; --set site.utc=... and so on change that",
                     settings.site.latitude_deg, settings.site.longitude_deg, settings.site.utc));
  }
}

// Every single one was left out: whatever is wrong, it is not a few bad frames.
bool NoFrameWasUsable(const ReplayOutcome& outcome) {
  const auto& streams = outcome.record.streams;
  return !outcome.problems.empty() && !streams.contains("stereo") &&
         !streams.contains("polarization_camera");
}

}  // namespace

int ReplayDataset(const ReplayArguments& arguments, const Console& console) {
  Dataset dataset = OpenDataset(arguments.dataset, arguments.rig);
  const DatasetInfo info = dataset.info();
  const Scenario settings = ReplaySettings(
      info, OverridesOf(arguments.set, arguments.seed, std::nullopt, arguments.estimators));
  const Alignment alignment = AlignmentFor(arguments, info);
  OutputFolder folder(arguments.out.empty() ? std::filesystem::path("out") / ("replay_" + info.name)
                                            : std::filesystem::path(arguments.out));
  if (!arguments.quiet) TellAssumptions(info, settings, console);

  Progress progress(console, settings.name, arguments.quiet);
  ReplayOutcome outcome =
      Replay(std::move(dataset), settings, [&](double fraction) { progress.Show(fraction); });
  if (!outcome.failure) progress.Finish();
  WarnAbout(outcome, console);
  const bool nothing_seen = NoFrameWasUsable(outcome);
  const int code = Deliver({.scenario = settings,
                            .record = std::move(outcome.record),
                            .level = kReplayLevel,
                            .command_line = arguments.command_line,
                            .quiet = arguments.quiet,
                            .json = arguments.json,
                            .alignment = alignment,
                            .epoch = info.epoch},
                           folder, console);
  if (outcome.failure) throw InputError(*outcome.failure);
  if (nothing_seen) throw InputError(arguments.dataset, 0, "", "not one frame could be used");
  return code;
}

}  // namespace polnav::testbed
