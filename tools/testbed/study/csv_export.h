// The metrics of a study as a table for other programs: a line a value.
#pragma once

#include <ostream>

#include "tools/testbed/study/study_table.h"

namespace polnav::testbed {

// trial,case,sample,estimator,metric,value; sorted by estimator and trial. Values
// read back to the same double. Metrics that a trial did not yield are left out; the run's own have
// an empty estimator.
void WriteCsv(const StudyTable& table, std::ostream& out);

// A line a case, estimator and metric, from the aggregate: mean, std and percentiles with the ends
// of their 95 % intervals (empty: unbounded). A paper's figures stand among the means, of one run.
void WriteSummaryCsv(const Json& aggregate, std::ostream& out);

}  // namespace polnav::testbed
