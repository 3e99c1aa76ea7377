// What is in this EuRoC folder [Burri2016]? See docs/datasets.md.
//
// Polnav's own recordings are taken as they are; of anything else the body's axes are renamed
// (body_axes.h) and the time counts from the first stamp.
#pragma once

#include <filesystem>
#include <optional>

#include "tools/testbed/dataset/dataset.h"
#include "tools/testbed/dataset/rig_file.h"

namespace polnav::testbed {

// The folder itself or the mav0 in it; empty when it is no such dataset.
[[nodiscard]] std::filesystem::path FindMav0(const std::filesystem::path& folder);

[[nodiscard]] Dataset OpenEuroc(const std::filesystem::path& mav0,
                                const std::optional<RigFile>& rig_file);

}  // namespace polnav::testbed
