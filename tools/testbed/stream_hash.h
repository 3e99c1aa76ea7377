// Which bytes of a measurement count as its stream? Stamps and readings, in the order of the
// struct's fields; images row by row.
#pragma once

#include "nav/api/measurements.h"
#include "sim/truth.h"
#include "tools/testbed/hash.h"

namespace polnav::testbed {

void HashMeasurement(const nav::Measurement& measurement, Sha256& hash);
void HashTruth(const sim::Truth& truth, Sha256& hash);

}  // namespace polnav::testbed
