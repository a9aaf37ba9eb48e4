// SPDX-License-Identifier: GPL-3.0-or-later
// Grids of a rectangle and of a segment.
#include "operators/mesh_generators.hpp"

namespace msml::operators {

Mesh generate(const Rectangle& rectangle) {
  const auto [nx, ny] = rectangle.divisions;
  const auto id = [columns = nx + 1](int i, int j) { return j * columns + i; };
  Mesh mesh;
  mesh.points.resize((nx + 1) * (ny + 1), 3);
  for (int j = 0; j <= ny; ++j)
    for (int i = 0; i <= nx; ++i) {
      // The last line is met exactly, so that boxes select it.
      const double x = i == nx ? rectangle.width : rectangle.width * i / nx;
      const double y = j == ny ? rectangle.height : rectangle.height * j / ny;
      mesh.points.row(id(i, j)) = (rectangle.origin + Vec3(x, y, 0)).transpose();
    }
  for (int j = 0; j < ny; ++j)
    for (int i = 0; i < nx; ++i) {
      const int low[] = {id(i, j), id(i + 1, j), id(i + 1, j + 1)}, high[] = {id(i, j), id(i + 1, j + 1), id(i, j + 1)};
      mesh.add_cell(CellKind::tri3, low);
      mesh.add_cell(CellKind::tri3, high);
    }
  const auto add_edge = [&](int a, int b) {
    const int nodes[] = {a, b};
    mesh.add_cell(CellKind::line2, nodes);
  };
  for (int i = 0; i < nx; ++i) add_edge(id(i, 0), id(i + 1, 0));
  for (int j = 0; j < ny; ++j) add_edge(id(nx, j), id(nx, j + 1));
  for (int i = nx; i > 0; --i) add_edge(id(i, ny), id(i - 1, ny));
  for (int j = ny; j > 0; --j) add_edge(id(0, j), id(0, j - 1));
  return mesh;
}

Mesh generate(const Segment& segment) {
  const int n = segment.divisions;
  Mesh mesh;
  mesh.points.resize(n + 1, 3);
  for (int i = 0; i <= n; ++i)
    mesh.points.row(i) = (segment.origin + Vec3(i == n ? segment.length : segment.length * i / n, 0, 0)).transpose();
  for (int i = 0; i < n; ++i) {
    const int nodes[] = {i, i + 1};
    mesh.add_cell(CellKind::line2, nodes);
  }
  for (const int end : {0, n}) mesh.add_cell(CellKind::vertex, &end);
  return mesh;
}

}  // namespace msml::operators
