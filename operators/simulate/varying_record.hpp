// SPDX-License-Identifier: GPL-3.0-or-later
// A tag whose attributes differ from place to place: they are expressions, or come from cell fields of the mesh.
#pragma once
#include <vector>

#include "msml/core/describe.hpp"
#include "msml/core/formula.hpp"
#include "operators/simulate/body.hpp"
#include "solver/combinations.hpp"

namespace msml::simulation {

/// Expressions in X, Y and Z stand for numbers, for entries of lists and for the three components of a direction
/// (slots of the unit "direction"). Cell fields are named by a direction and by the attribute `fields`:
/// "youngModulus=E mu[2]=stiffness", where the entries of a list count from 1.
class VaryingRecord {
 public:
  /// Tells what is wrong whatever the mesh is: expressions in t, `fields` that is no list of pairs or names
  /// what is no number, or names one twice; directions that are neither three expressions nor a name.
  static void check(const Record& record, const fe::Tell& tell = fe::raise);

  /// Throws Error also for a field that the mesh does not have or that has the wrong number of components, and for a
  /// value in `elements` that is out of range.
  VaryingRecord(const Record& record, const Body& body, const std::vector<int>& elements);

  bool inside() const { return !expressions_.empty(); }  ///< differs inside elements
  /// Numbers of a list come from fields, which may not go together.
  bool lists() const;
  bool varies() const { return !expressions_.empty() || !fields_.empty(); }  ///< differs at all
  /// The record with the numbers of an element (a cell of the mesh) and of a place in it.
  Record at(int element, const Vec3& X) const;

 private:
  /// An attribute that is an expression, or several.
  struct Expressions {
    std::size_t slot;
    std::vector<Function> parts;
  };
  /// An attribute and the cell field that it comes from.
  struct Source {
    std::size_t slot;
    int entry;  ///< of a list, the first that the field holds; -1 of a direction
    const Field* field;
  };
  static std::vector<Expressions> expressions_of(const Record& record, const fe::Tell& tell = fe::raise);
  void find_fields();
  void check_fields(const std::vector<int>& elements) const;
  void put(const Source& source, int element, Record& record) const;

  Record record_;
  MeshPtr mesh_;
  std::vector<Expressions> expressions_;
  std::vector<Source> fields_;
};

}  // namespace msml::simulation
