// SPDX-License-Identifier: GPL-3.0-or-later
// What the solver is given, and what it gives back. Plain data: no XML, no files.
#pragma once
#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "msml/core/mesh.hpp"

namespace msml::fe {

class Law;  // solver/materials/law.hpp

/// The law of up to eight elements (cell ids) side by side, where parameters differ between elements: lane k is element
/// k; lanes that are not named repeat the last.
using LocalLaw = std::function<std::shared_ptr<const Law>(std::span<const int> elements)>;

/// The law where parameters vary inside elements: lane k is a quadrature point of elements[k] at reference position
/// places[k]; elements and lanes that are not named repeat the last.
using PointLaw = std::function<std::shared_ptr<const Law>(std::span<const int> elements, std::span<const Vec3> places)>;

/// Quasi-linear viscoelasticity: the second Piola stress is the convolution of G(t) = 1 - sum_i g_i (1 - exp(-t/tau_i))
/// with the rate of the law's own. The law is the instantaneous one, or the long-term one, which is then divided by
/// 1 - sum g_i. Empty: elastic.
struct Prony {
  std::vector<double> g, tau;  ///< g_i > 0 with a sum < 1; tau_i > 0, time
  bool long_term = false;      ///< the law is the long-term one
};

/// A group of elements with one material. Units are the scene's own, consistent.
struct Region {
  std::string name;
  std::shared_ptr<const Law> law;  ///< where local_law is set: a typical one, for messages and settings
  double density = 1;              ///< mass per reference volume, >= 0; where density_at is set: a typical one
  std::vector<int> elements;       ///< cell ids of Model::mesh
  LocalLaw local_law = {};         ///< empty: `law` everywhere
  PointLaw point_law = {};         ///< if set, instead of both
  std::function<double(int element, const Vec3& X)> density_at = {};  ///< if set, instead of density
  Prony prony = {};                                                   ///< where prony_at is set: a typical one
  /// If set, instead of prony: as many terms everywhere, each as checked as `prony`.
  std::function<Prony(int element, const Vec3& X)> prony_at = {};
};

/// How an element is computed. single_rotation: quadratic tetrahedra with one rotation each; fbar: linear tetrahedra
/// with volume changes averaged over patches; mixed: quadratic displacement and linear pressure.
enum class Formulation { standard, single_rotation, fbar, mixed };
enum class Plane { strain, stress };

/// A vector or a number as a function of the reference position and of time.
using VectorFunction = std::function<Vec3(const Vec3& X, double t)>;
using ScalarFunction = std::function<double(const Vec3& X, double t)>;

/// A factor in time: a load curve.
struct TimeFunction {
  std::function<double(double t)> value;
  std::vector<double> kinks;  ///< times where it turns, which adaptive steps meet

  TimeFunction() = default;
  template <class Callable>
  requires std::is_invocable_r_v<double, Callable, double> TimeFunction(Callable f, std::vector<double> times = {})
      : value(std::move(f)), kinks(std::move(times)) {}
  double operator()(double t) const { return value(t); }
  explicit operator bool() const { return static_cast<bool>(value); }
};

enum class Ramp { linear, step };

/// Total displacement of nodes from the reference configuration, per component. With Ramp::linear the value is reached
/// linearly from the state at the start of the step. It acts in the steps that list it; a later step that does not list
/// it lets go. Where two conditions fix one component of a node, the later in the list wins.
struct Prescribed {
  std::string name;
  std::vector<int> nodes;
  std::vector<Vec3> values;  ///< one for all, or one per node
  bool components[3] = {true, true, true};
  Ramp ramp = Ramp::linear;      ///< zero displacement (a fixed node) uses step
  VectorFunction function = {};  ///< if set, the displacement at X and t instead of `values`, without a ramp
  TimeFunction factor = {};      ///< if set, factor(t) times `values` or `function`, without a ramp
};

/// Nodes that stay in planes: no displacement along a normal, whatever the direction; see conditions/frames.hpp.
struct Slide {
  std::string name;
  std::vector<int> nodes;
  Vec3 normal = Vec3::UnitX();  ///< not zero
};

/// Force on each node (not shared between them), dead.
struct NodalForce {
  std::string name;
  std::vector<int> nodes;
  std::vector<Vec3> values;      ///< one for all, or one per node
  VectorFunction function = {};  ///< if set, the force at X and t instead of `values`
  TimeFunction factor = {};      ///< if set, factor(t) times either
};

/// Force per reference volume, dead.
struct BodyForce {
  std::string name;
  std::vector<int> elements;     ///< cell ids
  Vec3 value = Vec3::Zero();     ///< everywhere the same
  VectorFunction function = {};  ///< if set, instead of `value`
  bool steady = false;           ///< `function` does not depend on t: it ramps in statics as a value does
  TimeFunction factor = {};      ///< if set, factor(t) times either
};

/// A spring with a damper beside it, from a node to a node or to a point in space. Tension stiffness (l - rest) along
/// the line between its ends, and damping times the rate of l; with a rest length of 0 the damper acts in all
/// directions.
struct Spring {
  std::string name;
  int first = -1, second = -1;  ///< nodes; second = -1: the other end is `point`
  Vec3 point = Vec3::Zero();
  double stiffness = 0;                                           ///< force/length, >= 0
  double damping = 0;                                             ///< force time/length, >= 0
  double rest = 0;                                                ///< length, >= 0
  TimeFunction stiffness_at = {}, damping_at = {}, rest_at = {};  ///< if set, instead of the numbers
};

/// A mass at a node, beside that of the elements; a node may have no element.
struct PointMass {
  int node = -1;
  double mass = 1;  ///< > 0
};

/// A side of an element: face of a tetrahedron, edge of a triangle, end of a line (see msml::side_nodes).
struct Face {
  int element = -1;  ///< cell id
  int local = -1;    ///< 0..dimension
};

/// A place in an element.
struct Tie {
  int element = -1;             ///< cell id; -1: nowhere
  std::vector<double> weights;  ///< of its nodes, with sum 1
};

/// A second mesh of tetrahedra inside a body of tetrahedra. Its nodes move with the elements of the body that hold
/// them, so that it has no unknowns of its own; its forces, stiffness and mass come on top of the body's.
struct Inlay {
  std::shared_ptr<const Mesh> mesh;
  Region region;          ///< its elements are cells of this mesh
  std::vector<Tie> ties;  ///< #points of this mesh; nowhere for points of no element
};

/// Pressure (positive pushes against the outward normal) or a traction vector on faces.
struct FaceLoad {
  std::string name;
  std::vector<Face> faces;
  std::vector<double> pressures;  ///< one for all or one per face; empty if a traction
  std::vector<Vec3> tractions;    ///< force per reference area; one for all or one per face; empty if a pressure
  bool follower = false;          ///< pressure acts on the deformed face (with its tangent)
  VectorFunction traction_function = {};  ///< if set, instead of `tractions`
  ScalarFunction pressure_function = {};  ///< if set, instead of `pressures`
  bool steady = false;                    ///< the function does not depend on t: it ramps in statics as values do
  TimeFunction factor = {};               ///< if set, factor(t) times any of them
};

/// One stage of a simulation: `count` time steps of `dt`. What acts is listed anew for each stage. In dynamics loads
/// act in full from the start; in statics they change linearly from those of the stage before (at first: none) to
/// these, in Settings::load_steps equal parts, each of them one reported state; time then runs over dt * count. Loads
/// and supports with a function of t or a factor do not ramp: they are what they are at each time.
struct Step {
  std::string name;
  double dt = 0.05;  ///< time, > 0
  int count = 100;   ///< number of time steps
  Vec3 gravity = Vec3(0, 0, -9.81);
  VectorFunction gravity_function = {};    ///< if set, instead of `gravity`; taken at the nodes
  bool gravity_steady = false;             ///< it does not depend on t: it ramps in statics as a constant does
  std::vector<double> gravity_kinks = {};  ///< times where gravity_function turns, which adaptive steps meet
  std::vector<Prescribed> prescribed;
  std::vector<NodalForce> forces;
  std::vector<FaceLoad> face_loads;
  std::vector<BodyForce> body_forces = {};
  std::vector<Slide> slides = {};
  std::vector<Spring> springs = {};
};

/// static_: equilibrium, loads ramped over each step. quasi_static: equilibrium at every time step, loads as they are
/// at that time. The next three solve for the end of the time step; the last three are explicit and lump the mass.
enum class Integrator {
  static_,
  quasi_static,
  implicit_euler,
  newmark,
  generalized_alpha,
  forward_euler,
  symplectic_euler,
  central_difference
};
bool is_dynamic(Integrator integrator);   ///< bodies have inertia
bool is_explicit(Integrator integrator);  ///< no equations are solved; stable up to a largest time step
const char* name(Integrator integrator);  ///< as the language spells it

/// Where Newton's method takes the law's semidefinite tangent: where the law's own is not positive definite, in every
/// iteration, or nowhere.
enum class Definiteness { automatic, always, never };

enum class LinearSolver { direct, cg, automatic };
enum class Preconditioner { none, jacobi, block_jacobi, incomplete_cholesky, multigrid, automatic };

/// Follows equilibria through limit points of the load: the factor on the loads is an unknown, and the length of the
/// displacement's increment is given. The first is that of 1/load_steps of the loads; it adapts. Stops at the first
/// state at or past one of the bounds.
struct ArcLength {
  bool on = false;
  int steps = 50;                                                 ///< reported states, > 0
  double load = std::numeric_limits<double>::infinity();          ///< largest |load factor|
  double displacement = std::numeric_limits<double>::infinity();  ///< largest displacement of a node
};

struct Settings {
  Integrator integrator = Integrator::implicit_euler;
  LinearSolver linear_solver = LinearSolver::automatic;
  Preconditioner preconditioner = Preconditioner::automatic;
  double damping_mass = 0;       ///< Rayleigh alpha, 1/time, >= 0
  double damping_stiffness = 0;  ///< Rayleigh beta, time, >= 0; of the semidefinite tangent, which turns with the body
  bool lumped_mass = false;
  int newton_iterations = 25;  ///< at most; 1 = one linear solve per step, taken as it is
  double tolerance = 1e-8;     ///< residual relative to the loads
  double linear_tolerance = 1e-10;
  int load_steps = 1;  ///< static: the loads are applied in so many equal parts
  bool line_search = true;
  Definiteness definiteness = Definiteness::automatic;
  double newmark_beta = 0.25, newmark_gamma = 0.5;
  double spectral_radius = 0.8;  ///< of generalized_alpha at infinite frequency, in [0, 1]
  bool allow_unstable = false;   ///< run explicit methods beyond their stable time step
  bool adaptive_step = false;    ///< steps between the reported states are as long as Newton and the error allow
  double step_tolerance = 1e-3;  ///< of implicit dynamics with adaptive_step: error of a step beside the displacement
  ArcLength arc_length = {};     ///< of static_
  bool allow_inverted = false;   ///< go on where an element of a finite-strain law inverts (det F <= 0)
  bool untangle = true;          ///< from states with inverted elements, start with the stable neo-Hookean law
  int threads = 1;
  /// Called now and then while an increment is computed; ends the run by an exception of its own. Empty: none.
  std::function<void()> pulse = {};
};

struct Model {
  std::shared_ptr<const Mesh> mesh;  ///< nodes that belong to no listed element carry no unknowns
  std::vector<Region> regions;       ///< disjoint; all elements of one kind
  Formulation formulation = Formulation::standard;
  int quadrature =
      4;  ///< points of standard tet10: 4 (degree 2), or 8 (degree 3: exact in the patch test where curved)
  Plane plane = Plane::strain;  ///< of triangles
  double thickness = 1;         ///< of triangles; cross-section of lines
  std::vector<PointMass> point_masses = {};
  std::vector<Inlay> inlays = {};
  Points initial_displacement = {}, initial_velocity = {};  ///< #points x 3; empty: zero
  std::vector<Step> steps;
  Settings settings;
  bool stored_energies = true;  ///< of viscoelastic regions, see PronyHistory; their elastic energy is not wanted else
  /// Throws Error on what cannot be solved: an inverted reference element, a static body free to move, …
  void check() const;
};

/// What a state holds, and what went in and out since the start. Loads given as functions and constants both do work.
struct Energies {
  double elastic = 0, kinetic = 0;  ///< elastic: stored, in viscoelastic regions too
  double external_work = 0;         ///< of loads and moved supports, by the trapezoidal rule over the increments
  /// By Rayleigh damping and dampers, the same way; in viscoelastic regions what the work of the internal forces, the
  /// same way, leaves beside the stored energy.
  double dissipated = 0;
  Vec3 momentum = Vec3::Zero(), angular_momentum = Vec3::Zero();  ///< about the origin, of the deformed body
};

class Elements;  // solver/elements/assembly.hpp

/// The unknowns at one time. All arrays are #points x 3 of Model::mesh.
struct State {
  double time = 0;
  int step = 0;       ///< index into Model::steps
  int increment = 0;  ///< 0 = initial state, then 1, 2, … over all steps
  Points displacement, velocity, acceleration;
  Points reaction;  ///< force of the constraint on the body; zero where free
  Energies energies;
  /// Viscoelastic regions: second Piola stress (xx yy zz xy yz xz; of small-strain laws the stress) at the quadrature
  /// points of all elements, in solver order; zero in elastic regions. Null where every region is elastic.
  std::shared_ptr<const std::vector<double>> history_stress = nullptr;
  std::vector<double> pressure = {};  ///< mixed elements: #points, positive in compression; empty otherwise
  double load_factor = 1;             ///< statics: the share of this step's loads that acts
  /// Mixed elements: pressure of each additional node, in solver order. Regions have their own at corners that they
  /// share, where `pressure` is the mean of them.
  std::vector<double> corner_pressure = {};
  /// Viscoelastic regions: stored energy per reference volume at the points of history_stress; null too without
  /// Model::stored_energies.
  std::shared_ptr<const std::vector<double>> history_energy = nullptr;
  /// Mixed elements: like corner_pressure, what acts of it: differs in viscoelastic regions alone.
  std::vector<double> acting_pressure = {};
  /// The elements that the state was computed with, so that its measures need not prepare them again; may be null.
  std::shared_ptr<const Elements> elements = nullptr;
};

/// Which parts of ElementResults are computed; the others stay empty.
struct ElementRequest {
  bool law = true;       ///< cauchy, strain, energy_density
  bool J = true;         ///< J
  bool rotation = true;  ///< rotation
  bool tensors = false;  ///< deformation_gradient, first_piola, second_piola, green_lagrange
  bool fibre_stretch = false;
  bool volume = false;          ///< volume, deformed_volume
  bool stress_moments = false;  ///< stress_moments
};

/// What the equations gave at the elements of one state; one entry per mesh cell (zero for cells without unknowns).
/// Means over the quadrature points. 6 components: xx yy zz xy yz xz; 9: xx xy xz yx yy yz zx zy zz.
struct ElementResults {
  std::vector<double> cauchy;          ///< #cells x 6
  std::vector<double> strain;          ///< #cells x 6; the strain of the law (corotated: U - I, small: sym grad u)
  std::vector<double> energy_density;  ///< #cells, per reference volume
  std::vector<double> J;               ///< #cells, smallest det F of the element
  std::vector<double> rotation;        ///< #cells, angle of the polar rotation in degrees, largest of the element
  std::vector<double> deformation_gradient;     ///< #cells x 9, F
  std::vector<double> first_piola;              ///< #cells x 9, P = dW/dF
  std::vector<double> second_piola;             ///< #cells x 6, F^-1 P
  std::vector<double> green_lagrange;           ///< #cells x 6, (F^T F - I)/2
  std::vector<double> fibre_stretch;            ///< #cells, |F g| of the first family of fibres; 1 where there is none
  std::vector<double> volume, deformed_volume;  ///< #cells, integrals of 1 and of det F (times thickness)
  /// #cells x 27: integral of d_j P_iK at 9 j + 3 i + K (3 i + K: xx xy xz yx …), d = F (X - mean of X), in small
  /// strain X - mean of X.
  std::vector<double> stress_moments;
};

/// The check after every run, part of the answer (scene-language, section 4).
struct Check {
  double residual = 0;    ///< ||f_ext - f_int - M a - D v|| over free unknowns, relative to `load_scale`
  double load_scale = 0;  ///< largest of the norms of external, internal, inertia, reaction and spring forces
  Vec3 sum_loads = Vec3::Zero(), sum_reactions = Vec3::Zero(), sum_inertia = Vec3::Zero(), sum_damping = Vec3::Zero();
  double balance = 0;                    ///< |loads + reactions - inertia - damping| relative to the largest of them
  double volume = 0, volume_change = 0;  ///< reference volume; (v - V) / V
  double mass = 0;
  double smallest_J = std::numeric_limits<double>::infinity();
  int smallest_J_element = -1;
  double largest_strain = 0;    ///< largest absolute principal strain of U - I
  double largest_rotation = 0;  ///< degrees
  double damped_per_cycle = 0;  ///< amplitude loss of the lowest free period per cycle; 0 if static
  double lowest_period = 0;     ///< from the smallest eigenvalue (inverse iteration); 0 if static
};

enum class Stop {
  converged,
  newton_limit,
  diverged,
  inverted_element,
  indefinite_tangent,
  linear_solver_limit,
  singular,
  interrupted,
  out_of_memory,
  collapsed,       ///< equilibrium with det F <= 0 in a law that survives inversion
  unstable_step,   ///< an explicit method with too large a time step
  step_too_large,  ///< a step of time or loads that fails where a shorter one from the same state does not
  bad_element      ///< an element that is nearly flat at rest keeps the iteration from its end
};
const char* name(Stop stop);

/// Memory of one use: "matrix", "factor" (or hierarchy), "elements", "mass", "vectors".
struct Held {
  std::string name;
  std::size_t bytes = 0;
};

/// How a run ended and what it cost. Where a tangent is not positive definite, that Newton iteration takes the law's
/// semidefinite one; a static equilibrium whose own tangent is indefinite is unstable: indefinite_tangent.
/// Non-convergence is a result with a reason, never an exception.
struct Outcome {
  Stop stop = Stop::converged;
  std::string diagnosis;  ///< step, residual history, worst element with its place, what to try; "" if converged
  State state;            ///< the last good state
  Check check;            ///< of that state
  double stable_step = std::numeric_limits<double>::infinity();  ///< of explicit methods: the smallest estimate
  std::vector<std::string> notes;                                ///< what was decided on the way, in plain words
  std::vector<std::string> warnings;                             ///< what is to be doubted, in plain words
  std::vector<std::string> recoveries;  ///< where the plain way failed and another led on, in plain words
  long unknowns = 0;
  int newton_iterations = 0, linear_solves = 0;
  long cg_iterations = 0;
  bool cg_gave_up = false;  ///< CG missed its tolerance once, and Cholesky took over
  double seconds_setup = 0, seconds_assembly = 0, seconds_linear = 0;
  std::vector<Held> held;  ///< what the run held in memory at its end, beside the mesh
};

/// Called with every accepted state, the initial one first. Returning false interrupts the run.
using Observer = std::function<bool(const State&)>;

/// Solves all steps. Throws Error only for a model that check() refuses.
Outcome solve(const Model& model, const Observer& observer);

/// Stresses and strains of a state, as far as they are asked for.
ElementResults element_results(const Model& model, const State& state, const ElementRequest& request = {});

/// A field at cells recovered at nodes, by region, exact where linear (Zienkiewicz and Zhu 1992, see recover.cpp);
/// at a node between regions the mean of all. values: #cells x components -> #points x components.
std::vector<double> recover_at_nodes(const Model& model, const std::vector<double>& values, int components);

}  // namespace msml::fe
