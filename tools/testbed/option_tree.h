// What are these options, written down, and which would be valid?
//
// Two visitors over the same Visit that loads them: values as a tree (to YAML or JSON), and a JSON
// Schema (draft 2020-12), from which editors complete and check scenario files.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/testbed/option_range.h"

namespace polnav::testbed {

using Json = nlohmann::ordered_json;

class ValueWriter {
 public:
  void operator()(const char* key, double& value, OptionRange = {}) { tree_[key] = value; }
  void operator()(const char* key, int& value, OptionRange = {}) { tree_[key] = value; }
  void operator()(const char* key, std::uint64_t& value) { tree_[key] = value; }
  void operator()(const char* key, bool& value) { tree_[key] = value; }
  void operator()(const char* key, std::string& value) { tree_[key] = value; }
  void operator()(const char* key, std::string& value, OptionChoices) { tree_[key] = value; }
  void operator()(const char* key, std::vector<std::string>& value) { tree_[key] = value; }
  void operator()(const char* key, std::vector<std::string>& value, OptionChoices) {
    tree_[key] = value;
  }
  void operator()(const char* key, Eigen::Vector3d& value, OptionRange = {}) {
    tree_[key] = {value.x(), value.y(), value.z()};
  }
  void operator()(const char* key, std::vector<Eigen::Vector2d>& value, OptionRange = {}) {
    tree_[key] = Json::array();
    for (const Eigen::Vector2d& p : value) tree_[key].push_back({p.x(), p.y()});
  }
  void operator()(const char* key, std::vector<double>& value, OptionRange = {}) {
    tree_[key] = value;
  }
  void operator()(const char* key, std::vector<std::vector<double>>& rows, OptionRange = {}) {
    tree_[key] = rows;
  }
  void operator()(const char* key, NamedLists& lists) {
    tree_[key] = Json::object();
    for (const NamedLists::Item& item : lists.items) tree_[key][item.name] = item.values;
  }
  void operator()(const char* key, std::optional<double>& value, OptionRange = {}) {
    if (value) tree_[key] = *value;
  }
  template <typename T>
  void operator()(const char* key, std::optional<T>& section) {
    if (section) (*this)(key, *section);
  }
  template <typename T>
  void operator()(const char* key, std::vector<T>& list) {
    tree_[key] = Json::array();
    for (T& item : list) {
      ValueWriter writer;
      item.Visit(writer);
      tree_[key].push_back(writer.tree());
    }
  }
  template <typename T>
  void operator()(const char* key, T& section) {
    ValueWriter writer;
    section.Visit(writer);
    tree_[key] = writer.tree();
  }

  [[nodiscard]] const Json& tree() const { return tree_; }

 private:
  Json tree_ = Json::object();
};

class SchemaWriter {
 public:
  void operator()(const char* key, double& value, OptionRange range = {}) {
    Add(key, {{"type", "number"}, {"default", value}}, range);
  }
  void operator()(const char* key, std::optional<double>&, OptionRange range = {}) {
    Add(key, {{"type", {"number", "null"}}}, range);
  }
  void operator()(const char* key, int& value, OptionRange range = {}) {
    Add(key, {{"type", "integer"}, {"default", value}}, range);
  }
  void operator()(const char* key, std::uint64_t& value) {
    Add(key, {{"type", "integer"}, {"default", value}}, {.min = 0.0});
  }
  void operator()(const char* key, bool& value) {
    Add(key, {{"type", "boolean"}, {"default", value}});
  }
  void operator()(const char* key, std::string& value) {
    Add(key, {{"type", "string"}, {"default", value}});
  }
  void operator()(const char* key, std::string& value, OptionChoices choices) {
    Add(key, {{"type", "string"}, {"enum", Names(choices)}, {"default", value}});
  }
  void operator()(const char* key, std::vector<std::string>& value) {
    Add(key, {{"type", {"array", "string"}}, {"items", {{"type", "string"}}}, {"default", value}});
  }
  void operator()(const char* key, std::vector<std::string>& value, OptionChoices choices) {
    const Json item = {{"type", "string"}, {"enum", Names(choices)}};
    Add(key,
        {{"anyOf", Json::array({item, {{"type", "array"}, {"items", item}}})}, {"default", value}});
  }
  void operator()(const char* key, Eigen::Vector3d& value, OptionRange range = {}) {
    Json item = {{"type", "number"}};
    AddRange(item, range);
    Add(key, {{"type", "array"},
              {"items", item},
              {"minItems", 3},
              {"maxItems", 3},
              {"default", {value.x(), value.y(), value.z()}}});
  }
  void operator()(const char* key, std::vector<Eigen::Vector2d>&, OptionRange range = {}) {
    Json number = {{"type", "number"}};
    AddRange(number, range);
    Add(key, {{"type", "array"},
              {"items", {{"type", "array"}, {"items", number}, {"minItems", 2}, {"maxItems", 2}}}});
  }
  void operator()(const char* key, std::vector<double>&, OptionRange range = {}) {
    Add(key, {{"type", "array"}, {"items", NumberSchema(range)}});
  }
  void operator()(const char* key, std::vector<std::vector<double>>&, OptionRange range = {}) {
    Add(key, {{"type", "array"}, {"items", {{"type", "array"}, {"items", NumberSchema(range)}}}});
  }
  void operator()(const char* key, NamedLists&) {
    Add(key, {{"type", "object"}, {"additionalProperties", {{"type", "array"}, {"minItems", 1}}}});
  }
  template <typename T>
  void operator()(const char* key, std::optional<T>& section) {
    T value = section.value_or(T{});
    Json schema = SectionSchema(value);
    schema["type"] = {"object", "null"};
    Add(key, schema);
  }
  template <typename T>
  void operator()(const char* key, std::vector<T>&) {
    T item;
    Add(key, {{"type", "array"}, {"items", SectionSchema(item)}});
  }
  template <typename T>
  void operator()(const char* key, T& section) {
    Add(key, SectionSchema(section));
  }

  [[nodiscard]] Json Schema() const {
    return {{"type", "object"}, {"additionalProperties", false}, {"properties", properties_}};
  }

 private:
  template <typename T>
  static Json SectionSchema(T& section) {
    SchemaWriter writer;
    section.Visit(writer);
    return writer.Schema();
  }
  static Json NumberSchema(const OptionRange& range) {
    Json number = {{"type", "number"}};
    AddRange(number, range);
    return number;
  }
  static std::vector<std::string> Names(OptionChoices choices) {
    return {choices.begin(), choices.end()};
  }
  void Add(const char* key, Json schema, OptionRange range = {}) {
    AddRange(schema, range);
    properties_[key] = std::move(schema);
  }
  static void AddRange(Json& schema, const OptionRange& range);

  Json properties_ = Json::object();
};

// The struct is taken by value: Visit hands out references to its fields.
template <typename T>
[[nodiscard]] Json OptionValues(T options) {
  ValueWriter writer;
  options.Visit(writer);
  return writer.tree();
}

template <typename T>
[[nodiscard]] Json OptionSchema() {
  T options;
  SchemaWriter writer;
  options.Visit(writer);
  return writer.Schema();
}

// Numbers with as many digits as needed to read back the same value.
[[nodiscard]] std::string ToYaml(const Json& values);

// One line a key: path, default, what is allowed. For people.
[[nodiscard]] std::string OptionListing(const Json& schema);

}  // namespace polnav::testbed
