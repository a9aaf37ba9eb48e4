// SPDX-License-Identifier: GPL-3.0-or-later
// Kernels one by one, with the bytes and operations that each needs, for the share of what the machine can do.
#include <benchmark/benchmark.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "solver/equations.hpp"
#include "solver/linear/multigrid/multigrid.hpp"
#include "solver/materials/hyperelastic.hpp"
#include "solver/materials/neo_hookean.hpp"
#include "solver/materials/polar.hpp"
#include "tests/bench/handover.hpp"
#include "tests/solver/meshes.hpp"

namespace {

using namespace msml;

/// Operations of the formulas per point or element, counted by hand to about a tenth; a division, a root and a
/// logarithm count as one each, as nobody can do without them.
namespace operations {
constexpr double polar = 112 + 2 * 22 + 114;                   // two steps for tr U where |U - I| is 0.1
constexpr double corotated_stress = polar + 12 + 34 + 31;      // F - R, two sums, P and energy
constexpr double corotated_tangent = 66 + 85 + 135 + 360 + 9;  // U - I, spin stiffness, T Z T^T + lambda r r^T
constexpr double neo_stress = 60 + 45 + 27 + 70 + 27;          // invariants, cofactors, jets, two slopes
constexpr double neo_tangent = 45 * 9 + 45 + 36;               // three products of slopes, curvatures
/// H, P dxi/dX, det F and the energy at each point; slopes and forces of the nodes.
constexpr double frame(int nodes) { return nodes == 4 ? 45 + 54 + 25 + 9 + 18 : 4 * (108 + 54 + 25) + 138 + 410; }
constexpr double stiffness(int nodes) { return 153 * nodes + 54 * nodes * (nodes + 1) / 2.0; }  // with dN/dX
constexpr double single_force = polar + 20 * 15 + 4 * 40 + frame(10);  // one rotation, there and back; Hooke
constexpr double turned = 3 * 15;                                      // R g
constexpr double product = 4 * (108 + 54 + 12) + 138 + 410;            // of a kept tangent: H, stress and forces
}  // namespace operations

/// The beam, bent and twisted so that strains are about 0.1 and rotations large.
struct Beam {
  fe::Model model;
  fe::Equations equations;
  fe::Vector u, force;
  fe::BlockMatrix matrix;
  int elements, nodes_per_element;

  Beam(CellKind kind, int n, bool neo, fe::Formulation formulation = fe::Formulation::standard)
      : model(model_of(kind, n, neo, formulation)),
        equations(model),
        u(equations.size()),
        force(fe::Vector::Zero(equations.size())),
        matrix(equations.elements().pattern()),
        elements(model.mesh->cell_count()),
        nodes_per_element(node_count(kind)) {
    for (int k = 0; k < equations.size(); k += 3) {
      const double x = equations.positions()[k] / 0.1, y = equations.positions()[k + 1];
      u[k] = 0.005 * std::sin(2 * x) - 0.5 * y * x;
      u[k + 1] = 0.02 * x * x;
      u[k + 2] = -0.03 * x * x;
    }
  }

  static fe::Model model_of(CellKind kind, int n, bool neo, fe::Formulation formulation) {
    fe::Model model = fe::testing::beam_model(n, kind, 0.3, fe::Strain::corotated);
    model.formulation = formulation;
    const fe::Lame lame = fe::lame_of(1e5, 0.3);
    if (neo)
      model.regions[0].law = std::make_shared<fe::PotentialLaw<fe::IsochoricNeoHookean>>(
          fe::IsochoricNeoHookean<fe::Lanes>{fe::lanes_of(lame.mu)}, fe::make_volumetric("J1", lame.bulk()),
          fe::LawFacts{.name = "neoHookean", .shear_modulus = lame.mu, .poisson_ratio = 0.3});
    return model;
  }
  int points() const { return nodes_per_element == 4 ? 1 : 4; }
  double nodes_each() const { return static_cast<double>(equations.size()) / 3 / elements; }
  double matrix_bytes() const { return 8.0 * static_cast<double>(matrix.values.size()); }
};

/// Time, bytes and operations per item; items are elements, block rows or points.
void count(benchmark::State& state, double items, double bytes, double flops) {
  state.SetItemsProcessed(static_cast<int64_t>(state.iterations() * static_cast<int64_t>(items)));
  state.counters["bytes_per_item"] = bytes;
  state.counters["flops_per_item"] = flops;
  state.counters["items"] = items;
}

/// Runs the body with as many threads as the last argument says; with two, notes how far they are apart, the longer of
/// the times before and after.
template <class Body>
void repeat(benchmark::State& state, int threads, const Body& body) {
  const double before = threads == 2 ? handover() : 0;
  tbb::task_arena arena(threads);
  arena.execute([&] {
    for (auto _ : state) body();
  });
  if (threads == 2) state.counters["handover"] = std::max(before, handover());
}

/// Reads node numbers, one Jacobian with its weight, displacements; adds to forces.
double force_bytes(const Beam& beam) { return 4 * beam.nodes_per_element + 80 + 72 * beam.nodes_each(); }

void internal_force(benchmark::State& state, CellKind kind, int n, bool neo, int threads) {
  Beam beam(kind, n, neo);
  repeat(state, threads, [&] {
    beam.equations.elements().add_internal(beam.u, fe::Want::stress, beam.force, nullptr);
    benchmark::DoNotOptimize(beam.force.data());
  });
  const double law = neo ? operations::neo_stress : operations::corotated_stress;
  const int nodes = beam.nodes_per_element;
  count(state, beam.elements, force_bytes(beam), beam.points() * law + operations::frame(nodes));
}

void tangent(benchmark::State& state, CellKind kind, int n, bool neo, int threads) {
  Beam beam(kind, n, neo);
  repeat(state, threads, [&] {
    beam.equations.elements().add_internal(beam.u, fe::Want::tangent, beam.force, &beam.matrix);
    benchmark::DoNotOptimize(beam.matrix.values.data());
  });
  const double law = neo ? operations::neo_stress + operations::neo_tangent
                         : operations::corotated_stress + operations::corotated_tangent;
  const int nodes = beam.nodes_per_element;
  // The matrix is set to zero, read and written; each block has its place.
  const double bytes = force_bytes(beam) + 4 * nodes * nodes + 3 * beam.matrix_bytes() / beam.elements;
  count(state, beam.elements, bytes, beam.points() * (law + operations::stiffness(nodes)) + operations::frame(nodes));
}

/// Forces and the tangent of one linear solve per step, R K R^T, of linear tetrahedra: rotated gradients are written by
/// elements and read by rows, which know the places of their parts and write the matrix.
void step_tangent_by_rows(benchmark::State& state, int n, int threads) {
  Beam beam(CellKind::tet4, n, false);
  repeat(state, threads, [&] {
    beam.equations.elements().add_internal(beam.u, fe::Want::single_tangent, beam.force, &beam.matrix);
    benchmark::DoNotOptimize(beam.matrix.values.data());
  });
  const double bytes = force_bytes(beam) + 2 * 32 * 4 + 4 * 12 + beam.matrix_bytes() / beam.elements;
  const double blocks = 12 * 54 + 12 * 5;  // h_a h_b^T twice and h_a . h_b; R dN/dX
  count(state, beam.elements, bytes, operations::corotated_stress + operations::frame(4) + 60 + blocks);  // dN/dX
}

/// The same of quadratic tetrahedra, which keep what it is made of; with a rotation at each of four points, or one.
void step_tangent_kept(benchmark::State& state, int n, fe::Formulation formulation, int threads) {
  const bool single = formulation == fe::Formulation::single_rotation;
  Beam beam(CellKind::tet10, n, false, formulation);
  repeat(state, threads, [&] {
    beam.equations.elements().add_internal(beam.u, fe::Want::single_tangent, beam.force, nullptr);
    benchmark::DoNotOptimize(beam.force.data());
  });
  const double bytes = force_bytes(beam) + (single ? 8 * (30 + 12 + 11) : 8 * 4 * 11);  // X and gradients; what is kept
  count(state, beam.elements, bytes,
        single ? operations::single_force + operations::turned
               : 4 * (operations::corotated_stress + operations::turned) + operations::frame(10));
}

/// Products with it, and with the mass: elements write their parts, nodes read them and their row of the mass.
void product_kept(benchmark::State& state, int n, fe::Formulation formulation, int threads) {
  Beam beam(CellKind::tet10, n, false, formulation);
  beam.equations.elements().add_internal(beam.u, fe::Want::single_tangent, beam.force, nullptr);
  const fe::KeptTangent& kept = *beam.equations.elements().kept_tangent();
  fe::Vector y;
  repeat(state, threads, [&] {
    kept.multiply(1, beam.equations.mass(), beam.u, y);
    benchmark::DoNotOptimize(y.data());
  });
  const double blocks = beam.matrix_bytes() / 72 / beam.elements;
  const double own = formulation == fe::Formulation::single_rotation ? 8 * 11 : 8 * 4 * 11;
  const double bytes = own + 2 * 4 * 10 + 2 * 320 + 12 * blocks + 64 * beam.nodes_each();
  count(state, beam.elements, bytes, operations::product + 6 * blocks + 30);
}

/// The matrix that it stands for, by integration at four points, with forces.
void four_point_matrix(benchmark::State& state, int n, int threads) {
  Beam beam(CellKind::tet10, n, false);
  repeat(state, threads, [&] {
    beam.equations.elements().add_internal(beam.u, fe::Want::single_tangent, beam.force, &beam.matrix);
    benchmark::DoNotOptimize(beam.matrix.values.data());
  });
  const double bytes = force_bytes(beam) + 400 + 3 * beam.matrix_bytes() / beam.elements;
  count(state, beam.elements, bytes,
        4 * (operations::corotated_stress + 360 + operations::stiffness(10)) + operations::frame(10));
}

void matrix_product(benchmark::State& state, CellKind kind, int n, int threads) {
  Beam beam(kind, n, false);
  fe::Vector y(beam.equations.size());
  repeat(state, threads, [&] {
    multiply(beam.matrix, beam.u, y);
    benchmark::DoNotOptimize(y.data());
  });
  const double rows = beam.equations.size() / 3.0, blocks = static_cast<double>(beam.matrix.values.size()) / 9;
  count(state, rows, (76 * blocks) / rows + 52, 18 * blocks / rows);
}

void multigrid_cycle(benchmark::State& state, CellKind kind, int n, int threads) {
  Beam beam(kind, n, false);
  const fe::Vector rest = fe::Vector::Zero(beam.equations.size());
  beam.equations.elements().add_internal(rest, fe::Want::tangent, beam.force, &beam.matrix);
  fe::Mask fixed(static_cast<std::size_t>(beam.equations.size()), 0);
  for (int k = 0; k < beam.equations.size(); ++k)
    fixed[static_cast<std::size_t>(k)] = beam.equations.positions()[k / 3 * 3] < 1e-9;
  fe::Multigrid multigrid(beam.equations.geometry());
  if (multigrid.set(beam.matrix, fixed) != fe::LinearStatus::done) return state.SkipWithError("not positive definite");
  std::vector<float> r(fixed.size() + 8), z(fixed.size() + 8);
  for (std::size_t k = 0; k < fixed.size(); ++k)
    r[k] = fixed[k] ? 0.0f : static_cast<float>(beam.u[static_cast<long>(k)]);
  repeat(state, threads, [&] {
    std::vector<float> b = r;
    multigrid.cycle(b, z);
    benchmark::DoNotOptimize(z.data());
  });
  // A smoother of degree two before and after, and the residual between them: four products with each matrix, in single
  // precision. Grids below the first are left out: the share is a little low.
  const double rows = beam.equations.size() / 3.0, blocks = static_cast<double>(beam.matrix.values.size()) / 9;
  count(state, rows, 4 * (40 * blocks / rows + 80), 4 * (18 * blocks / rows + 30));
}

void polar_decomposition(benchmark::State& state) {
  std::vector<fe::Tensor<fe::Lanes>> F(512), R(512);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> small(-0.1, 0.1);
  for (auto& f : F)
    for (int k = 0; k < 9; ++k)
      for (int lane = 0; lane < fe::lanes; ++lane) f.c[k][lane] = (k % 4 == 0 ? 1 : 0) + small(random);
  for (auto _ : state) {
    for (std::size_t i = 0; i < F.size(); ++i) R[i] = fe::polar_rotation(F[i]);
    benchmark::DoNotOptimize(R.data());
  }
  count(state, static_cast<double>(fe::lanes * F.size()), 0, operations::polar);  // all of it stays in the cache
}

void add_kernels(int scale) {
  const auto add = [](const std::string& name, int threads, auto&& body) {
    benchmark::RegisterBenchmark((name + "/threads:" + std::to_string(threads)).c_str(), body)
        ->UseRealTime()
        ->Unit(benchmark::kMillisecond);
  };
  for (const CellKind kind : {CellKind::tet4, CellKind::tet10}) {
    const std::string element = name(kind);
    const int n = (kind == CellKind::tet4 ? 16 : 8) / scale, large = 3 * n / 2;  // matrices beyond the caches
    for (const int threads : {1, 2}) {
      for (const bool neo : {false, true}) {
        const std::string law = neo ? " neo-Hookean" : " corotated";
        add("internal force " + element + law, threads, [=](auto& s) { internal_force(s, kind, n, neo, threads); });
        add("tangent " + element + law, threads, [=](auto& s) { tangent(s, kind, n, neo, threads); });
      }
      add("block matrix product " + element, threads, [=](auto& s) { matrix_product(s, kind, large, threads); });
      add("multigrid cycle " + element, threads, [=](auto& s) { multigrid_cycle(s, kind, large, threads); });
    }
  }
  for (const int threads : {1, 2}) {
    const int n = 8 / scale;
    add("step tangent tet4", threads, [=](auto& s) { step_tangent_by_rows(s, 2 * n, threads); });
    add("tangent tet10 of four points, for steps", threads, [=](auto& s) { four_point_matrix(s, n, threads); });
    for (const auto formulation : {fe::Formulation::standard, fe::Formulation::single_rotation}) {
      const std::string kind = formulation == fe::Formulation::standard ? "tet10" : "tet10SR";
      add("step tangent " + kind, threads, [=](auto& s) { step_tangent_kept(s, n, formulation, threads); });
      add("product of step tangent " + kind, threads, [=](auto& s) { product_kept(s, n, formulation, threads); });
    }
  }
  add("polar decomposition", 1, polar_decomposition);
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  add_kernels(argc > 1 && std::string(argv[1]) == "quick" ? 4 : 1);
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
