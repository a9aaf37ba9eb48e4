// SPDX-License-Identifier: GPL-3.0-or-later
// All elements of a model, ready for assembly: batches of eight, coloured chunks, precomputed positions.
#pragma once
#include <array>
#include <functional>
#include <memory>
#include <span>

#include "solver/block_matrix.hpp"
#include "solver/materials/law.hpp"
#include "solver/model.hpp"

namespace msml::fe {

/// The elements that carry unknowns, and the numbering of the nodes they use. Nodes are renumbered along a
/// space-filling curve, so that neighbours lie close in memory.
struct Numbering {
  std::shared_ptr<const Mesh> mesh;
  CellKind kind = CellKind::tet4;
  int components = 3;              ///< unknowns per node that the problem has, see components(); the others stay zero
  bool scalar = false;             ///< the one unknown is no displacement (Law::components() == 1)
  std::vector<int> elements;       ///< cell ids, by region, then along the curve
  std::vector<int> region_of;      ///< region of each of `elements`
  std::vector<int> node_of;        ///< mesh point of each numbered node
  std::vector<int> number_of;      ///< number of each mesh point, -1 without unknowns
  std::vector<int> element_nodes;  ///< numbers of the nodes of `elements`, element after element
  std::vector<std::array<int, 2>> links;  ///< pairs of numbered nodes that springs or inlays join
  /// Mixed elements: mesh point of each additional node. Each region has one at each of its corners, since the pressure
  /// jumps where the material does. These come after the nodes of the body; their first component is a pressure, see
  /// pressure_scale, and the other two are fixed at zero.
  std::vector<int> pressure_of;
  std::vector<int> pressure_nodes;  ///< mixed elements: the additional nodes of the corners of `elements`, four each
  double pressure_scale = 1;        ///< stress per unit of the first component
  int body_nodes() const { return static_cast<int>(node_of.size()); }
  int nodes() const { return body_nodes() + static_cast<int>(pressure_of.size()); }
  bool mixed() const { return !pressure_of.empty(); }
  std::size_t bytes() const;  ///< held beside the mesh
};
Numbering number(const Model& model);

/// The kind of the elements of a model (all are of one); vertex where it has none.
CellKind element_kind(const Model& model);
/// True if the unknown is no displacement: a law has one component.
bool is_scalar(const Model& model);
/// Unknowns per node of a model: 1 for lines and scalar problems, 2 for triangles, 3 for tetrahedra and particles.
/// Vectors always have 3 numbers per node; those that a problem does not have are fixed at zero (make_supports).
int components(const Model& model);

/// Of each mid node of quadratic elements the ends of its edge, {-1, -1} of other nodes; empty for linear elements.
std::vector<std::array<int, 2>> edge_ends(const Numbering& numbering);

/// 1 for the two components of each additional node that mean nothing, and for its pressure too if `all`; 0 elsewhere.
std::vector<char> pressure_mask(const Numbering& numbering, bool all);

/// #points x 3 of the mesh from 3 numbers per numbered node of the body (zero elsewhere), and back (additional nodes
/// get zero).
Points to_points(const Numbering& numbering, const Vector& values);
Vector to_vector(const Numbering& numbering, const Points& values);
/// Pressure at the points of the mesh, positive in compression: minus the multiplier p of mixed elements, linear along
/// edges with a mid node, the mean over the regions that meet there; empty for other elements.
std::vector<double> to_pressures(const Numbering& numbering, const Vector& values);
/// The same of each additional node, and back into a vector as to_vector makes it.
std::vector<double> to_corner_pressures(const Numbering& numbering, const Vector& values);
/// Pressures at the ten nodes of an element of `elements`, from those of its own region's corners: linear, so that the
/// interpolation of the ten is that of the four.
std::array<double, 10> element_pressures(const Numbering& numbering, std::size_t element,
                                         const std::vector<double>& corner_pressures);
void put_corner_pressures(const Numbering& numbering, const std::vector<double>& pressures, Vector& values);

/// What an assembly found on its way.
struct Assembled {
  double energy = 0;                                            ///< elastic energy
  double smallest_J = std::numeric_limits<double>::infinity();  ///< det F over all quadrature points
  int smallest_J_element = -1;                                  ///< cell id
  bool finite = true;                                           ///< false if a stress is NaN or infinite
};

/// Quadrature point values of one element, for results.
struct ElementPoints {
  int count = 0;
  double weight[lanes];   ///< reference volume of the point
  Vec3 place[lanes];      ///< reference position
  Gradients gradient;     ///< lane k: displacement gradient of point k
  Lanes volume_stress{};  ///< lane k: p in the stress P = d(rest)/dF + p dg/dF of elements that split the law
};

/// Told the place of an element in Numbering::elements and what its points are.
using PointsVisitor = std::function<void(std::size_t element, const ElementPoints& points)>;

/// A tangent that elements keep as what it is made of, since products with it cost less than to write its matrix.
class KeptTangent {
 public:
  virtual ~KeptTangent() = default;
  /// y = K x + s M x.
  virtual void multiply(double s, const ScalarMatrix& M, const Vector& x, Vector& y) const = 0;
  /// The same of eight vectors; Y has the size of X.
  virtual void multiply(double s, const ScalarMatrix& M, const std::vector<Eight>& X, std::vector<Eight>& Y) const = 0;
  /// matrix = K.
  virtual void assemble(BlockMatrix& matrix) const = 0;
};

/// Elements of one kind. Sums are added in an order fixed by the mesh alone: results are equal bit for bit for every
/// number of threads. Elements of a chunk are added by one thread; chunks of one colour share no node.
class Elements {
 public:
  virtual ~Elements() = default;
  /// force += internal force; matrix (if not null) = tangent as `want` says: set, not added to. One call at a time.
  virtual Assembled add_internal(const Vector& u, Want want, Vector& force, BlockMatrix* matrix) const = 0;
  /// The tangent that add_internal() with Want::single_tangent and without a matrix kept last; null: none is kept.
  virtual const KeptTangent* kept_tangent() const { return nullptr; }
  /// mass += consistent (or lumped) mass with the regions' densities.
  virtual void add_mass(bool lumped, ScalarMatrix& mass) const = 0;
  /// Calls `visit` once for every element of numbering().elements with its displacement gradients, from several
  /// threads, in no order.
  virtual void visit_points(const Vector& u, const PointsVisitor& visit) const = 0;
  /// For materials with a history: called before the increments of a time step of dt, and when its end is accepted.
  virtual void begin_step(double /*dt*/) {}
  virtual void end_step(const Vector& /*u*/) {}
  /// Their stress at the end of the last step, see State::history_stress; null where all regions are elastic.
  virtual std::shared_ptr<const std::vector<double>> history_stress() const { return nullptr; }
  virtual std::size_t bytes() const = 0;  ///< held beside the mesh and the pattern
  /// Their stored energy at the end of the last step, see State::history_energy; null where nobody wants it.
  virtual std::shared_ptr<const std::vector<double>> history_energy() const { return nullptr; }
  /// What is stored at the end of the last step beside the energy that add_internal found there, which with a history
  /// is the potential of the forces of that step.
  virtual double stored_beside() const { return 0; }
  /// u with the pressures that act at the end of the last step, which with a history are not the unknown ones.
  virtual Vector acting(const Vector& u) const { return u; }
  virtual const Numbering& numbering() const = 0;
  virtual const PatternPtr& pattern() const = 0;
};

/// Prepares the elements of a checked model, or none where it has only point masses. Keeps a copy of what it needs.
std::unique_ptr<Elements> make_elements(const Model& model);

}  // namespace msml::fe
