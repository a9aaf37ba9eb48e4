// SPDX-License-Identifier: GPL-3.0-or-later
// What every integrator does: walk through the steps, report states, explain failures.
#pragma once
#include <optional>

#include "solver/conditions/rigid.hpp"
#include "solver/untangle.hpp"

namespace msml::fe {

/// The state of a run in solver numbering.
struct Motion {
  Vector u, v, a;
  Vector reaction;  ///< force of the constraint on the body; zero at free unknowns
  double time = 0;
  int step = 0, increment = 0;
  Energies energies = {};
  double load_factor = 1;
};

/// Everything that an integrator works with.
struct Run {
  const Model& model;
  Equations& equations;
  Newton& newton;
  const Observer& observer;
  Outcome& outcome;
  Motion now;
  std::vector<double> residuals = {};                                      ///< of the increment that failed
  Vector external_before = {}, reaction_before = {}, damping_before = {};  ///< forces at the last mark
  double marked = 0;                                                       ///< time of the last mark
  Vector internal_before = {};         ///< internal forces at the last mark, where there is a history
  double piece = 0;                    ///< adaptive_step: length of the next piece, in time; 0: not known yet
  int pieces = 0;                      ///< implicit dynamics: time steps taken
  FreeMotions free = {};               ///< rigid motions that the supports of the present step leave
  std::optional<Forces> between = {};  ///< balanced forces, where these are not those at the present time
  Vector acceleration_now = {};        ///< where that of the method, now.a, belongs to another time; empty: it does not
  double step_of_a = 0;                ///< length of the steps that now.a goes with, see change_step(); 0: any
  std::optional<double> energy_at_start = {};  ///< elastic and kinetic, at the first mark
  double gained = 0;                           ///< energy beside that at the start, work and dissipation
  double most_gained = 0, most_lost = 0;       ///< its largest values at any mark
  double most_energy = 0;                      ///< largest of all of these
  bool tangled = false;  ///< at the last mark an element had less than a tenth of its volume, or was inside out
  std::optional<double> first_inverted = {}, last_inverted = {};  ///< times of marks with elements inside out
  std::unique_ptr<Untangler> untangler = {};
  int halved = 0;     ///< pieces of load or time that failed and were halved
  int unsettled = 0;  ///< time steps whose damping forces the end of the step would change by a thousandth of all
  int untangled = 0;  ///< increments that went on from where the untangler led

  /// Takes up what the supports of a static step leave free, if anything.
  void hold(const Step& step, const Mask& fixed);
  /// Takes the initial velocity away from what the supports hold, and notes that.
  void hold_start(const Supports& supports);
  /// Takes the present velocity away from what the supports hold.
  void halt(const Supports& supports);
  /// Dynamics: the motion at the start of the first step is what the supports and incompressible regions make of the
  /// initial one; notes say what was changed. Throws Error where the initial one changes volumes that are kept.
  void begin_motion(const Step& step, const Supports& supports);
  /// The same at later steps, whose supports may change their speed at once: where volumes are kept, all before them
  /// follows. The supports' work is what the kinetic energy gains. Backward Euler has the jump within its step.
  void jump_with_supports(const Step& step, const Supports& supports);
  /// The accelerations of the present state, and the pressures of incompressible regions with them.
  void begin_balance(const Step& step, const Supports& supports);
  /// Throws Error where a static step pushes what it does not hold, before anything runs.
  void refuse_pushed_bodies();
  /// Displacements that a run begins with bring their pressures along.
  void settle_pressures();
  /// False where the forces of the state that a run begins with are not finite; the outcome is explained then.
  /// Otherwise materials with a history take it over, as if its strain had come at once just before.
  bool sound_start();
  /// Begins statics: refuses pushed bodies and passes the state without loads on; false if the observer wants to stop.
  bool start_at_rest();
  /// Throws Error unless these loads leave the free rigid motions alone.
  void check_balanced(const ScaledLoads& loads) const;
  State state() const;
  /// Newton's way to the end of an increment; from a tangled state first with the stable law, whose answer is where the
  /// model's own laws start, and from the tangled state itself where that fails.
  IncrementResult reach(const Increment& increment);
  /// Passes the present state on; false if the observer wants to stop. Sets Outcome::stop then.
  bool accept();
  /// Dynamics: the run has failed, and is explained, if its last state is one with inverted elements whose laws have
  /// forces there; through such states it may pass. Settings::allow_inverted takes them all.
  void judge_end();
  /// Reactions that balance a residual.
  void set_reactions(const Vector& residual, const Supports& supports);
  /// Work and loss from u_before to the present state by the trapezoidal rule, with the forces at the last mark and
  /// those that Newton evaluated last, after the elements took over the end of the step. Marks.
  void account(const Vector& u_before);
  /// The present forces are those that the next account starts from; energies are measured.
  void mark();

 private:
  void measure_energies();
  void refuse_volume_changes();
  /// 1 for the pressures that keep volumes in the present state, which is prepared; empty where none does.
  Mask kept_volumes();
};

/// The way of loads and supports over a step, or a part of it, for equilibrium without inertia.
struct EquilibriumPath {
  std::function<ScaledLoads(double share)> loads;  ///< at a share of the path in (0, 1]
  Supports supports;
  double start, duration;  ///< time
  double time(double share) const { return start + share * duration; }
  double share(double at) const { return (at - start) / duration; }
};

/// Enters a step: the path from the present state over the whole of it, whose loads are still to be said.
EquilibriumPath begin_path(Run& run, int step);

/// Goes along a path from one share to another, in halved pieces where Newton's method fails; at most 2^6 pieces, 2^12
/// with adaptive_step, where the length of the next piece also follows the number of iterations.
/// False if that fails: the outcome is explained then, and the present state is the last equilibrium that was found.
bool advance(Run& run, const EquilibriumPath& path, double from, double to);

/// Load steps to equilibrium; see static.cpp.
void run_static(Run& run);
/// Static equilibria along an arc of loads and displacements; see arc_length.cpp.
void run_arc_length(Run& run);
/// Equilibrium at each time step; see quasi_static.cpp.
void run_quasi_static(Run& run);
/// Time steps with equations to solve; see implicit.cpp.
void run_implicit(Run& run);

/// Time steps without equations to solve; see explicit.cpp.
void run_explicit(Run& run);

/// True if the balance holds between the ends of the step.
bool blends(const Kinematics& motion);
/// The acceleration a of such a method belongs to a time beside the end of its step. What the balance asks for at the
/// ends, b, comes from it: m a1 + (1 - m) a0 = f b1 + (1 - f) b0 with the shares m of inertia and f of forces. Makes it
/// Run::acceleration_now at the end of a step; `before`: the method's acceleration at its start.
void balance_end(Run& run, const Kinematics& motion, const Supports& supports, const Vector& before, double time);
/// Before a step of length h. With z = h (a - b) a step of such a method does v1 + (f - 1/2) z1 = v0 + (f - 1/2) z0 +
/// h (b0 + b1)/2 and m z1 = -(1 - m) z0 + (f - m) h (b1 - b0): momentum is kept, whatever the lengths are, if v and z
/// pass from each step to the next. z is of second order in h as are all its effects, so that the order of the method
/// stays, and steps of one length are untouched.
void change_step(Run& run, const Supports& supports, double h);
/// At kinks of loads, where b changes its slope, and at jumps, z belongs to what was before: v takes it up, and a = b.
void start_anew(Run& run, const Supports& supports);

/// True if a load curve of the step has a kink at a time.
bool kink_at(const Step& step, double time);
/// Where adaptive steps of a step from one time towards another end at the latest: at the next kink of its load curves.
double next_stop(const Step& step, double from, double to);

/// How an implicit method ties velocity and acceleration to the displacement at the end of a step of dt.
Kinematics kinematics(const Settings& settings, const Motion& now, const Mask& fixed, double dt);

/// Sets Outcome::stop and a diagnosis in plain words from an increment that failed.
/// `share` is the share of the loads (statics) that was tried; negative where time is what counts. `evidence` for that
/// reason, if there is any, is told with it.
void explain(Run& run, const IncrementResult& result, double share, const std::string& evidence = "");

/// An iteration that led nowhere, on a path whose last equilibrium is the present state: looks for a better reason and
/// returns what speaks for it. inverted_element: where it ended, an element is; indefinite_tangent: the lowest
/// eigenvalue of the tangent falls towards zero along the path and is below it beyond. "" and no change otherwise.
std::string find_cause(Run& run, const EquilibriumPath& path, double share, IncrementResult& result);
/// The same for an increment of which no more is known than its iterations. bad_element: what is left is largest at an
/// element that is nearly flat. step_too_large: a part of what acts at once was reached. indefinite_tangent: half of
/// the iterations or more met an indefinite tangent, or went a small part of their step only: the residual r has a
/// minimum there that is no equilibrium, and K r = 0 says that the tangent is singular.
std::string cause_of_iterations(const Run& run, IncrementResult& result);

}  // namespace msml::fe
