// Which nanosecond does this text mean? Decimal seconds, "1403636579.763555527" or "1.037000e-01",
// digit by digit: 1.6e18 ns does not fit into the 53 bits of a double.
#pragma once

#include <optional>
#include <string_view>

#include "nav/api/time.h"

namespace polnav::testbed {

// Rounded to the nearest nanosecond. Nothing when the text is no number or beyond 292 years.
[[nodiscard]] std::optional<nav::TimeNs> ParseDecimalSeconds(std::string_view text);

}  // namespace polnav::testbed
