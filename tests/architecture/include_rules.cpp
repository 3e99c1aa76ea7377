#include "tests/architecture/include_rules.h"

#include <algorithm>
#include <regex>
#include <string_view>

namespace polnav::architecture {
namespace {

// Prefixes of includes. The C++ standard library is open to all; what is not listed is refused.
struct Rule {
  std::string_view folder;
  std::vector<std::string_view> allowed;
  std::vector<std::string_view> refused;  // stronger than allowed
};

// The first rule whose folder a path starts with holds: special folders stand before general ones.
const std::vector<Rule>& Rules() {
  static const std::vector<Rule> rules = {
      {"sky/", {"Eigen/", "erfa", "sky/"}, {}},
      {"nav/api/", {"Eigen/", "opencv2/core", "nav/api/"}, {}},
      // An estimator that knew the simulated sky would invert its own simulator.
      {"nav/",
       {"Eigen/", "opencv2/", "ceres/", "fmt/", "nav/", "sky/"},
       {"sky/skylight.h", "sky/clear_sky.h", "sky/berry.h", "sky/haz", "sky/sky_batch.h",
        "sky/neutral_points.h", "sky/clouds.h", "sky/lattice_noise.h", "sky/stokes_axes.h"}},
      {"sim/vehicle/",
       {"Eigen/", "fmt/", "nav/api/", "sky/", "sim/", "bt", "Bullet"},
       {"sim/render/"}},
      // Rays against the scene are Bullet's; its dynamics is the vehicle's business.
      {"sim/world/",
       {"Eigen/", "opencv2/", "fmt/", "nav/api/", "sim/", "assimp/", "BulletCollision/"},
       {"sim/vehicle/", "sim/render/", "sim/sensors/"}},
      {"sim/render/",
       {"Eigen/", "opencv2/", "fmt/", "nav/api/", "sky/", "sim/", "GL/"},
       {"sim/vehicle/"}},
      {"sim/", {"Eigen/", "opencv2/", "fmt/", "nav/api/", "sky/", "sim/"}, {}},
      // The library does not know its command line.
      {"tools/testbed/", {""}, {"tools/polnav/", "tests/"}},
      {"tools/", {""}, {"tests/"}},
      {"tests/", {""}, {}},
  };
  return rules;
}

bool StartsWithAny(std::string_view text, const std::vector<std::string_view>& prefixes) {
  return std::any_of(prefixes.begin(), prefixes.end(),
                     [&](std::string_view prefix) { return text.starts_with(prefix); });
}

bool IsStandardLibrary(const Include& include) {
  return !include.quoted && include.target.find_first_of("./") == std::string::npos;
}

bool IsOurs(std::string_view target) {
  return StartsWithAny(target, {"sky/", "nav/", "sim/", "tools/", "tests/"});
}

}  // namespace

std::vector<Include> IncludesOf(const std::string& text) {
  static const std::regex line(R"((?:^|\n)[ \t]*#[ \t]*include[ \t]*([<"])([^>"\n]+)[>"])");
  std::vector<Include> includes;
  for (std::sregex_iterator it(text.begin(), text.end(), line), end; it != end; ++it) {
    includes.push_back({(*it)[2].str(), (*it)[1].str() == "\""});
  }
  return includes;
}

std::vector<std::string> IncludeViolations(const SourceFile& file) {
  const auto rule = std::find_if(Rules().begin(), Rules().end(), [&](const Rule& candidate) {
    return file.path.starts_with(candidate.folder);
  });
  if (rule == Rules().end()) return {file.path + " is in no folder that has an include rule"};
  std::vector<std::string> violations;
  for (const Include& include : IncludesOf(file.text)) {
    if (IsStandardLibrary(include)) continue;
    const bool allowed = StartsWithAny(include.target, rule->allowed) &&
                         !StartsWithAny(include.target, rule->refused);
    if (!allowed) {
      violations.push_back(file.path + " must not include " + include.target);
    } else if (include.quoted != IsOurs(include.target)) {
      violations.push_back(
          file.path +
          ": ours in quotes from the project's folder, others' in <>: " + include.target);
    }
  }
  return violations;
}

}  // namespace polnav::architecture
