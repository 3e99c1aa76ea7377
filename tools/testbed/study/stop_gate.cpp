#include "tools/testbed/study/stop_gate.h"

#include "tools/testbed/statistics/stopping.h"

namespace polnav::testbed {

StopGate::StopGate(std::uint64_t cases, std::vector<bool> written, Look look)
    : cases_(cases),
      written_(std::move(written)),
      look_(std::move(look)),
      next_look_(look_ ? NextLook(0) : written_.size()) {
  DecideLooks();
}

void StopGate::Add(TrialRecord record) {
  const std::uint64_t trial = record.trial;
  if (!ended_at_) waiting_.emplace(trial, std::move(record));
}

std::vector<TrialRecord> StopGate::Take() {
  std::vector<TrialRecord> taken;
  while (!waiting_.empty() && waiting_.begin()->first < next_look_ * cases_) {
    taken.push_back(std::move(waiting_.begin()->second));
    waiting_.erase(waiting_.begin());
  }
  return taken;
}

void StopGate::Written(const std::vector<TrialRecord>& records) {
  for (const TrialRecord& record : records) written_[record.trial] = true;
  DecideLooks();
}

void StopGate::DecideLooks() {
  if (!look_) return;
  while (!ended_at_) {
    while (first_open_ < written_.size() && written_[first_open_]) ++first_open_;
    if (first_open_ < next_look_ * cases_) return;
    if (look_(next_look_)) {
      ended_at_ = next_look_;
      waiting_.clear();
    } else {
      next_look_ = NextLook(next_look_);
    }
  }
}

}  // namespace polnav::testbed
