// SPDX-License-Identifier: GPL-3.0-or-later
// Reads cases.json. What a case says once holds for all its methods, and a method may say it anew.
#include "tests/verification/cases.hpp"

#include <fmt/format.h>

#include <fstream>
#include <set>

namespace msml::verification {
namespace {

using Json = nlohmann::json;

void refuse_unknown(const Json& json, const std::set<std::string>& known, const std::string& where) {
  for (const auto& [key, value] : json.items())
    if (!known.contains(key)) throw std::runtime_error(fmt::format("{}: '{}' is not known", where, key));
}

std::string text(const Json& value) { return value.is_string() ? value.get<std::string>() : value.dump(); }

std::map<std::string, std::string> texts(const Json& json) {
  std::map<std::string, std::string> map;
  for (const auto& [key, value] : json.items()) map[key] = text(value);
  return map;
}

Measure read_measure(const Json& json, const std::string& where) {
  refuse_unknown(json, {"node", "pointer", "file", "column", "reduce", "where", "whereFile", "place"}, where);
  return {json.value("node", ""),      json.value("pointer", ""),    json.value("file", ""),
          json.value("column", ""),    json.value("reduce", "last"), json.value("where", ""),
          json.value("whereFile", ""), json.value("place", 0.0)};
}

Method read_method(const Json& shared, const Json& own, const std::string& where) {
  refuse_unknown(own,
                 {"name", "measure", "set", "files", "replace", "vary", "values", "expect", "order", "more", "self",
                  "limit", "above", "exit", "says", "iterations"},
                 where);
  Json json = shared;
  for (const auto& [key, value] : own.items())
    if (key != "measure" && value.is_object() && json.contains(key))
      json[key].update(value);
    else
      json[key] = value;
  Method method;
  method.name = json.value("name", "");
  if (json.contains("set")) method.set = texts(json["set"]);
  if (json.contains("replace")) method.replace = texts(json["replace"]);
  method.vary = json.value("vary", "");
  if (json.contains("values"))
    for (const Json& value : json["values"])
      method.values.push_back(value.is_object() ? texts(value)
                                                : std::map<std::string, std::string>{{method.vary, text(value)}});
  if (method.vary.empty() != method.values.empty())
    throw std::runtime_error(fmt::format("{}: vary and values go together", where));
  if (json.contains("expect")) method.expect = json["expect"].get<double>();
  if (json.contains("order")) method.order = json["order"].get<double>();
  if (json.contains("files")) method.files = texts(json["files"]);
  method.more = json.value("more", "");
  method.self = json.value("self", false);
  if (json.contains("measure")) method.measure = read_measure(json["measure"], where);
  method.limit = json.value("limit", 0.0);
  method.above = json.value("above", 0.0);
  method.exit_code = json.value("exit", 0);
  method.says = json.value("says", "");
  method.iterations = json.value("iterations", 0);
  return method;
}

Case read_case(const Json& json) {
  Case out;
  out.name = json.at("case").get<std::string>();
  refuse_unknown(
      json, {"case",   "scene",  "source", "measure", "smoke", "methods", "set",   "files", "replace", "vary",
             "values", "expect", "order",  "more",    "self",  "limit",   "above", "exit",  "says",    "iterations"},
      out.name);
  out.scene = json.at("scene").get<std::string>();
  out.source = json.at("source").get<std::string>();
  out.smoke = json.value("smoke", false);
  Json shared = json;
  for (const char* key : {"case", "scene", "source", "smoke", "methods"}) shared.erase(key);
  for (const Json& method : json.at("methods")) out.methods.push_back(read_method(shared, method, out.name));
  return out;
}

}  // namespace

std::vector<Case> read_cases(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) throw std::runtime_error("cannot read " + file.string());
  std::vector<Case> cases;
  for (const Json& json : Json::parse(stream, nullptr, true, true)) cases.push_back(read_case(json));
  return cases;
}

}  // namespace msml::verification
