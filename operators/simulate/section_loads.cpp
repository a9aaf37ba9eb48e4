// SPDX-License-Identifier: GPL-3.0-or-later
// Integrates shape functions over the elements that a plane cuts, and over their parts on one side.
#include "operators/simulate/section_loads.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "solver/elements/mass.hpp"

namespace msml::simulation {
namespace {

/// Matrices of one element, and what they are made of.
template <int dimension, int nodes>
class ElementShare {
 public:
  ElementShare(const fe::Model& model, const fe::Region& region, int element)
      : points_(model.mesh->points),
        ids_(model.mesh->cell(element)),
        region_(region),
        element_(element),
        thickness_(dimension < 3 ? model.thickness : 1) {}

  fe::ElementMass<nodes> mass(bool lumped) const {
    const auto density = [&](const Vec3& X) { return thickness_ * this->density(X); };
    const fe::ElementMass<nodes> M = region_.density_at
                                         ? fe::consistent_mass<dimension, nodes>(points_, ids_, density)
                                         : fe::consistent_mass<dimension, nodes>(points_, ids_, density({}));
    return lumped ? fe::lumped_mass<nodes>(M) : M;
  }
  fe::ElementMass<nodes> volume() const { return fe::consistent_mass<dimension, nodes>(points_, ids_, thickness_); }

  /// mass and volume += sign times their integrals over a part.
  void add(const Part& part, double sign, fe::ElementMass<nodes>& mass, fe::ElementMass<nodes>& volume) const {
    // N_a N_b is of degree 4 in quadratic elements; parts of curved ones are many and small.
    static const fe::Rule<dimension> rule = fe::rule_of_size<dimension>(nodes > dimension + 1 ? 3 : 2);
    const PartMap<dimension> map(part);
    const double size = map.size();
    for (const auto& q : rule) {
      const auto xi = map.at(q.xi);
      const auto N = fe::Simplex<dimension, nodes>::values(xi);
      const double weight =
          sign * thickness_ * size * q.weight * fe::jacobian<dimension, nodes>(points_, ids_, xi).determinant();
      const double rho = density(fe::place<dimension, nodes>(points_, ids_, xi));
      const Eigen::Map<const Eigen::Matrix<double, nodes, 1>> shape(N.data());
      const fe::ElementMass<nodes> product = weight * shape * shape.transpose();
      volume += product;
      mass += rho * product;
    }
  }

 private:
  double density(const Vec3& X) const { return region_.density_at ? region_.density_at(element_, X) : region_.density; }

  const Points& points_;
  const int* ids_;
  const fe::Region& region_;
  int element_;
  double thickness_;
};

bool is_lumped(const fe::Settings& settings) {
  return (settings.lumped_mass && fe::is_dynamic(settings.integrator)) || fe::is_explicit(settings.integrator);
}

/// int (w - H) N_a N_b: with density, without.
template <int dimension, int nodes>
std::pair<Eigen::MatrixXd, Eigen::MatrixXd> matrices(const fe::Model& model, const fe::Region& region, int element,
                                                     const CuttingPlane& plane, const std::vector<double>& weights) {
  const ElementShare<dimension, nodes> share(model, region, element);
  Eigen::Matrix<double, nodes, 1> w;
  for (int a = 0; a < nodes; ++a) w[a] = weights[static_cast<std::size_t>(model.mesh->cell(element)[a])];
  fe::ElementMass<nodes> mass = w.asDiagonal() * share.mass(is_lumped(model.settings)),
                         volume = w.asDiagonal() * share.volume();
  const ElementCut cut = cut_element(*model.mesh, element, plane);
  for (const Part& part : cut.above) share.add(part, -1, mass, volume);
  for (const Part& part : cut.missing) share.add(part, 1, mass, volume);
  return {mass, volume};
}

auto matrices_of(CellKind kind) {
  switch (kind) {
    case CellKind::line2:
      return matrices<1, 2>;
    case CellKind::line3:
      return matrices<1, 3>;
    case CellKind::tri3:
      return matrices<2, 3>;
    case CellKind::tri6:
      return matrices<2, 6>;
    case CellKind::tet4:
      return matrices<3, 4>;
    default:
      return matrices<3, 10>;
  }
}

/// True where the weights are 1 on all of the element above the plane, and 0 on all of it below.
bool agrees(const Mesh& mesh, int element, const CuttingPlane& plane, const std::vector<double>& weights) {
  const PlaneSide side = side_of(mesh, element, plane);
  const double expected = side == PlaneSide::above ? 1 : 0;
  const int* ids = mesh.cell(element);
  return side != PlaneSide::both &&
         std::all_of(ids, ids + node_count(mesh.kinds[static_cast<std::size_t>(element)]),
                     [&](int n) { return std::abs(weights[static_cast<std::size_t>(n)] - expected) < 1e-12; });
}

}  // namespace

double ActingStep::factor(const fe::BodyForce& force, double time) const {
  const bool follows = force.factor || (force.function && !force.steady);
  return (follows ? timed : steady) * (force.factor ? force.factor(time) : 1);
}

double ActingStep::factor(const fe::FaceLoad& load, double time) const {
  const bool follows = load.factor || ((load.traction_function || load.pressure_function) && !load.steady);
  return (follows ? timed : steady) * (load.factor ? load.factor(time) : 1);
}

std::vector<ActingStep> acting_steps(const fe::Model& model, const fe::State& state) {
  const fe::Step* now = &model.steps[static_cast<std::size_t>(state.step)];
  const fe::Integrator integrator = model.settings.integrator;
  if (fe::is_dynamic(integrator)) return {{now, 1, 1}};
  if (state.increment == 0) return {};
  if (integrator == fe::Integrator::quasi_static) return {{now, 1, 1}};
  std::vector<ActingStep> acting{{now, state.load_factor, 1}};
  if (state.step > 0) acting.push_back({now - 1, 1 - state.load_factor, 0});
  return acting;
}

Vec3 force_per_mass(const fe::Model& model, const fe::State& state, const std::vector<ActingStep>& acting, int point) {
  Vec3 sum = -state.acceleration.row(point) - model.settings.damping_mass * state.velocity.row(point);
  for (const ActingStep& each : acting) {
    const fe::Step& step = *each.step;
    const double factor = step.gravity_function && !step.gravity_steady ? each.timed : each.steady;
    if (factor == 0) continue;
    sum +=
        factor * (step.gravity_function ? step.gravity_function(model.mesh->points.row(point).transpose(), state.time)
                                        : step.gravity);
  }
  return sum;
}

SectionLoads::SectionLoads(const fe::Model& model, const CuttingPlane& plane, const std::vector<double>& weights)
    : model_(model) {
  const Mesh& mesh = *model.mesh;
  for (const fe::Region& region : model.regions)
    for (const int element : region.elements) {
      if (agrees(mesh, element, plane, weights)) continue;
      const CellKind kind = mesh.kinds[static_cast<std::size_t>(element)];
      auto [mass, volume] = matrices_of(kind)(model, region, element, plane, weights);
      shares_.push_back({element, std::move(mass), std::move(volume)});
      points_.insert(points_.end(), mesh.cell(element), mesh.cell(element) + node_count(kind));
    }
  std::sort(points_.begin(), points_.end());
  points_.erase(std::unique(points_.begin(), points_.end()), points_.end());
}

void SectionLoads::add(int element, const Eigen::MatrixXd& matrix, const Density& density, const Points& x,
                       const Vec3& centre, Pull& sum) const {
  const Mesh& mesh = *model_.mesh;
  const int* ids = mesh.cell(element);
  for (Eigen::Index b = 0; b < matrix.cols(); ++b) {
    Vec3 arm = Vec3::Zero(), load = density(ids[b]);
    // A problem of fewer dimensions has no forces across.
    for (int k = dimension(mesh.kinds[static_cast<std::size_t>(element)]); k < 3; ++k) load[k] = 0;
    for (Eigen::Index a = 0; a < matrix.rows(); ++a) arm += matrix(a, b) * (x.row(ids[a]).transpose() - centre);
    sum.force += matrix.col(b).sum() * load;
    sum.moment += arm.cross(load);
  }
}

void SectionLoads::add_masses(const Density& per_mass, const Points& x, const Vec3& centre, Pull& sum) const {
  for (const Share& share : shares_) add(share.element, share.mass, per_mass, x, centre, sum);
}

void SectionLoads::add_body_force(const fe::BodyForce& force, double factor, double time, const Points& x,
                                  const Vec3& centre, Pull& sum) const {
  if (shares_.empty() || factor == 0) return;
  std::vector<char> acts(model_.mesh->kinds.size(), 0);
  for (const int element : force.elements) acts[static_cast<std::size_t>(element)] = 1;
  const auto density = [&](int point) -> Vec3 {
    return factor * (force.function ? force.function(model_.mesh->points.row(point).transpose(), time) : force.value);
  };
  for (const Share& share : shares_)
    if (acts[static_cast<std::size_t>(share.element)] != 0) add(share.element, share.volume, density, x, centre, sum);
}

}  // namespace msml::simulation
