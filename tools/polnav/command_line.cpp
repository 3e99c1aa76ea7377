#include "tools/polnav/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <stdexcept>

#include "tools/polnav/commands.h"
#include "tools/testbed/input_error.h"
#include "tools/testbed/option_tree.h"
#include "tools/testbed/report.h"

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

struct Parsed {
  RunArguments run;
  EvaluateArguments evaluate;
  bool print_options = false;
  bool schema = false;
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
  run->add_flag("--quiet", a.quiet, "Print nothing but failures");
  run->add_flag("--json", a.json, "Print result.json instead of the table");
  return run;
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

int Dispatch(const std::vector<std::string>& arguments, const Console& console,
             const ClosedLoop& closed_loop) {
  CLI::App app("Polnav: simulation-in-the-loop testbed for polarized-light navigation", "polnav");
  app.set_version_flag("--version", VersionText());
  Parsed parsed;
  app.add_flag("--print-options", parsed.print_options, "Every key of a scenario, and its default");
  app.require_subcommand(0, 1);
  const CLI::App* run = AddRun(app, parsed.run);
  const CLI::App* evaluate = AddEvaluate(app, parsed.evaluate);
  CLI::App* list = app.add_subcommand("list", "Scenarios, estimators and metrics that there are");
  list->add_flag("--schema", parsed.schema, "Print the JSON Schema of scenario files instead");
  try {
    app.parse(std::vector<std::string>(arguments.rbegin(), arguments.rend()));  // CLI11: reversed
  } catch (const CLI::ParseError& error) {
    return app.exit(error, console.out, console.err) == 0 ? kExitHolds : kExitBadInput;
  }
  if (parsed.print_options) {
    console.out << OptionListing(OptionSchema<Scenario>());
    return kExitHolds;
  }
  if (run->parsed()) {
    parsed.run.command_line = Joined(arguments);
    return Run(parsed.run, console, closed_loop);
  }
  if (evaluate->parsed()) return Evaluate(parsed.evaluate, console);
  if (list->parsed() && parsed.schema) {
    Json schema = {{"$schema", "https://json-schema.org/draft/2020-12/schema"},
                   {"title", "Polnav scenario"}};
    schema.update(OptionSchema<Scenario>());
    console.out << schema.dump(2) << "\n";
    return kExitHolds;
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
