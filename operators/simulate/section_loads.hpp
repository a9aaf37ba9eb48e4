// SPDX-License-Identifier: GPL-3.0-or-later
// Loads and inertia per volume between a plane and the nodes on one side of it.
#pragma once
#include <Eigen/Core>
#include <functional>
#include <vector>

#include "operators/simulate/plane_cut.hpp"
#include "solver/model.hpp"

namespace msml::simulation {

/// A force and its moment about a point.
struct Pull {
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
};

/// A step whose loads act, and the factors that they act with: those that ramp with the loads, and those that follow
/// time.
struct ActingStep {
  const fe::Step* step;
  double steady, timed;
  double factor(const fe::BodyForce& force, double time) const;
  double factor(const fe::FaceLoad& load, double time) const;
};
/// The steps whose loads act in a state: none at the start of statics; while a static step ramps that before it too.
std::vector<ActingStep> acting_steps(const fe::Model& model, const fe::State& state);

/// Gravity less acceleration and mass-proportional damping, at a point of the body's mesh: force per mass.
Vec3 force_per_mass(const fe::Model& model, const fe::State& state, const std::vector<ActingStep>& acting, int point);

/// The loads on the volume that belong to the nodes of one side, less those on the volume of that side: each node's
/// weight says how much of it belongs to the side of the plane's normal. By as much, up to the loads on half the
/// elements that are cut, nodal forces differ from the force in the section.
class SectionLoads {
 public:
  /// A force per mass or per volume at a point of the mesh.
  using Density = std::function<Vec3(int point)>;

  /// Of the elements of a model's regions. The model must outlive the loads.
  SectionLoads(const fe::Model& model, const CuttingPlane& plane, const std::vector<double>& weights);
  /// Adds the sum of loads per mass and their moment about `centre`, of a body with points at `x`.
  void add_masses(const Density& per_mass, const Points& x, const Vec3& centre, Pull& sum) const;
  /// The same of a body force times a factor.
  void add_body_force(const fe::BodyForce& force, double factor, double time, const Points& x, const Vec3& centre,
                      Pull& sum) const;
  /// Points of elements that count, each once.
  const std::vector<int>& points() const { return points_; }

 private:
  /// Of one element: int (w - H) N_a N_b with the density and without, w the weights of nodes a, H = 1 on the side of
  /// the normal.
  struct Share {
    int element;
    Eigen::MatrixXd mass, volume;
  };
  void add(int element, const Eigen::MatrixXd& matrix, const Density& density, const Points& x, const Vec3& centre,
           Pull& sum) const;
  const fe::Model& model_;
  std::vector<Share> shares_;
  std::vector<int> points_;
};

}  // namespace msml::simulation
