// What does each command do, once its arguments are understood?
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/polnav/command_line.h"
#include "tools/polnav/console.h"

namespace polnav::testbed {

struct RunArguments {
  std::string scenario;
  std::string out;                  // empty: out/<scenario's file name>
  std::optional<std::string> seed;  // checked with the scenario, as every option is
  std::vector<std::string> set;
  std::vector<std::string> estimators;  // empty: as the scenario says
  std::optional<std::string> duration_s;
  std::string level = "image";
  int render_threads = 1;
  bool quiet = false;
  bool json = false;
  std::string command_line;  // as typed, for the report
};

struct EvaluateArguments {
  std::string truth;
  std::string estimate;
  std::string align = "none";
  bool json = false;
};

// Simulate, estimate, score; write and print the results.
[[nodiscard]] int Run(const RunArguments& arguments, const Console& console,
                      const ClosedLoop& closed_loop);

// Compare two TUM files.
[[nodiscard]] int Evaluate(const EvaluateArguments& arguments, const Console& console);

// Scenarios, estimators, metrics.
[[nodiscard]] int List(const Console& console);

}  // namespace polnav::testbed
