// SPDX-License-Identifier: GPL-3.0-or-later
// One description per thing: what a tag of the language means and which attributes it takes. The checker, the schema,
// the help texts and the defaults are all derived from it.
#pragma once
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "msml/core/error.hpp"
#include "msml/core/value.hpp"

namespace msml {

/// An interval of allowed numbers; infinite ends do not bound. NaN and infinite values are never allowed.
struct Range {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false, high_open = false;
  bool contains(double x) const;
  bool bounded() const;
  std::string str() const;  ///< "> 0", ">= 0", "in (-1, 0.5)", "finite"
};
Range closed(double low, double high);
Range open(double low, double high);
Range half_open(double low, double high);  ///< low <= x < high
Range positive();
Range nonnegative();

enum class Role : std::uint8_t {
  input,      ///< data that flows in on an edge
  parameter,  ///< a setting
  target,     ///< file name that an output is written to; optional
  output      ///< data that flows out, referred to as ${task.slot}
};

/// What is wrong with a value of a slot, such as "times do not ascend: 2 follows 3"; "" if nothing is.
using ValueCheck = std::function<std::string(const Value&)>;

/// One attribute of a tag, or one output of an operator.
struct Slot {
  std::string name;
  Type type = Type::text;
  Role role = Role::parameter;
  std::string doc;
  std::string unit;  ///< "", "degree", "length", "stress", …
  Range range;       ///< of each number
  Value fallback;    ///< monostate: no default
  bool required = false;
  std::vector<std::string> choices;  ///< allowed texts or words; empty = any
  std::vector<std::size_t> counts;   ///< allowed lengths of a list; empty = any
  std::size_t multiple_of = 0;       ///< length of the list is a multiple of this; 0 = any
  Indexed indexes = Indexed::nodes;  ///< what a literal list of an IndexSet slot means
  ValueCheck check;                  ///< what else must hold; empty = nothing
  int written_output = -1;           ///< target only: position of the output slot that the file receives
};

/// A typed handle to a slot of one description.
template <class T>
struct Key {
  int slot = -1;
};

/// What a parameter may be told; fields not named keep their defaults.
template <class T>
struct Options {
  std::string unit = {};
  Range range = {};
  std::optional<T> fallback = {};
  bool optional = false;  ///< may be left out although it has no default
  std::vector<std::string> choices = {};
  std::vector<std::size_t> counts = {};
  std::size_t multiple_of = 0;
  Indexed indexes = Indexed::nodes;
  ValueCheck check = {};
  std::string doc;
};

/// Which tags may stand inside a tag: all descriptions of a category, at least `least` and at most `most` of them.
struct ChildRule {
  std::string category;
  int least = 0;
  int most = std::numeric_limits<int>::max();
};

/// A tag of the language: its attributes and what may stand inside.
class Description {
 public:
  Description(std::string tag, std::string category, std::string doc);
  virtual ~Description() = default;
  Description(const Description&) = default;
  Description(Description&&) = default;
  Description& operator=(const Description&) = default;
  Description& operator=(Description&&) = default;

  const std::string& tag() const { return tag_; }
  const std::string& category() const { return category_; }  ///< "operator", "material", "constraint", "output", …
  const std::string& doc() const { return doc_; }
  const std::string& source() const { return source_; }            ///< where the method comes from
  const std::string& unavailable() const { return unavailable_; }  ///< why it cannot be used yet; "" = it can
  const std::vector<Slot>& slots() const { return slots_; }
  const std::vector<ChildRule>& children() const { return children_; }
  const std::vector<std::string>& notes() const { return notes_; }
  /// Position of the slot in slots(), or -1. Outputs and attributes may carry the same name.
  int find(const std::string& name, bool output = false) const;

  void source(std::string text) { source_ = std::move(text); }
  /// A remark for the help text, such as a difference from MSML.
  void note(std::string text) { notes_.push_back(std::move(text)); }
  /// The tag parses, but a scene that uses it is refused: "TAG is not available yet: REASON".
  void not_available_yet(std::string reason) { unavailable_ = std::move(reason); }
  /// Output requests only: the type of the value that `${id}` stands for.
  void produces(Type type) { produces_ = type; }
  Type produces() const { return produces_; }
  void allow(ChildRule rule) { children_.push_back(std::move(rule)); }

  /// A setting. Required unless it has a fallback or is optional.
  template <class T = double>
  Key<T> parameter(std::string name, Options<T> options) {
    return add<T>(std::move(name), Role::parameter, std::move(options));
  }
  /// Data that flows in.
  template <class T>
  Key<T> input(std::string name, std::string doc, bool optional = false) {
    return add<T>(std::move(name), Role::input, Options<T>{.optional = optional, .doc = std::move(doc)});
  }
  template <class T>
  Key<T> input(std::string name, Options<T> options) {
    return add<T>(std::move(name), Role::input, std::move(options));
  }

 protected:
  int add_slot(Slot slot);
  template <class T>
  Key<T> add(std::string name, Role role, Options<T> options) {
    Slot slot{.name = std::move(name),
              .type = type_of<T>,
              .role = role,
              .doc = std::move(options.doc),
              .unit = std::move(options.unit),
              .range = options.range,
              .choices = std::move(options.choices),
              .counts = std::move(options.counts),
              .multiple_of = options.multiple_of,
              .indexes = options.indexes,
              .check = std::move(options.check)};
    slot.required = !options.optional && !options.fallback && role != Role::output && role != Role::target;
    if constexpr (is_shared<T>) { /* data has no default */
    } else if (options.fallback)
      slot.fallback = std::move(*options.fallback);
    return {add_slot(std::move(slot))};
  }

 private:
  std::string tag_, category_, doc_, source_, unavailable_;
  std::vector<std::string> notes_;
  std::vector<Slot> slots_;
  std::vector<ChildRule> children_;
  Type produces_ = Type::nothing;
};

/// A description filled with values: one tag of a scene, checked, every attribute of its declared type.
struct Record {
  const Description* description = nullptr;
  Location where;
  std::string id;             ///< attribute id or name, or ""
  std::vector<Value> values;  ///< one per slot; monostate where an optional attribute is absent
  std::vector<bool> given;    ///< one per slot: true where the scene says it, false where the default stands
  std::vector<Record> children;

  const std::string& tag() const { return description->tag(); }
  template <class T>
  bool has(Key<T> key) const {
    return type(values[static_cast<std::size_t>(key.slot)]) != Type::nothing;
  }
  template <class T>
  bool is_given(Key<T> key) const {
    return given[static_cast<std::size_t>(key.slot)];
  }
  /// The value; throws Error where an optional attribute is absent.
  template <class T>
  const T& operator[](Key<T> key) const {
    const auto* value = std::get_if<carried_t<T>>(&values[static_cast<std::size_t>(key.slot)]);
    if (value == nullptr) missing(key.slot);
    if constexpr (is_shared<T>)
      return **value;
    else
      return *value;
  }
  /// The shared pointer to a large value, to hand it on without a copy.
  template <class T>
  std::shared_ptr<const T> share(Key<T> key) const {
    const auto* value = std::get_if<carried_t<T>>(&values[static_cast<std::size_t>(key.slot)]);
    if (value == nullptr) missing(key.slot);
    return *value;
  }
  /// Children of one category, in document order.
  std::vector<const Record*> of_category(const std::string& category) const;
  /// Children with one tag, in document order.
  std::vector<const Record*> of_tag(const std::string& tag) const;

 private:
  [[noreturn]] void missing(int slot) const;
};

/// A description that builds something of type Result from a record, for example a material law.
template <class Result>
class Factory : public Description {
 public:
  using Description::Description;
  template <class F>
  void build(F function) {
    build_ = std::move(function);
  }
  Result make(const Record& record) const { return build_(record); }

 private:
  std::function<Result(const Record&)> build_;
};

}  // namespace msml
