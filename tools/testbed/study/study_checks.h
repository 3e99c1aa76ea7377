// Does a study mean anything, beyond each of its keys by itself?
#pragma once

#include <vector>

#include "tools/testbed/study/study_plan.h"

namespace polnav::testbed {

// Throw InputError.

// Every value that can be drawn lies within the range of its key; samples: that will be drawn.
void CheckDispersionRange(const YamlDocument& document, const Dispersion& dispersion,
                          const UnitSampler& sampler, std::size_t first_dimension,
                          std::uint64_t samples);

// A key differs by one dispersion or by the grid, not by two of them.
void CheckInputKeys(const YamlDocument& document, const std::vector<Dispersion>& dispersions,
                    const NamedLists& grid);

// Names, metrics and estimators of the criteria.
void CheckStudyCriteria(const YamlDocument& document, const std::vector<StudyCriterion>& criteria,
                        const std::vector<StudyCase>& cases);

// Sequential stopping: of independent trials, at looks that come before the last trial.
void CheckStudyStop(const YamlDocument& document, const StudyOptions& options,
                    const std::vector<StudyCase>& cases);

}  // namespace polnav::testbed
