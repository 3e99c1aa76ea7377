// Which dispersed input moves which metric, in each case of a study?
#pragma once

#include <string>
#include <vector>

#include "tools/testbed/option_tree.h"
#include "tools/testbed/study/study_table.h"

namespace polnav::testbed {

// Adds cases[c].estimators.<name>.sensitivity.<metric>.<key>: n, rank_correlation, first_order.
// From the first kSensitivityTrials samples of each case.
void AddSensitivities(const StudyTable& table, const std::vector<std::string>& metrics,
                      Json& cases);

}  // namespace polnav::testbed
