// A result file of a study whose answers are known: a linear problem, without a simulator.
//
// One case. Inputs a and b are standard normal. Estimator `first` has heading_deg.rmse
// 5 + 2 a + b + 2 e with e standard normal: variance 9, of which a explains 4/9 and b 1/9.
// `second` has one more, and as many again of noise of its own, 0.5 f. nees.position is chi-square
// of 3 degrees of freedom for `first`, and twice that for `second`. Every 50th trial failed.
#pragma once

#include <SQLiteCpp/SQLiteCpp.h>

#include <cstdint>
#include <string>

namespace polnav::testbed {

struct ExampleStudyOptions {
  std::uint64_t trials = 200;
  bool backwards = false;  // the order in which they are written
  bool series = true;
  bool paper = false;    // that the case has figures of one
  int more_metrics = 0;  // as many columns of noise
  std::string criteria = "[]";
};

void FillExampleStudy(SQLite::Database& db, const ExampleStudyOptions& options);

}  // namespace polnav::testbed
