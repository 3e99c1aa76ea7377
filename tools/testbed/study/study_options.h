// What does a study repeat, what does it vary, and what must come out? The keys of a study file.
//
// docs/studies.md has the guide. Files named here are relative to the study file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "tools/testbed/option_range.h"

namespace polnav::testbed {

// Cut off at min and max where they are given (what is left keeps its shape).
struct NormalOptions {
  double mean = 0.0;
  double sigma = 1.0;
  std::optional<double> min;
  std::optional<double> max;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("mean", mean);
    v("sigma", sigma, {.min = 1e-300, .max = 1e300});
    v("min", min);
    v("max", max);
  }
};

// uniform, log_uniform (then min > 0).
struct IntervalOptions {
  double min = 0.0;
  double max = 1.0;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("min", min);
    v("max", max);
  }
};

struct DiscreteOptions {
  std::vector<std::string> values;
  std::vector<double> weights;  // empty: all alike

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("values", values);
    v("weights", weights, {.min = 0.0, .max = 1e300});
  }
};

// Normal variables that move together: covariance, or sigma and correlation.
struct CorrelatedOptions {
  std::vector<double> mean;
  std::vector<double> sigma;
  std::vector<std::vector<double>> correlation;
  std::vector<std::vector<double>> covariance;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("mean", mean);
    v("sigma", sigma, {.min = 1e-300, .max = 1e300});
    v("correlation", correlation, {.min = -1.0, .max = 1.0});
    v("covariance", covariance);
  }
};

// Rows of a CSV file with a header line, one column a key.
struct TableOptions {
  std::string file;
  std::vector<std::string> columns;  // empty: named as the keys
  std::string order = "random";      // with replacement; or row = sample, starting over at the end

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("file", file);
    v("columns", columns);
    v("order", order, {"random", "in_order"});
  }
};

// Exactly one kind; `keys` for what fills several, otherwise `key`.
struct DispersionOptions {
  std::string key;
  std::vector<std::string> keys;
  std::optional<NormalOptions> normal;
  std::optional<IntervalOptions> uniform;
  std::optional<IntervalOptions> log_uniform;
  std::optional<DiscreteOptions> discrete;
  std::optional<CorrelatedOptions> correlated;
  std::optional<TableOptions> table;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("key", key);
    v("keys", keys);
    v("normal", normal);
    v("uniform", uniform);
    v("log_uniform", log_uniform);
    v("discrete", discrete);
    v("correlated", correlated);
    v("table", table);
  }
};

// A named set of changes; each scenario is run in each variant.
struct VariantOptions {
  std::string name;
  std::vector<std::string> set;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("name", name);
    v("set", set);
  }
};

// Errors over time that are kept for the report.
struct SeriesOptions {
  int points = 101;
  int samples = 1000;  // the first so many of each case

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("points", points, {.min = 2, .max = 10'000});
    v("samples", samples, {.min = 0, .max = 1e9});
  }
};

// One sentence about a statistic over the trials of a case that went ok. It must hold in every
// case, or in those of one scenario or variant.
struct StudyCriterion {
  std::string name;
  std::string scenario;  // its name; empty: all
  std::string variant;
  std::string estimator;
  std::string metric;  // heading_deg.rmse; none for ok_rate
  std::string statistic = "mean";
  // success_rate: the share of trials whose metric lies between these.
  std::optional<double> success_at_least;
  std::optional<double> success_at_most;
  std::optional<double> at_most;
  std::optional<double> at_least;
  // Another estimator: the statistic of the paired difference to it is below zero.
  std::string below;
  // value: what was measured; interval: the whole 95 % interval.
  std::string judge = "value";

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("name", name);
    v("scenario", scenario);
    v("variant", variant);
    v("estimator", estimator);
    v("metric", metric);
    v("statistic", statistic,
      {"mean", "median", "std", "min", "max", "p05", "p25", "p75", "p90", "p95", "p99",
       "success_rate", "ok_rate"});
    v("success_at_least", success_at_least);
    v("success_at_most", success_at_most);
    v("at_most", at_most);
    v("at_least", at_least);
    v("below", below);
    v("judge", judge, {"value", "interval"});
  }
};

// Something to be known to within a half-width of its 95 % interval before the study ends, in every
// case or in those of one scenario or variant.
struct StudyStopOptions {
  std::string scenario;
  std::string variant;
  std::string estimator;
  std::string metric;
  std::string minus;  // another estimator: of the paired difference to it
  std::string statistic = "mean";
  std::optional<double> success_at_least;  // success_rate, as in criteria
  std::optional<double> success_at_most;
  // One of the two: in the metric's unit, or as a share of the statistic's magnitude.
  std::optional<double> half_width;
  std::optional<double> relative_half_width;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("scenario", scenario);
    v("variant", variant);
    v("estimator", estimator);
    v("metric", metric);
    v("minus", minus);
    v("statistic", statistic, {"mean", "median", "success_rate"});
    v("success_at_least", success_at_least);
    v("success_at_most", success_at_most);
    v("half_width", half_width, {.min = 1e-300, .max = 1e300});
    v("relative_half_width", relative_half_width, {.min = 1e-6, .max = 1.0});
  }
};

struct StudyOptions {
  std::string name;
  std::string description;
  std::vector<std::string> scenarios;
  std::vector<VariantOptions> variants;  // empty: the scenario as it is
  NamedLists grid;                       // key: [values]; all combinations
  std::vector<std::string> estimators;   // empty: as each scenario says
  int trials = 100;                      // of each case; with `stop`, at most
  std::uint64_t seed = 1;
  std::string level = "image";
  std::optional<double> duration_s;
  std::vector<std::string> set;  // key.path=value, in all cases
  std::string sampling = "random";
  std::vector<DispersionOptions> dispersions;
  double time_limit_s = 3600.0;     // of a trial, wall time
  double memory_limit_mb = 4096.0;  // of a trial
  SeriesOptions series;
  std::vector<StudyStopOptions> stop;  // empty: after all trials; else when all of these are known
  std::vector<StudyCriterion> criteria;

  template <typename Visitor>
  void Visit(Visitor& v) {
    v("name", name);
    v("description", description);
    v("scenarios", scenarios);
    v("variants", variants);
    v("grid", grid);
    v("estimators", estimators);
    v("trials", trials, {.min = 1, .max = 1e9});
    v("seed", seed);
    v("level", level, {"image", "measurement"});
    v("duration_s", duration_s, {.min = 0.001, .max = 86400.0});
    v("set", set);
    v("sampling", sampling, {"random", "latin_hypercube", "sobol"});
    v("dispersions", dispersions);
    v("time_limit_s", time_limit_s, {.min = 0.01, .max = 1e7});
    v("memory_limit_mb", memory_limit_mb, {.min = 64.0, .max = 1e9});
    v("series", series);
    v("stop", stop);
    v("criteria", criteria);
  }
};

}  // namespace polnav::testbed
