#include <unistd.h>

#include <iostream>

#include "tools/polnav/command_line.h"

int main(int argc, char** argv) {
  using namespace polnav::testbed;
  const Console console{std::cout, std::cerr, ::isatty(STDERR_FILENO) == 1};
  return RunCommandLine({argv + 1, argv + argc}, console, RunClosedLoop);
}
