// How much memory does this process use? From /proc/self/status; for reports only.
#pragma once

namespace polnav::testbed {

[[nodiscard]] double ResidentMemoryMb();  // now [MiB]
[[nodiscard]] double PeakMemoryMb();      // at most so far [MiB]

}  // namespace polnav::testbed
