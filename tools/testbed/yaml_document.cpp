#include "tools/testbed/yaml_document.h"

#include <fmt/format.h>

#include <fstream>
#include <set>
#include <sstream>
#include <vector>

#include "tools/testbed/input_error.h"

namespace polnav::testbed {
namespace {

// Far above any scenario; an alias that contains itself would otherwise never end.
constexpr int kMaxNodes = 100'000;
constexpr int kMaxDepth = 40;

std::vector<std::string> SplitKey(const std::string& key_path) {
  std::vector<std::string> parts;
  std::stringstream stream(key_path);
  for (std::string part; std::getline(stream, part, '.');) parts.push_back(part);
  return parts;
}

int LineOf(const YAML::Node& node) { return node.Mark().is_null() ? 0 : node.Mark().line + 1; }

std::string KeyText(const YAML::Node& key) { return key.IsScalar() ? key.Scalar() : "?"; }

class StructureCheck {
 public:
  explicit StructureCheck(const std::string& file) : file_(file) {}

  void Walk(const YAML::Node& node, const std::string& path, int depth) {
    if (++nodes_ > kMaxNodes || depth > kMaxDepth) {
      throw InputError(file_, LineOf(node), path, "too deep or too large; does an alias loop?");
    }
    if (node.IsSequence()) {
      for (std::size_t i = 0; i < node.size(); ++i) {
        Walk(node[i], JoinKey(path, std::to_string(i)), depth + 1);
      }
    }
    if (!node.IsMap()) return;
    std::set<std::string> seen;
    for (const auto& entry : node) {
      const std::string key = JoinKey(path, KeyText(entry.first));
      if (!seen.insert(key).second) {
        throw InputError(file_, LineOf(entry.first), key, "this key is given twice");
      }
      Walk(entry.second, key, depth + 1);
    }
  }

 private:
  const std::string& file_;
  int nodes_ = 0;
};

void CheckAssignable(const YAML::Node& node, const std::string& source, const std::string& part) {
  if (node.IsScalar()) {
    throw InputError(source, 0, "",
                     fmt::format("'{}' is below a plain value, not in a section", part));
  }
  if (!node.IsSequence()) return;
  const bool is_index = part.find_first_not_of("0123456789") == std::string::npos;
  if (!is_index || part.size() > 6 || std::stoul(part) >= node.size()) {
    throw InputError(
        source, 0, "",
        fmt::format("'{}' is not one of the list's {} items (counted from 0)", part, node.size()));
  }
}

void Assign(YAML::Node node, const std::vector<std::string>& parts, std::size_t depth,
            const YAML::Node& value, const std::string& source) {
  const std::string& part = parts[depth];
  CheckAssignable(node, source, part);
  const bool last = depth + 1 == parts.size();
  if (node.IsSequence()) {
    const std::size_t index = std::stoul(part);
    if (last) {
      node[index] = value;
    } else {
      Assign(node[index], parts, depth + 1, value, source);
    }
  } else if (last) {
    node[part] = value;
  } else {
    Assign(node[part], parts, depth + 1, value, source);
  }
}

}  // namespace

std::string JoinKey(const std::string& section, const std::string& key) {
  return section.empty() ? key : section + "." + key;
}

YamlDocument ParseYaml(const std::string& text, const std::string& file) {
  YamlDocument document{.file = file, .root = {}, .overrides = {}};
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(text);
    if (documents.empty() || documents.front().IsNull()) throw InputError(file, 0, "", "is empty");
    if (documents.size() > 1) throw InputError(file, 0, "", "holds more than one YAML document");
    document.root = documents.front();
  } catch (const YAML::Exception& e) {
    throw InputError(file, e.mark.is_null() ? 0 : e.mark.line + 1, "", "not YAML: " + e.msg);
  }
  StructureCheck(document.file).Walk(document.root, "", 0);
  return document;
}

YamlDocument ReadYaml(const std::filesystem::path& path) {
  if (!std::filesystem::exists(path)) throw InputError(path.string(), 0, "", "no such file");
  std::ifstream stream(path, std::ios::binary);
  std::stringstream text;
  // A folder opens, but does not read.
  if (!stream || !(text << stream.rdbuf())) {
    if (std::filesystem::is_regular_file(path) && std::filesystem::is_empty(path)) {
      throw InputError(path.string(), 0, "", "is empty");
    }
    throw InputError(path.string(), 0, "", "cannot be read");
  }
  return ParseYaml(text.str(), path.string());
}

void ApplyOverride(YamlDocument& document, const std::string& assignment,
                   const std::string& source) {
  const std::size_t equals = assignment.find('=');
  const std::string key_path = assignment.substr(0, equals);
  const std::vector<std::string> parts = SplitKey(key_path);
  bool valid = equals != std::string::npos && !parts.empty() && key_path.back() != '.';
  for (const std::string& part : parts) valid = valid && !part.empty();
  if (!valid) throw InputError(source, 0, "", "expected key.path=value");
  const YamlDocument value = [&] {
    const std::string text = assignment.substr(equals + 1);
    if (text.empty()) throw InputError(source, 0, "", "the value is missing");
    if (text == "null" || text == "~") return YamlDocument{.file = "", .root = {}, .overrides = {}};
    return ParseYaml(text, source);
  }();
  Assign(document.root, parts, 0, value.root, source);
  document.overrides[key_path] = source;
}

void FailAt(const YamlDocument& document, const std::string& key_path, const std::string& message) {
  // The command line is to blame when it set the key or something above it.
  for (const auto& [path, source] : document.overrides) {
    const bool below = (key_path + ".").starts_with(path + ".");
    if (below) throw InputError(source, 0, key_path, message);
  }
  int line = 0;
  YAML::Node node = document.root;
  for (const std::string& part : SplitKey(key_path)) {
    YAML::Node next;
    bool found = false;
    if (node.IsMap()) {
      for (const auto& entry : node) {
        if (KeyText(entry.first) != part) continue;
        line = LineOf(entry.first) > 0 ? LineOf(entry.first) : line;
        next.reset(entry.second);
        found = true;
      }
    } else if (node.IsSequence() && part.find_first_not_of("0123456789") == std::string::npos &&
               std::stoul(part) < node.size()) {
      next.reset(node[std::stoul(part)]);
      line = LineOf(next);
      found = true;
    }
    if (!found) break;
    node.reset(next);
  }
  throw InputError(document.file, line, key_path, message);
}

}  // namespace polnav::testbed
