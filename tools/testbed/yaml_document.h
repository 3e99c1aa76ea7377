// What does this YAML file say, and on which line?
//
// A parsed tree that remembers its file and what the command line changed in it, so that an error
// names whichever of the two is to blame. Key paths are dotted; list items count from 0:
// sensors.imu.rate_hz, criteria.2.metric.
#pragma once

#include <yaml-cpp/yaml.h>

#include <filesystem>
#include <map>
#include <string>

namespace polnav::testbed {

struct YamlDocument {
  std::string file;
  YAML::Node root;
  std::map<std::string, std::string> overrides;  // key path -> what on the command line set it
};

// Throw InputError: no such file, not YAML, empty, the same key twice in one section.
[[nodiscard]] YamlDocument ReadYaml(const std::filesystem::path& path);
[[nodiscard]] YamlDocument ParseYaml(const std::string& text, const std::string& file);

// "key.path=value", the value being YAML; null removes a section. Sections on the way are made.
// source: how the user said it, for errors ("--set sky.model=berry", "--duration 5").
void ApplyOverride(YamlDocument& document, const std::string& assignment,
                   const std::string& source);

// Throws the InputError about a key, which need not exist: then the line is its section's.
[[noreturn]] void FailAt(const YamlDocument& document, const std::string& key_path,
                         const std::string& message);

[[nodiscard]] std::string JoinKey(const std::string& section, const std::string& key);

}  // namespace polnav::testbed
