#include "tools/polnav/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <stdexcept>

#include "tools/polnav/commands.h"
#include "tools/testbed/input_error.h"
#include "tools/testbed/option_tree.h"
#include "tools/testbed/report.h"
#include "tools/testbed/study/study_options.h"

namespace polnav::testbed {
namespace {

std::string Joined(const std::vector<std::string>& arguments) {
  std::string line = "polnav";
  for (const std::string& argument : arguments) {
    const bool plain = argument.find_first_of(" \t\"'[]{}$*&|;<>()\\") == std::string::npos;
    line += plain && !argument.empty() ? " " + argument : " '" + argument + "'";
  }
  return line;
}

Json ScenarioSchema() { return OptionSchema<Scenario>(); }

int PrintSchema(const std::string& of, const Json& of_options, const Console& console) {
  Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                 {"title", "Polnav " + of}};
  schema.update(of_options);
  console.out << schema.dump(2) << "\n";
  return kExitHolds;
}

struct Parsed {
  RunArguments run;
  ReplayArguments replay;
  StudyArguments study;
  MergeArguments merge;
  ReportArguments report;
  EvaluateArguments evaluate;
  SkyArguments sky;
  CompassArguments compass;
  bool print_options = false;
  bool schema = false;
  bool study_schema = false;
};

CLI::App* AddRun(CLI::App& app, RunArguments& a) {
  CLI::App* run = app.add_subcommand("run", "Simulate, estimate, score");
  run->add_option("SCENARIO", a.scenario, "Scenario file (YAML)")->required();
  run->add_option("--out", a.out, "Folder for the results (default: out/<scenario>)");
  run->add_option("--seed", a.seed, "Seed of all randomness");
  // One value each, so that the scenario may follow.
  run->add_option("--set", a.set, "Change one option: key.path=value")
      ->allow_extra_args(false)
      ->take_all();
  run->add_option("--estimators", a.estimators, "Run only these: a,b")
      ->delimiter(',')
      ->allow_extra_args(false);
  run->add_option("--duration", a.duration_s, "Simulated seconds");
  run->add_option("--level", a.level, "What the sensors deliver")
      ->check(CLI::IsMember({"image", "measurement"}))
      ->capture_default_str();
  run->add_option("--render-threads", a.render_threads, "Threads that render; results are the same")
      ->check(CLI::Range(1, 256))
      ->capture_default_str();
  run->add_option("--record", a.record, "Folder for a dataset of all that the sensors say");
  run->add_flag("--quiet", a.quiet, "Print nothing but failures");
  run->add_flag("--json", a.json, "Print result.json instead of the table");
  return run;
}

CLI::App* AddReplay(CLI::App& app, ReplayArguments& a) {
  CLI::App* replay = app.add_subcommand("replay", "Estimate and score on a recorded dataset");
  replay->add_option("DATASET", a.dataset, "EuRoC folder (mav0) or KITTI odometry sequence")
      ->required();
  replay->add_option("--out", a.out, "Folder for the results (default: out/replay_<dataset>)");
  replay->add_option("--rig", a.rig, "Calibrations in place of the dataset's (YAML)");
  replay->add_option("--seed", a.seed, "Seed of the start's error and of faults");
  replay->add_option("--set", a.set, "Change one option: key.path=value")
      ->allow_extra_args(false)
      ->take_all();
  replay->add_option("--estimators", a.estimators, "Run only these: a,b")
      ->delimiter(',')
      ->allow_extra_args(false);
  replay->add_option("--align", a.align, "Fit the estimates to the truth before scoring")
      ->check(CLI::IsMember({"none", "yaw", "se3"}));
  replay->add_flag("--quiet", a.quiet, "Print nothing but failures and warnings");
  replay->add_flag("--json", a.json, "Print result.json instead of the table");
  return replay;
}

CLI::App* AddStudy(CLI::App& app, StudyArguments& a) {
  CLI::App* study = app.add_subcommand("study", "Monte Carlo: many trials; resumes by itself");
  study->add_option("STUDY", a.study, "Study file (YAML)")->required();
  study->add_option("--out", a.out, "Result file (default: out/<study>.sqlite)");
  study->add_option("--trials", a.trials, "Samples of each case");
  study->add_option("--level", a.level, "What the sensors deliver: image, measurement");
  study->add_option("--jobs", a.jobs, "Trials at once (default: one a processor)")
      ->check(CLI::Range(1, 1024));
  study->add_option("--shard", a.shard, "Only part K of N: K/N");
  study->add_option("--trial", a.trial, "Run this one again and compare it with the record");
  study->add_flag("--retry-failed", a.retry_failed, "Run again what did not go ok");
  study->add_flag("--mix-builds", a.mix_builds, "Go on with trials that another build has run");
  study->add_flag("--quiet", a.quiet, "Print nothing but failures");
  return study;
}

CLI::App* AddMerge(CLI::App& app, MergeArguments& a) {
  CLI::App* merge = app.add_subcommand("merge", "Join shards of a study into one file");
  merge->add_option("OUT", a.out, "Result file; made, or added to")->required();
  merge->add_option("IN", a.inputs, "Result files of the shards")->required();
  merge->add_flag("--mix-builds", a.mix_builds, "Also files that different builds have made");
  merge->add_flag("--quiet", a.quiet, "Print nothing but failures");
  return merge;
}

CLI::App* AddReport(CLI::App& app, ReportArguments& a) {
  CLI::App* report = app.add_subcommand("report", "Statistics and HTML report of a study");
  report->add_option("PATH", a.path, "Result file of a study, or folder of a run")->required();
  report->add_option("--out", a.out, "HTML file (default: beside the result file)");
  report->add_option("--csv", a.csv, "Write trial,case,sample,estimator,metric,value");
  report->add_option("--summary-csv", a.summary_csv,
                     "Write a line of statistics a case, estimator and metric");
  report->add_flag("--quiet", a.quiet, "Print nothing but failures");
  report->add_flag("--json", a.json, "Print all statistics as JSON instead of the table");
  return report;
}

CLI::App* AddEvaluate(CLI::App& app, EvaluateArguments& a) {
  CLI::App* evaluate = app.add_subcommand("evaluate", "Compare two trajectories (TUM files)");
  evaluate->add_option("TRUTH", a.truth, "Where the vehicle was")->required();
  evaluate->add_option("ESTIMATE", a.estimate, "Where an estimator believed it to be")->required();
  evaluate->add_option("--align", a.align, "Fit the estimate to the truth first")
      ->check(CLI::IsMember({"none", "yaw", "se3"}))
      ->capture_default_str();
  evaluate->add_flag("--json", a.json, "Print JSON instead of the table");
  return evaluate;
}

CLI::App* AddSky(CLI::App& app, SkyArguments& a) {
  CLI::App* sky = app.add_subcommand("sky", "The sun, and a clear sky's light and polarization");
  sky->add_option("--lat", a.latitude_deg, "Latitude [deg], north positive");
  sky->add_option("--lon", a.longitude_deg, "Longitude [deg], east positive");
  sky->add_option("--utc", a.utc, "Time, such as 2020-11-11T07:00:00Z");
  sky->add_option("--sun-elevation-deg", a.sun_elevation_deg, "In place of a place and a time");
  sky->add_option("--sun-azimuth-deg", a.sun_azimuth_deg, "Compass azimuth, north is 0, east 90");
  sky->add_option("--model", a.model, "How the sky scatters light")
      ->check(CLI::IsMember({"rayleigh", "berry", "hazy"}))
      ->capture_default_str();
  sky->add_option("--aot", a.aot, "Aerosol optical thickness at 550 nm (berry, hazy)");
  sky->add_option("--wavelength-nm", a.wavelength_nm, "400 to 700 (hazy)");
  sky->add_option("--max-dop", a.max_dop, "Highest degree of polarization (rayleigh, berry)");
  sky->add_option("--directions", a.directions, "CSV of azimuth_deg,elevation_deg to look along");
  sky->add_option("--csv", a.csv, "Write azimuth_deg,elevation_deg,I,Q,U,dop,aop_deg");
  sky->add_option("--png", a.png, "Draw angle, degree and radiance");
  return sky;
}

CLI::App* AddCompass(CLI::App& app, CompassArguments& a) {
  CLI::App* compass = app.add_subcommand("compass", "Headings from raw polarization images");
  compass->add_option("IMAGE", a.images, "Raw mosaics (TIFF, PNG)")->required();
  compass->add_option("--layout", a.layout, "Polarizers of a cell [deg]: first row/second row")
      ->capture_default_str();
  compass->add_option("--lens", a.lens, "How it maps")
      ->check(CLI::IsMember({"pinhole", "equidistant"}))
      ->capture_default_str();
  compass->add_option("--focal-px", a.focal_px, "Focal length (default: the longer side)")
      ->check(CLI::Range(1.0, 1e6));
  compass->add_option("--center-px", a.center_px, "Optical axis: x,y (default: the middle)")
      ->delimiter(',')
      ->expected(2);
  compass->add_option("--radius-px", a.radius_px, "Use only a disc around the centre")
      ->check(CLI::Range(1.0, 1e6));
  compass->add_option("--min-elevation-deg", a.min_elevation_deg, "Lowest rays that count")
      ->check(CLI::Range(0.0, 80.0));
  compass->add_option("--bits", a.bits, "Depth of 16-bit files (default: 12)")
      ->check(CLI::Range(9, 16));
  compass->add_option("--method", a.method, "How")
      ->check(CLI::IsMember({"zenith", "lsq", "ransac_tls", "stokes"}))
      ->capture_default_str();
  compass->add_option("--sun-elevation-deg", a.sun_elevation_deg)->check(CLI::Range(-90.0, 90.0));
  compass->add_option("--sun-azimuth-deg", a.sun_azimuth_deg, "Compass")
      ->check(CLI::Range(-360.0, 360.0));
  compass->add_option("--lat", a.lat_deg, "Latitude [deg]")->check(CLI::Range(-90.0, 90.0));
  compass->add_option("--lon", a.lon_deg, "Longitude [deg]")->check(CLI::Range(-180.0, 180.0));
  compass->add_option("--utc", a.utc, "YYYY-MM-DDTHH:MM:SSZ");
  compass->add_option("--roll-deg", a.roll_deg, "Left side up is positive")
      ->check(CLI::Range(-90.0, 90.0));
  compass->add_option("--pitch-deg", a.pitch_deg, "Nose down is positive")
      ->check(CLI::Range(-90.0, 90.0));
  compass->add_option("--calibration", a.calibration, "Camera, from --calibrate (JSON)");
  compass->add_option("--calibrate", a.calibrate, "Fit the camera to a turn; write it here");
  compass->add_option("--headings-deg", a.headings_deg, "Of the turn's pictures: a,b,c")
      ->delimiter(',')
      ->allow_extra_args(false);
  compass->add_option("--csv", a.csv, "Write the rows here");
  compass->add_option("--png", a.png, "Write what was seen and used here");
  compass->add_flag("--json", a.json, "Print JSON instead of CSV");
  return compass;
}

int Dispatch(const std::vector<std::string>& arguments, const Console& console,
             const ClosedLoop& closed_loop) {
  CLI::App app("Polnav: simulation-in-the-loop testbed for polarized-light navigation", "polnav");
  app.set_version_flag("--version", VersionText());
  Parsed parsed;
  app.add_flag("--print-options", parsed.print_options, "Every key of a scenario, and its default");
  app.require_subcommand(0, 1);
  const CLI::App* run = AddRun(app, parsed.run);
  const CLI::App* replay = AddReplay(app, parsed.replay);
  const CLI::App* study = AddStudy(app, parsed.study);
  const CLI::App* merge = AddMerge(app, parsed.merge);
  const CLI::App* report = AddReport(app, parsed.report);
  const CLI::App* evaluate = AddEvaluate(app, parsed.evaluate);
  const CLI::App* sky = AddSky(app, parsed.sky);
  const CLI::App* compass = AddCompass(app, parsed.compass);
  CLI::App* list =
      app.add_subcommand("list", "Scenarios, studies, estimators and metrics that there are");
  list->add_flag("--schema", parsed.schema, "Print the JSON Schema of scenario files instead");
  list->add_flag("--study-schema", parsed.study_schema, "Print that of study files instead");
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));  // CLI11: reversed
  } catch (const CLI::ParseError& error) {
    return app.exit(error, console.out, console.err) == 0 ? kExitHolds : kExitBadInput;
  }
  if (parsed.print_options) {
    console.out << OptionListing(ScenarioSchema());
    return kExitHolds;
  }
  if (run->parsed()) {
    parsed.run.command_line = Joined(arguments);
    return Run(parsed.run, console, closed_loop);
  }
  if (replay->parsed()) {
    parsed.replay.command_line = Joined(arguments);
    return ReplayDataset(parsed.replay, console);
  }
  if (study->parsed()) return Study(parsed.study, console, closed_loop);
  if (merge->parsed()) return Merge(parsed.merge, console);
  if (report->parsed()) return Report(parsed.report, console);
  if (evaluate->parsed()) return Evaluate(parsed.evaluate, console);
  if (sky->parsed()) return Sky(parsed.sky, console);
  if (compass->parsed()) return CompassReadings(parsed.compass, console);
  if (list->parsed() && parsed.schema) return PrintSchema("scenario", ScenarioSchema(), console);
  if (list->parsed() && parsed.study_schema) {
    return PrintSchema("study", OptionSchema<StudyOptions>(), console);
  }
  if (list->parsed()) return List(console);
  console.err << app.help();
  return kExitBadInput;
}

}  // namespace

int RunCommandLine(const std::vector<std::string>& arguments, const Console& console,
                   const ClosedLoop& closed_loop) {
  try {
    return Dispatch(arguments, console, closed_loop);
  } catch (const InputError& error) {
    console.err << "polnav: " << error.what() << "\n";
    return kExitBadInput;
  } catch (const std::invalid_argument& error) {  // what a module says of an option it cannot use
    console.err << "polnav: " << error.what() << "\n";
    return kExitBadInput;
  } catch (const std::exception& error) {
    console.err << "polnav: internal error: " << error.what() << "\n";
    return kExitCrash;
  }
}

}  // namespace polnav::testbed
