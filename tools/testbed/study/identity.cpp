#include "tools/testbed/study/identity.h"

#include <fmt/format.h>

#include "tools/testbed/yaml_document.h"

namespace polnav::testbed {

std::string FirstDifference(const Json& there, const Json& here, const std::string& path) {
  if (there == here) return "";
  if (there.is_object() && here.is_object()) {
    for (const auto& [key, value] : there.items()) {
      const Json other = here.contains(key) ? here[key] : Json();
      if (value != other) return FirstDifference(value, other, JoinKey(path, key));
    }
    for (const auto& [key, value] : here.items()) {
      if (!there.contains(key)) return FirstDifference(Json(), value, JoinKey(path, key));
    }
  }
  if (there.is_array() && here.is_array()) {
    if (there.size() != here.size()) {
      return fmt::format("it has {} {}, this one {}", there.size(), path, here.size());
    }
    for (std::size_t i = 0; i < there.size(); ++i) {
      if (there[i] == here[i]) continue;
      return FirstDifference(there[i], here[i], JoinKey(path, std::to_string(i)));
    }
  }
  if (path.ends_with("scenario_sha256")) return "its scenario has other values (" + path + ")";
  const auto text = [](const Json& value) { return value.is_null() ? "absent" : value.dump(); };
  return fmt::format("{} is {} there and {} here", path, text(there), text(here));
}

}  // namespace polnav::testbed
