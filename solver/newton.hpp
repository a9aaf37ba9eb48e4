// SPDX-License-Identifier: GPL-3.0-or-later
// Newton's method for one increment of load or time.
#pragma once
#include <optional>

#include "solver/effective_products.hpp"
#include "solver/equations.hpp"
#include "solver/linear/linear_system.hpp"

namespace msml::fe {

/// What one increment asks for.
struct Increment {
  Vector start;  ///< displacement to start from
  Mask fixed;
  Vector target;  ///< displacement of fixed unknowns at the end
  ScaledLoads loads;
  Kinematics motion;
  const BlockMatrix* damping_matrix = nullptr;  ///< beside alpha M; null without
  Vector offset = {};  ///< residual to end with: minus what the start of the step puts into the balance; empty: zero
  const Slides* slides = nullptr;  ///< nodes in planes; null: none
  Vector expected = {};            ///< change of the displacement that is likely; empty: none
  double met = 0;                  ///< largest scale of the forces met on the way to `start`
  bool near = false;  ///< the forces evaluated last are those at `start`, and its damping alone has changed since: the
                      ///< matrix that was factorised last serves for the first iteration
};

/// How it went.
struct IncrementResult {
  Stop stop = Stop::converged;
  Vector u;                       ///< displacement at the end (or where it stopped)
  std::vector<double> residuals;  ///< norm of the free residual after each iteration, the first before any
  double scale = 0;               ///< largest of the norms of external, internal, inertia and reaction forces
  double largest_scale = 0;       ///< of the scales over the iterations
  double early_scale = 0;         ///< of the scales up to the first iteration
  int worst_element = -1;         ///< cell id: the smallest det F
  double worst_J = 0;
  int worst_node = -1;  ///< mesh point with the largest residual
  int definite = 0;     ///< iterations that took the semidefinite tangent
  int stunted = 0;      ///< iterations that went less than an eighth of Newton's step
  /// Shares of the displacement and (as a root: of its norm) of the energy that are estimated to be missing at the end;
  /// -1: not looked at, as the residual was not small enough or round-off all that was left.
  double missing_way = -1, missing_energy = -1;
  double walked = 0;  ///< where pieces of the increment were tried: the share that was reached
};

/// The set whose springs act, and the time where they change with it.
struct ActingSprings {
  const LoadSet* set = nullptr;
  double time = 0;
  bool operator==(const ActingSprings&) const = default;
};

/// Work space and statistics of all increments of a run.
///
/// An increment has converged where, with t = Settings::tolerance,
/// - residual: |r| <= t times the largest of the norms of external, internal, inertia and reaction forces,
/// - increment: |d| <= t times the largest displacement at the start or the end (max norms of displacements),
/// - energy: |r.d| <= t^2 times the largest of the energies stored at the start and the end and the works of external,
///   internal, inertia and damping forces over the way gone: its root is the error's energy norm.
/// d is what a further step would add. It is not taken but foreseen by the matrix that was factorised last (the
/// simplified Newton correction of Deuflhard 2011, doi 10.1007/978-3-642-23899-4, section 2.1, with the sum of the
/// series that its contraction promises); after an exact step of less than sqrt(t)/10 of both scales there is no need.
/// So a residual that is small beside the reactions of stiff parts does not hide the way of soft ones. Linear problems
/// end after one solution, whose accuracy is Settings::linear_tolerance. Each criterion has a floor where round-off in
/// displacements and strains is all that is left.
class Newton {
 public:
  Newton(const Model& model, const Equations& equations);

  /// Runs up to Settings::newton_iterations iterations; with 1, one linear solve and no convergence test.
  /// The tangent is the law's own; where it is not that of a stable equilibrium, the iteration takes the law's
  /// semidefinite one. Mixed elements search for a smaller residual or slope instead of a smaller energy. A static
  /// state that is in equilibrium but has an indefinite tangent is unstable: Stop::indefinite_tangent.
  IncrementResult run(const Increment& increment);
  /// The same, first with full steps: near a time step's start they converge where a search along a sliver's sharp
  /// turns only creeps. Where they fail with the line search; where that fails too, walks to the solution along R(u) =
  /// (1 - s) R(start), s from 0 to 1, with the supports moving in proportion, in pieces that halve on failure and
  /// double on success (at least 2^-10).
  IncrementResult walk(const Increment& increment);

  /// Forces and tangent at u, which the next increment starts from unless forget() is called.
  void prepare(const Vector& u, const ScaledLoads& loads);
  /// Rigid motions are free in the increments to come: the matrix is shifted a little, and the solution refined.
  void free_rigid_motions(bool free) { rigid_free_ = free, factor_known_ = false; }
  /// Forces at u alone.
  void look(const Vector& u, const ScaledLoads& loads);
  /// Forces of the start of a step that is to be tried again; the next increment starts from forces of its own.
  void go_back(const Forces& start) { forces_ = start, tangent_current_ = false; }
  void forget() { tangent_current_ = false; }
  /// The semidefinite stiffness of elements and springs at u.
  void stiffness(const Vector& u, const ScaledLoads& loads, BlockMatrix& K);
  /// C = beta K + dampers at u, with that stiffness: an indefinite one would feed energy in. False if there is none.
  bool damping(const Vector& u, const ScaledLoads& loads, BlockMatrix& C);
  /// Adds inertia and damping to the forces, or none; see Equations::evaluate_motion.
  void move(const Vector& velocity, const Vector& acceleration, const BlockMatrix* damping_matrix,
            const Vector* matrix_velocity = nullptr);
  void rest();
  /// converged, or what is wrong with the state evaluated last: not finite, an element inverted whose law does not
  /// survive that, or in statics a collapsed one.
  Stop state_verdict() const;
  /// M a = external - internal - damping at free unknowns, a = `given` at fixed ones. Where moduli are infinite, u gets
  /// the pressures that go with it, B p beside the internal forces: those with which c keeps its rate, B^T a +
  /// c''(u)[v, v] = 0 (see kept_volume.hpp). `balanced` is false where these equations are singular; u keeps its
  /// pressures then.
  Vector initial_acceleration(Vector& u, const Vector& v, const ScaledLoads& loads, const Supports& supports,
                              const Vector& given, bool& balanced);
  /// How far the start of a run was from keeping the volumes that infinite moduli keep.
  struct Kept {
    bool done = true;                       ///< false: the equations are singular, or lead nowhere; nothing changed
    double displacement = 0, velocity = 0;  ///< largest change beside the largest value; 0: all were kept already
  };
  /// Changes u as little as may be, in the norm of the mass, so that c(u) = 0, and makes v what is left of the velocity
  /// `before` once supports have suddenly the velocities that v has there: M (v - before) = -B y at free unknowns with
  /// B^T v = 0.
  Kept keep_volumes(Vector& u, Vector& v, Vector before, const Supports& supports);
  /// Mixed elements: gives u the pressures that belong to its displacements, int N_c (g(F) - p / k) = 0 for each corner
  /// (see MixedElements). Returns how many are not determined so, as k is infinite: these keep their values. Nothing
  /// changes where the forces at u are not finite.
  int settle_pressures(Vector& u);
  /// What is missing in the balance of an increment with the forces that were last evaluated.
  Vector residual(const Increment& increment) const;
  /// What round-off changes in displacements at u and in strains times the size of elements.
  double finest(const Vector& u) const;
  const Forces& forces() const { return forces_; }  ///< at the last u that was evaluated
  const BlockMatrix& tangent();                     ///< as prepare() left it; an increment may change it
  const BlockMatrix* followers() const { return followers_.get(); }  ///< null without follower pressure
  int iterations() const { return iterations_; }                     ///< so far
  /// Adds to the counts of iterations and linear solves.
  void count(int iterations, int solves) { iterations_ += iterations, solves_ += solves; }
  LinearSystem& linear() { return *linear_; }
  /// Copies counts and times.
  void report(Outcome& outcome) const;

 private:
  /// The matrix of the increment; unless it is to be kept, the tangent may become it.
  LinearStatus factor(const Increment& increment, bool keep_tangent = true);
  /// Where the tangent of `want` goes; null: the elements keep it.
  BlockMatrix* place_of(Want want);
  /// The linear system takes the tangent that elements keep, with inertia.
  bool take_kept(const Increment& increment, double inertia);
  /// What a linear solution may leave: far from equilibrium a thousandth serves, and less the nearer it is, so that the
  /// iteration keeps its order (Dembo, Eisenstat and Steihaug 1982, doi 10.1137/0719025). With one solution a step it
  /// is what was asked for, unless forces cancel but for what round-off explains at each unknown: a body at rest costs
  /// little.
  double linear_tolerance(const Increment& increment, const Vector& right) const;
  LinearStatus solve(const Increment& increment, const Vector& right, double tolerance, Vector& step);
  /// By a factorisation of the tangent with the followers' part, symmetric or not.
  LinearStatus factor_whole(const Increment& increment);
  LinearStatus direction(const Increment& increment, const Vector& u, const Vector& jump, const Vector& residual,
                         Vector& step);
  Vector free_residual(const Increment& increment) const;
  void evaluate(const Increment& increment, const Vector& u, Want want, bool with_tangent);
  void pulse() const {
    if (model_.settings.pulse) model_.settings.pulse();
  }
  LinearStatus attempt(const Increment& increment, const Vector& jump, const Vector& residual, Vector& step);
  IncrementResult begin(const Increment& increment, const Vector& jump);
  void take_jump(const Increment& increment, const Vector& jump, const Vector& step, Vector& u);
  /// The share of `direction` that was taken: u and the forces are at its end. 0: no share makes u better.
  double line_search(const Increment& increment, const Vector& direction, const Vector& residual, Vector& u);
  double residual_search(const Increment& increment, const Vector& direction, const Vector& residual, Vector& u);
  bool indefinite(LinearStatus status) const;
  /// The determinant of the matrix that factor_whole() took has not the sign that it has at a stable equilibrium, where
  /// each pressure brings one negative eigenvalue.
  bool unstable_whole() const;
  bool accepted(const Increment& increment, const Vector& residual, IncrementResult& result);
  /// A length and an energy: of a step, of what is missing, or what these are measured by.
  struct Size {
    double way = 0, energy = 0;
  };
  Size scale(const Increment& increment, const Vector& u) const;
  /// Of a step that a residual asks for; pressures are no way.
  Size size_of(const Vector& step, const Vector& residual) const;
  /// True if round-off in displacements and strains explains what is left at each free unknown.
  bool at_round_off(const Vector& residual, const Mask& fixed, const Vector& u) const;
  /// The criteria of increment and energy, where the residual's is met.
  bool complete(const Increment& increment, const Vector& residual, IncrementResult& result);
  /// A matrix that was factorised is one of this motion.
  bool fits(const Kinematics& motion) const;
  /// A solution by the matrix that was factorised last.
  LinearStatus solve_again(const Increment& increment, const Vector& residual, double tolerance, Vector& step);
  /// What a further step would add, by the matrix that was factorised last; false where there is none.
  bool correction(const Increment& increment, const Vector& residual, Vector& step);
  bool exploded(const IncrementResult& result) const;
  Stop not_finite() const;  ///< why the state evaluated last has no finite forces
  double round_off(const Vector& u) const;
  void note_residual(const Increment& increment, const Vector& residual, IncrementResult& result) const;
  Stop verdict(const Increment& increment, IncrementResult& result);

  const Model& model_;
  const Equations& equations_;
  Eigen::RowVector3d extent_;  ///< of the mesh
  std::unique_ptr<LinearSystem> linear_;
  std::unique_ptr<LinearSystem> unsymmetric_;  ///< takes over where follower pressure makes the iteration fail
  BlockMatrix tangent_, effective_;            ///< effective_: with inertia, damping and what else makes it solvable
  const BlockMatrix* factored_ = &tangent_;    ///< the one of both that was factorised last
  const KeptTangent* kept_ = nullptr;          ///< serves instead of tangent_ with one solution a step; null: does not
  bool held_ = false;                          ///< the tangent evaluated last is that, and tangent_ an older one
  std::optional<EffectiveProducts> products_;  ///< of the system that was solved last with it
  std::unique_ptr<BlockMatrix> whole_;         ///< effective_ and followers_; null until needed
  std::unique_ptr<BlockMatrix> followers_;     ///< stiffness of the follower pressure; null without
  Forces forces_;
  Want want_;
  bool tangent_current_ = false;      ///< tangent_ belongs to the displacement that increments start from
  ActingSprings springs_in_tangent_;  ///< that it holds
  bool lifted_ = false;               ///< the diagonal of the definite tangent is raised
  bool searching_ = true;             ///< the line search is on
  bool energetic_ = true;             ///< forces are derivatives of an energy, which the line search looks at
  bool barrier_ = false;              ///< a law does not survive inversion
  bool rigid_free_ = false;           ///< the matrix is singular, as nothing holds the body
  bool insist_definite_ = false;      ///< the exact tangent led nowhere in the last iteration
  double last_step_ = 0;  ///< largest entry of the last step before the line search; infinite without the exact tangent
  std::vector<char> survives_;   ///< of each cell: its law survives inversion
  bool definite_taken_ = false;  ///< the last step came from the semidefinite tangent
  bool whole_taken_ = false;     ///< the last step came from factor_whole()
  bool indefinite_ = false;      ///< the last exact tangent was not that of a stable equilibrium
  double round_off_ = 0;         ///< norm of the residual that round-off in the strains alone can leave
  Size last_;                    ///< the last step; 0 before any
  bool exact_ = false;           ///< that was Newton's, to its full length
  double start_energy_ = 0;      ///< stored at the start of the increment
  bool factor_known_ = false;    ///< a matrix was factorised that may serve at the start of the next increment
  double factor_velocity_ = 0, factor_acceleration_ = 0;  ///< Kinematics factors of that matrix
  int iterations_ = 0, solves_ = 0;
  int definite_ = 0, walked_ = 0;  ///< iterations with a semidefinite tangent, increments reached in pieces
  double seconds_assembly_ = 0, seconds_linear_ = 0;
};

/// True if displacements off by `fine` explain what is left at each free unknown, beside its own stiffness: what is
/// round-off to stiff parts is a load to soft ones.
bool is_round_off(const Vector& residual, const BlockMatrix& K, const Mask& fixed, double fine);

/// Norm over the free unknowns.
double free_norm(const Vector& v, const Mask& fixed);

}  // namespace msml::fe
