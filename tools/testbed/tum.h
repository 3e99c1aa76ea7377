// How does a trajectory go into a text file, and come back?
//
// The TUM RGB-D format that evo and others read: `t x y z qx qy qz qw` a line, seconds and metres,
// T_WB, `#` starts a comment. Stamps are written and read digit by digit, so that nanoseconds
// survive however large the epoch; poses come back to 1e-12.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "tools/testbed/trajectory.h"

namespace polnav::testbed {

[[nodiscard]] std::string ToTum(const Trajectory& trajectory);

// Throw InputError with file and line: a missing, malformed or non-finite number, a quaternion that
// is not of unit length (to 1 %), stamps that do not increase, no pose at all.
[[nodiscard]] Trajectory ParseTum(std::string_view text, const std::string& file);
[[nodiscard]] Trajectory ReadTum(const std::filesystem::path& path);

}  // namespace polnav::testbed
