// What is in this KITTI odometry sequence [Geiger2012]?
//
// calib.txt (P0, P1: the rectified pair), times.txt [s], image_0 and image_1, poses.txt where the
// truth is known. Truth there is T_0k of the left camera C; here
//   B  sits in the left camera: x forward = C's z, y left = -C's x, z up = -C's y
//   W  is B at the first pose; the sequence does not tell where up or north really is
// Pictures are rectified: no distortion, both cameras look the same way.
#pragma once

#include <filesystem>
#include <optional>

#include "tools/testbed/dataset/dataset.h"
#include "tools/testbed/dataset/rig_file.h"

namespace polnav::testbed {

[[nodiscard]] bool IsKitti(const std::filesystem::path& folder);

[[nodiscard]] Dataset OpenKitti(const std::filesystem::path& folder,
                                const std::optional<RigFile>& rig_file);

}  // namespace polnav::testbed
