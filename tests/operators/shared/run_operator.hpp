// SPDX-License-Identifier: GPL-3.0-or-later
// Runs one operator of the full registry on given arguments, as the runner does.
#pragma once
#include <gtest/gtest.h>

#include <map>
#include <string>
#include <vector>

#include "operators/registry.hpp"

namespace msml::test {

/// Keeps what an operator tells.
class QuietReporter : public Reporter {
 public:
  void progress(double, const std::string&) override {}
  void note(const std::string& text) override { notes.push_back(text); }
  void warn(const std::string& text) override { warnings.push_back(text); }
  void print(const std::string& text) override { printed.push_back(text); }
  void record(const std::string& name, const std::string& json) override { records[name] = json; }
  std::vector<std::string> notes, warnings, printed;
  std::map<std::string, std::string> records;
};

using Arguments = std::map<std::string, Value>;

/// Fills the record from the arguments and the defaults, runs the operator and returns its first output.
inline Value run(const std::string& tag, const Arguments& arguments, QuietReporter* listener = nullptr,
                 const std::string& wanted = "") {
  Registry registry;
  add_operators(registry);
  const Operator* const op = registry.find_operator(tag);
  if (op == nullptr) throw Error("no operator " + tag);
  Record record{.description = op};
  for (const Slot& slot : op->slots()) {
    const bool given = slot.role != Role::output && arguments.count(slot.name) > 0;
    record.values.push_back(given ? convert(arguments.at(slot.name), slot.type) : slot.fallback);
    record.given.push_back(given);
  }
  QuietReporter own;
  Context context(record, listener ? *listener : own, ".", 1);
  (*op)(context);
  const int output = wanted.empty() ? op->first_output() : op->find(wanted, true);
  return context.outputs.at(static_cast<std::size_t>(output));
}

/// The data in an output.
template <class T>
std::shared_ptr<const T> output(const Value& value) {
  return std::get<std::shared_ptr<const T>>(value);
}

/// The message of the Error that the operator throws, or "no error".
inline std::string error_of(const std::string& tag, const Arguments& arguments) {
  try {
    run(tag, arguments);
  } catch (const Error& e) {
    return e.what();
  }
  return "no error";
}

}  // namespace msml::test
