#include "tools/testbed/memory_use.h"

#include <fstream>
#include <string>

namespace polnav::testbed {
namespace {

double StatusMb(const std::string& key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);) {
    if (line.starts_with(key)) return std::stod(line.substr(key.size())) / 1024.0;  // given in kB
  }
  return 0.0;
}

}  // namespace

double ResidentMemoryMb() { return StatusMb("VmRSS:"); }

double PeakMemoryMb() { return StatusMb("VmHWM:"); }

}  // namespace polnav::testbed
