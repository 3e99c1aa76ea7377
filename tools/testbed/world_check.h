// Can this world be built?
#pragma once

#include "sim/world/world.h"
#include "tools/testbed/yaml_document.h"

namespace polnav::testbed {

// A scene file's path is relative to the scenario file: tells the world where that is.
void ResolveSceneFile(const YamlDocument& document, sim::WorldOptions& world);

// Throws InputError: a structure off the track or where it cannot stand, an actor without a way to
// go, a scene file that is missing, empty or lacks a texture (it is read for that).
void CheckWorld(const YamlDocument& document, const sim::WorldOptions& world);

}  // namespace polnav::testbed
