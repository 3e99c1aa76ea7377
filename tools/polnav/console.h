// How does a command talk to a person or to a machine?
#pragma once

#include <ostream>
#include <string>
#include <vector>

namespace polnav::testbed {

struct Console {
  std::ostream& out;             // what was asked for
  std::ostream& err;             // progress and complaints
  bool err_is_terminal = false;  // a bar that moves, or plain lines
};

// Progress of a long command: a bar on a terminal, a line every 10 % otherwise, nothing when quiet.
class Progress {
 public:
  Progress(const Console& console, std::string label, bool quiet);
  void Show(double fraction);
  void Finish();

 private:
  const Console& console_;
  std::string label_;
  bool quiet_;
  int shown_percent_ = -1;
};

// Columns aligned: the first to the left, the others to the right.
class TextTable {
 public:
  explicit TextTable(std::vector<std::string> header) : rows_{std::move(header)} {}
  void Add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  [[nodiscard]] std::string Text() const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace polnav::testbed
