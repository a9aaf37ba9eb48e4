// SPDX-License-Identifier: GPL-3.0-or-later
// An operator: a described, pure function from values to values.
#pragma once
#include <atomic>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>

#include "msml/core/describe.hpp"

namespace msml {

/// What an operator may tell while it works. All calls are safe from any thread.
class Reporter {
 public:
  virtual ~Reporter() = default;
  /// Share of the work done, 0 to 1, and a few words ("step 3/150").
  virtual void progress(double share, const std::string& words) = 0;
  virtual void note(const std::string& text) = 0;  ///< shown in verbose mode
  virtual void warn(const std::string& text) = 0;  ///< always shown, and kept in the report
  /// A block of lines that always belongs to the result, such as the check after a run.
  virtual void print(const std::string& text) = 0;
  /// A fact for the JSON report of the run, as JSON text: "check", {"residual": 1e-9, …}.
  virtual void record(const std::string& name, const std::string& json) = 0;
};

/// What an operator sees while it runs: its checked record, its outputs and the reporter.
class Context {
 public:
  Context(const Record& args, Reporter& reporter, std::filesystem::path output_folder, int threads);

  template <class T>
  bool has(Key<T> key) const {
    return args_.has(key);
  }
  template <class T>
  const T& get(Key<T> key) const {
    return args_[key];
  }
  template <class T>
  std::shared_ptr<const T> share(Key<T> key) const {
    return args_.share(key);
  }
  const Record& args() const { return args_; }

  /// Sets an output; a large value is moved into shared storage.
  template <class T>
  void set(Key<T> key, T value) {
    if constexpr (is_shared<T>)
      outputs[at(key.slot)] = std::make_shared<const T>(std::move(value));
    else
      outputs[at(key.slot)] = std::move(value);
  }
  template <class T>
  void set(Key<T> key, std::shared_ptr<const T> value) {
    outputs[at(key.slot)] = std::move(value);
  }
  /// Sets the output in the given slot; for operators whose outputs are not known when they are written.
  void set(int slot, Value value) {
    if (outputs.size() <= at(slot)) outputs.resize(at(slot) + 1);
    outputs[at(slot)] = std::move(value);
  }

  Reporter& reporter() { return reporter_; }
  const std::filesystem::path& output_folder() const { return output_folder_; }
  int threads() const { return threads_; }

  std::vector<Value> outputs;  ///< one per slot of the operator; only output slots are filled

 private:
  static std::size_t at(int slot) { return static_cast<std::size_t>(slot); }
  const Record& args_;
  Reporter& reporter_;
  std::filesystem::path output_folder_;
  int threads_;
};

/// A record as far as the text of a scene says it, for the operator's own checks before anything runs, and whom they
/// tell. What another task feeds, what holds a fault of its own, and what a misspelt attribute may have meant is absent
/// from Record::values, but `given`.
struct Examination {
  const Record& args;
  bool every_tag = true;  ///< false where the scene has tags that are unknown or misplaced: others may be missing
  std::function<void(const Error&)> fault, warn;
};

/// Tells what makes no sense in a record before anything runs.
using Examiner = std::function<void(const Examination&)>;

/// A description of category "operator" and the function behind it. Attributes are inputs, parameters and targets.
class Operator : public Description {
 public:
  Operator(std::string tag, std::string doc) : Description(std::move(tag), "operator", std::move(doc)) {}

  template <class T>
  Key<T> output(std::string name, std::string doc) {
    return add<T>(std::move(name), Role::output, Options<T>{.doc = std::move(doc)});
  }
  /// An optional file name that the runner writes `written` to, by its extension.
  template <class T>
  void target(std::string name, Key<T> written, std::string doc) {
    Slot slot{.name = std::move(name), .type = Type::text, .role = Role::target, .doc = std::move(doc)};
    slot.written_output = written.slot;
    add_slot(std::move(slot));
  }
  /// Its result is what it prints: it runs even where nothing else needs its outputs.
  void reports() { reports_ = true; }
  bool is_report() const { return reports_; }
  /// Called when a scene is compiled, whether its attributes have passed their own checks or not.
  void examine(Examiner examiner) { examiner_ = std::move(examiner); }
  const Examiner& examiner() const { return examiner_; }
  void run(std::function<void(Context&)> function) { run_ = std::move(function); }
  void operator()(Context& context) const { run_(context); }
  /// Position of the first output, the value of ${task}; -1 if there is none.
  int first_output() const;

 private:
  std::function<void(Context&)> run_;
  Examiner examiner_;
  bool reports_ = false;
};

}  // namespace msml
