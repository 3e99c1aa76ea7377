#include "tools/testbed/option_tree.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <cmath>

#include "tools/testbed/yaml_document.h"

namespace polnav::testbed {
namespace {

bool IsPlainList(const Json& values) {
  for (const Json& item : values) {
    if (item.is_structured()) return false;
  }
  return true;
}

// A string that would read back as something else, or span lines, goes into quotes.
void EmitString(YAML::Emitter& out, const std::string& text) {
  const bool ambiguous = text.empty() || text == "null" || text == "~" || text == "true" ||
                         text == "false" ||
                         text.find_first_not_of("+-.0123456789eE") == std::string::npos;
  if (ambiguous) {
    out << YAML::DoubleQuoted << text;
  } else if (text.find('\n') != std::string::npos) {
    out << YAML::Literal << text;
  } else {
    out << text;
  }
}

void Emit(YAML::Emitter& out, const Json& value) {
  if (value.is_object()) {
    out << YAML::BeginMap;
    for (const auto& [key, item] : value.items()) {
      out << YAML::Key << key << YAML::Value;
      Emit(out, item);
    }
    out << YAML::EndMap;
  } else if (value.is_array()) {
    if (IsPlainList(value)) out << YAML::Flow;
    out << YAML::BeginSeq;
    for (const Json& item : value) Emit(out, item);
    out << YAML::EndSeq;
  } else if (value.is_string()) {
    EmitString(out, value.get<std::string>());
  } else if (value.is_number_float()) {
    out << fmt::format("{}", value.get<double>());
  } else {
    out << value.dump();
  }
}

std::string Allowed(const Json& schema) {
  if (schema.contains("enum")) {
    std::string text;
    for (const Json& choice : schema["enum"]) {
      text += (text.empty() ? "" : " | ") + choice.get<std::string>();
    }
    return text;
  }
  const Json& numbers = schema.contains("items") ? schema["items"] : schema;
  OptionRange range;
  if (numbers.contains("minimum")) range.min = numbers["minimum"].get<double>();
  if (numbers.contains("maximum")) range.max = numbers["maximum"].get<double>();
  return RangeText(range);
}

void ListKeys(const Json& schema, const std::string& path, std::string& text) {
  for (const auto& [key, entry] : schema["properties"].items()) {
    const std::string here = JoinKey(path, key);
    if (entry.contains("properties")) {
      if (entry["type"].is_array()) text += fmt::format("{:<58} off unless given\n", here);
      ListKeys(entry, here, text);
    } else if (entry.contains("items") && entry["items"].contains("properties")) {
      ListKeys(entry["items"], here + "[]", text);
    } else {
      const std::string value = entry.contains("default") ? entry["default"].dump() : "-";
      text += fmt::format("{:<58} {:<26} {}", here, value, Allowed(entry));
      text.erase(text.find_last_not_of(' ') + 1);
      text += "\n";
    }
  }
}

}  // namespace

void SchemaWriter::AddRange(Json& schema, const OptionRange& range) {
  if (std::isfinite(range.min)) schema["minimum"] = range.min;
  if (std::isfinite(range.max)) schema["maximum"] = range.max;
}

std::string ToYaml(const Json& values) {
  YAML::Emitter out;
  Emit(out, values);
  return std::string(out.c_str()) + "\n";
}

std::string OptionListing(const Json& schema) {
  std::string text;
  ListKeys(schema, "", text);
  return text;
}

}  // namespace polnav::testbed
