// SPDX-License-Identifier: GPL-3.0-or-later
// Small structured meshes and models for the solver's tests.
#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <memory>
#include <utility>
#include <vector>

#include "solver/materials/linear_elastic.hpp"
#include "solver/model.hpp"

namespace msml::fe::testing {

/// Grid of nx x ny x nz unit cubes, each cut into six tetrahedra that share the diagonal from low to high corner.
/// `place` maps grid coordinates (i/nx, j/ny, k/nz) to positions; it must keep the orientation.
inline Mesh grid_mesh(int nx, int ny, int nz, CellKind kind, const std::function<Vec3(double, double, double)>& place) {
  // A quadratic mesh is a linear one on half steps: mid nodes sit on the doubled grid and are placed like corners.
  const int f = kind == CellKind::tet10 ? 2 : 1;
  const auto id = [&](std::array<int, 3> g) { return (g[0] * (f * ny + 1) + g[1]) * (f * nz + 1) + g[2]; };
  Mesh mesh;
  mesh.points.resize((f * nx + 1) * (f * ny + 1) * (f * nz + 1), 3);
  for (int i = 0; i <= f * nx; ++i)
    for (int j = 0; j <= f * ny; ++j)
      for (int k = 0; k <= f * nz; ++k)
        mesh.points.row(id({i, j, k})) = place(i / double(f * nx), j / double(f * ny), k / double(f * nz)).transpose();
  const std::array<std::array<int, 3>, 6> orders{{{0, 1, 2}, {0, 2, 1}, {1, 0, 2}, {1, 2, 0}, {2, 0, 1}, {2, 1, 0}}};
  const std::array<bool, 6> even{true, false, false, true, true, false};
  const std::array<std::array<int, 2>, 6> edges{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
  for (int i = 0; i < nx; ++i)
    for (int j = 0; j < ny; ++j)
      for (int k = 0; k < nz; ++k)
        for (std::size_t o = 0; o < 6; ++o) {
          std::array<std::array<int, 3>, 4> corner;
          corner[0] = {f * i, f * j, f * k};
          for (int step = 0; step < 3; ++step) {
            corner[step + 1] = corner[step];
            corner[step + 1][orders[o][step]] += f;
          }
          if (!even[o]) std::swap(corner[1], corner[2]);
          std::vector<int> nodes;
          for (const auto& c : corner) nodes.push_back(id(c));
          if (f == 2)
            for (const auto& e : edges)
              nodes.push_back(id({(corner[e[0]][0] + corner[e[1]][0]) / 2, (corner[e[0]][1] + corner[e[1]][1]) / 2,
                                  (corner[e[0]][2] + corner[e[1]][2]) / 2}));
          mesh.add_cell(kind, nodes.data());
        }
  return mesh;
}

/// Box [0,a] x [0,b] x [0,c]; mid nodes of tet10 on straight edges.
inline Mesh box_mesh(int nx, int ny, int nz, Vec3 size, CellKind kind) {
  return grid_mesh(nx, ny, nz, kind,
                   [&](double x, double y, double z) { return Vec3(x * size[0], y * size[1], z * size[2]); });
}

/// Grid of nx x ny unit squares, each cut into two triangles; `place` must keep the orientation. Mid nodes of tri6 are
/// placed like corners.
inline Mesh plane_mesh(int nx, int ny, CellKind kind, const std::function<Vec3(double, double)>& place) {
  const int f = kind == CellKind::tri6 ? 2 : 1;
  const auto id = [&](int i, int j) { return i * (f * ny + 1) + j; };
  Mesh mesh;
  mesh.points.resize((f * nx + 1) * (f * ny + 1), 3);
  for (int i = 0; i <= f * nx; ++i)
    for (int j = 0; j <= f * ny; ++j)
      mesh.points.row(id(i, j)) = place(i / double(f * nx), j / double(f * ny)).transpose();
  for (int i = 0; i < f * nx; i += f)
    for (int j = 0; j < f * ny; j += f)
      for (const bool low : {true, false}) {
        // Corners of the half on or above the diagonal from (i, j) to (i + f, j + f), counter-clockwise.
        const std::array<std::array<int, 2>, 3> c{{{i, j}, {i + f, low ? j : j + f}, {low ? i + f : i, j + f}}};
        std::vector<int> nodes;
        for (const auto& [a, b] : c) nodes.push_back(id(a, b));
        if (f == 2)
          for (std::size_t k = 0; k < 3; ++k)
            nodes.push_back(id((c[k][0] + c[(k + 1) % 3][0]) / 2, (c[k][1] + c[(k + 1) % 3][1]) / 2));
        mesh.add_cell(kind, nodes.data());
      }
  return mesh;
}

/// Rectangle [0,a] x [0,b].
inline Mesh rectangle_mesh(int nx, int ny, double a, double b, CellKind kind) {
  return plane_mesh(nx, ny, kind, [=](double x, double y) { return Vec3(a * x, b * y, 0); });
}

/// n elements on [0, length] of the x axis.
inline Mesh segment_mesh(int n, double length, CellKind kind) {
  const int f = kind == CellKind::line3 ? 2 : 1;
  Mesh mesh;
  mesh.points = Points::Zero(f * n + 1, 3);
  for (int i = 0; i <= f * n; ++i) mesh.points(i, 0) = length * i / (f * n);
  for (int i = 0; i < f * n; i += f) {
    const int nodes[3] = {i, i + f, i + 1};
    mesh.add_cell(kind, nodes);
  }
  return mesh;
}

/// The unit segment, square or cube, divided n times along each axis.
inline Mesh unit_mesh(int n, CellKind kind) {
  if (dimension(kind) == 1) return segment_mesh(n, 1, kind);
  if (dimension(kind) == 2) return rectangle_mesh(n, n, 1, 1, kind);
  return box_mesh(n, n, n, {1, 1, 1}, kind);
}

inline constexpr std::array<CellKind, 6> every_kind{CellKind::line2, CellKind::line3, CellKind::tri3,
                                                    CellKind::tri6,  CellKind::tet4,  CellKind::tet10};

/// The corners of the edge that carries mid node `corner_count(kind) + k`.
inline std::array<int, 2> edge_of(int k) {
  constexpr std::array<std::array<int, 2>, 6> edges{{{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}}};
  return edges[static_cast<std::size_t>(k)];
}

/// Joins points closer than 1e-9 (coordinates of order one).
inline Mesh merge(const std::vector<Mesh>& parts) {
  Mesh joined;
  std::map<std::array<long, 3>, int> known;
  std::vector<Vec3> points;
  for (const Mesh& part : parts)
    for (int c = 0; c < part.cell_count(); ++c) {
      std::vector<int> nodes;
      for (int a = 0; a < node_count(part.kinds[static_cast<std::size_t>(c)]); ++a) {
        const Vec3 x = part.points.row(part.cell(c)[a]).transpose();
        const std::array<long, 3> key{std::lround(x[0] * 1e8), std::lround(x[1] * 1e8), std::lround(x[2] * 1e8)};
        const auto [it, fresh] = known.emplace(key, static_cast<int>(points.size()));
        if (fresh) points.push_back(x);
        nodes.push_back(it->second);
      }
      joined.add_cell(part.kinds[static_cast<std::size_t>(c)], nodes.data());
    }
  joined.points.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t n = 0; n < points.size(); ++n)
    joined.points.row(static_cast<Eigen::Index>(n)) = points[n].transpose();
  return joined;
}

/// The part x, y, z >= 0 of the shell a <= r <= b: three blocks of n x n x n cubes, one for each face of the cube that
/// looks outwards. All nodes lie on true spheres: tet10 is curved.
inline Mesh sphere_octant(int n, double a, double b, CellKind kind) {
  const auto spread = [](double p) { return std::tan(M_PI / 4 * p); };
  const auto shell = [=](const Vec3& direction, double s) -> Vec3 {
    return (a + s * (b - a)) * direction.normalized();
  };
  return merge({grid_mesh(n, n, n, kind,
                          [=](double p, double q, double s) {
                            return shell({1, spread(p), spread(q)}, s);
                          }),
                grid_mesh(n, n, n, kind,
                          [=](double p, double q, double s) {
                            return shell({spread(q), 1, spread(p)}, s);
                          }),
                grid_mesh(n, n, n, kind, [=](double p, double q, double s) {
                  return shell({spread(p), spread(q), 1}, s);
                })});
}

/// Ids of the points that pass a test.
inline std::vector<int> points_where(const Mesh& mesh, const std::function<bool(const Vec3&)>& test) {
  std::vector<int> found;
  for (int n = 0; n < mesh.point_count(); ++n)
    if (test(mesh.points.row(n).transpose())) found.push_back(n);
  return found;
}

inline int nearest_point(const Mesh& mesh, const Vec3& x) {
  Eigen::Index row;
  (mesh.points.rowwise() - x.transpose()).rowwise().squaredNorm().minCoeff(&row);
  return static_cast<int>(row);
}

/// Faces that belong to one element only and whose corners all pass the test.
inline std::vector<Face> faces_where(const Mesh& mesh, const std::function<bool(const Vec3&)>& test) {
  std::map<std::vector<int>, std::vector<Face>> seen;
  for (int e = 0; e < mesh.cell_count(); ++e)
    for (int local = 0; local < side_count(mesh.kinds[static_cast<std::size_t>(e)]); ++local) {
      std::vector<int> key;
      bool inside = true;
      for (const int a : side_nodes(mesh.kinds[static_cast<std::size_t>(e)], local)) {
        key.push_back(mesh.cell(e)[a]);
        inside = inside && test(mesh.points.row(key.back()).transpose());
      }
      if (!inside) continue;
      std::sort(key.begin(), key.end());
      seen[key].push_back({e, local});
    }
  std::vector<Face> faces;
  for (const auto& [key, list] : seen)
    if (list.size() == 1) faces.push_back(list.front());
  return faces;
}

inline Prescribed fix(std::vector<int> nodes, bool x = true, bool y = true, bool z = true) {
  Prescribed p{.name = "fixed", .nodes = std::move(nodes), .values = {Vec3::Zero()}, .ramp = Ramp::step};
  p.components[0] = x, p.components[1] = y, p.components[2] = z;
  return p;
}

/// One region with all cells, one step without loads.
inline Model make_model(Mesh mesh, const LinearElastic& material, double density = 1) {
  Model model;
  Region region{.name = "body", .law = make_linear_elastic(material), .density = density};
  for (int e = 0; e < mesh.cell_count(); ++e) region.elements.push_back(e);
  model.mesh = std::make_shared<const Mesh>(std::move(mesh));
  model.regions.push_back(std::move(region));
  model.steps.push_back({.name = "load", .dt = 1, .count = 1, .gravity = Vec3::Zero()});
  model.settings.integrator = Integrator::static_;
  return model;
}

/// The cantilever of the comparison with other programs: 0.1 x 0.02 x 0.02 m, 5n x n x n cubes, clamped at x = 0.
inline Model beam_model(int n, CellKind kind, double poisson_ratio, Strain strain) {
  Model model = make_model(box_mesh(5 * n, n, n, {0.1, 0.02, 0.02}, kind),
                           {.youngs_modulus = 1e5, .poisson_ratio = poisson_ratio, .strain = strain}, 1000);
  model.steps[0].gravity = Vec3(0, 0, -9.81);
  model.steps[0].prescribed = {fix(points_where(*model.mesh, [](const Vec3& x) { return x[0] < 1e-9; }))};
  return model;
}

inline Vec3 tip(const Model& model, const State& state) {
  return state.displacement.row(nearest_point(*model.mesh, {0.1, 0.01, 0.01})).transpose();
}

}  // namespace msml::fe::testing
