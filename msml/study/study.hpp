// SPDX-License-Identifier: GPL-3.0-or-later
// What a study of a scene says: what varies, against what errors are taken, what is measured, what is charted.
#pragma once
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "msml/core/registry.hpp"

namespace msml {

/// Variables that change together, one tuple of texts for each of their values; or a range of one variable.
struct Vary {
  std::vector<std::string> variables;
  std::vector<std::vector<std::string>> values;  ///< #values x #variables; empty for a range to be sampled
  double from = 0, to = 0;                       ///< of a range
  bool ranged = false, log = false, whole = false;
  Location where;
};

/// A setting of variables, name by name.
using Settings = std::vector<std::pair<std::string, std::string>>;

/// What errors are taken against: the same scene with other settings, a file, a formula per component, or the limit
/// that a number tends to.
struct Truth {
  Settings set;
  std::string file;         ///< relative to the scene's folder
  Formulas expected;        ///< in X, Y, Z, t
  double time = 0;          ///< value of t in expected
  std::string extrapolate;  ///< variable whose values go from coarse to fine
  double limit = 0;         ///< seconds of the run of `set`; 0: that of all runs
  Location where;
};

enum class Quantity : std::uint8_t { error, time, memory, iterations, probe, value, energy };

/// One number of each run.
struct Measure {
  Quantity quantity = Quantity::error;
  std::string id;     ///< column of the table
  std::string what;   ///< norm, part of the time, kind of memory or iterations, component of the probe
  std::string field;  ///< of an error
  std::string of;     ///< scene output or task; "": the first series of the scene
  bool relative = true;
  bool against_truth = false;  ///< of a probe: its error
  bool extrapolated = false;   ///< its error is found once all runs are over; ID_value holds the number itself
  std::string unit;            ///< of the column: "s", "bytes", "1", "length", …
  std::string value_unit;      ///< of the number itself, where the column is its error
  Location where;
};

/// How the axes of a chart are divided.
struct Axes {
  bool log_x = true, log_y = true;
};

/// Besides the columns of the table there is `share`: of all values of x, those that are not larger.
constexpr const char* share_column = "share";

struct Chart {
  std::string id, title;
  std::string x, y;                ///< columns
  std::vector<std::string> group;  ///< variables whose values make the curves
  Settings only;                   ///< rows that are drawn: those with these values; empty: all
  Axes axes;
  std::vector<double> slopes;  ///< triangles to be drawn
  std::string color;           ///< of a map: the measure that decides; "" for curves
  double accurate = 0.05;      ///< of a map: errors up to this are accurate
  double wrong = 1;            ///< of a map: errors above this are nonsense that nothing warned of
  Formulas theory;             ///< y over X, drawn as dashed lines
  std::vector<double> limits;  ///< values of x, drawn as dashed lines
  Location where;
};

/// How the values of several `vary` come together.
enum class Combine : std::uint8_t { product, zip, latin_hypercube };

struct Study {
  std::string id, title;
  Combine combine = Combine::product;
  int samples = 0;  ///< of a Latin hypercube
  int seed = 1;
  int repeat = 0;  ///< of timings; 0: 5 where time is measured, else 1
  double enough =
      0;  ///< seconds of a run, all its passes together, after which it is not repeated again; 0: no such end
  double limit = 0;  ///< seconds of one run; 0: none
  std::vector<Vary> vary;
  std::optional<Truth> truth;
  std::vector<Measure> measures;
  std::vector<Chart> charts;
  std::set<std::string> unread;  ///< kinds of tags of which some had faults and are missing: "vary", "measure", …
  Location where;
  /// Names of the variables, in the order of the columns.
  std::vector<std::string> variables() const;
  bool alone() const;           ///< what is measured asks for runs one after another
  bool timed() const;           ///< a time is measured
  bool measures_apart() const;  ///< one of the times is that of a run that shares nothing
  int repetitions() const;      ///< passes over each run
};

/// Adds <studies> and what stands in it.
void add_study_tags(Registry& registry);

/// Told of each fault.
using FaultSink = std::function<void(const Location&, const std::string&)>;

/// The study that a record of <study> describes; what makes no sense is told to `fault` and left out. `unread`: kinds
/// of tags of which some have been left out already.
Study make_study(const Record& record, const FaultSink& fault, std::set<std::string> unread = {});

/// "a=1 b=2", or "a=1 2; b=3" where values hold blanks. A part without '=' is told to `fault`.
Settings parse_settings(const std::string& text, const Location& where, const FaultSink& fault);

}  // namespace msml
