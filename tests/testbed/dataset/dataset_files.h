// Datasets to test with: small, synthetic, written into a temporary folder.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "nav/api/calibration.h"
#include "nav/api/measurements.h"
#include "sim/truth.h"
#include "tools/testbed/dataset/dataset.h"
#include "tools/testbed/scenario.h"

namespace polnav::testbed {

// All sensors on board, with small pictures.
[[nodiscard]] Scenario SmallScenario();

// Half a second of every stream, in the simulator's order; numbers that no short decimal has.
[[nodiscard]] std::vector<DatasetItem> SmallRecording(const Scenario& scenario);

// As `polnav run --record` would leave it; its rig is sim::NominalRig's.
void WriteRecording(const std::filesystem::path& folder, const Scenario& scenario,
                    const std::vector<DatasetItem>& items);

// The same as somebody else's dataset: no scenario.yaml, no sign of Polnav.
void MakeForeign(const std::filesystem::path& folder);

[[nodiscard]] std::vector<DatasetItem> ReadAll(Dataset& dataset);

// A KITTI sequence: a textured wall 20 m ahead, the camera stands still; `frames` pictures at 10
// Hz.
void WriteKitti(const std::filesystem::path& folder, int frames, bool with_truth);

[[nodiscard]] std::string ReadText(const std::filesystem::path& file);
void WriteText(const std::filesystem::path& file, const std::string& text);
// Throws std::logic_error when `what` is not there.
void Replace(const std::filesystem::path& file, const std::string& what, const std::string& with);

}  // namespace polnav::testbed
