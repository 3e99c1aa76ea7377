// Has somebody asked us to stop? SIGINT, SIGTERM and SIGHUP, held back while the object lives and
// read from a descriptor, so that nothing is ever interrupted half way.
#pragma once

#include <signal.h>

namespace polnav::testbed {

class StopSignals {
 public:
  StopSignals();
  ~StopSignals();  // as it was before; what was not read is delivered
  StopSignals(const StopSignals&) = delete;
  StopSignals& operator=(const StopSignals&) = delete;

  // To poll for reading.
  [[nodiscard]] int fd() const { return fd_; }
  // The signal that came; 0 when none did.
  [[nodiscard]] int Take() const;

 private:
  sigset_t before_{};
  int fd_ = -1;
};

}  // namespace polnav::testbed
