// SPDX-License-Identifier: GPL-3.0-or-later
// What a scene leaves open, filled in: so the rest of it can be checked.
#pragma once
#include "msml/core/describe.hpp"

namespace msml::simulation {

/// A parameter is open where its value is absent although it is given or required (it holds a fault, or comes from
/// another task: see Examination), and, of materials, densities and prony, where it is an expression or names a field.
/// Each filling gives every open parameter some value that its slot allows; between them they run through all choices,
/// and through numbers of either sign and very different size, among them those of expressions at several places. So
/// what is found wrong in the same words, whatever the filling, is wrong whatever the open parameters are. Lists of
/// unknown length stay open.
class Fillings {
 public:
  /// `args` must outlive it.
  explicit Fillings(const Record& args);
  /// 1 where nothing is open.
  int count() const { return count_; }
  /// The record, filled; the first filling leaves out what may be left out.
  Record at(int filling) const;

 private:
  const Record& args_;
  int count_ = 1;
};

/// True if every parameter that is given or required has a value.
bool complete(const Record& record);

}  // namespace msml::simulation
