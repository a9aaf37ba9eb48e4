// SPDX-License-Identifier: GPL-3.0-or-later
// Grids of hexahedra, mapped and cut into tetrahedra.
#include "operators/mesh_generators.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <map>
#include <numbers>
#include <vector>

#include "operators/mesh_quadratic.hpp"
#include "operators/mesh_tets.hpp"

namespace msml::operators {
namespace {

/// Name of a grid point: cells that give a point the same name share it.
using Name = std::array<int, 4>;
using Naming = std::function<Name(int i, int j, int k)>;
using Place = std::function<Vec3(const Name&)>;

/// Collects blocks of hexahedra whose points are known by name.
class Grid {
 public:
  explicit Grid(Place place) : place_(std::move(place)) {}

  /// nx x ny x nz cells between the lattice points that `naming` names.
  void add(int nx, int ny, int nz, const Naming& naming) {
    for (int k = 0; k < nz; ++k)
      for (int j = 0; j < ny; ++j)
        for (int i = 0; i < nx; ++i) {
          std::array<int, 8> hexahedron;
          for (std::size_t c = 0; c < 8; ++c) {
            const bool x = c == 1 || c == 2 || c == 5 || c == 6, y = c == 2 || c == 3 || c == 6 || c == 7, z = c >= 4;
            hexahedron[c] = id(naming(i + x, j + y, k + z));
          }
          cells_.push_back(hexahedron);
        }
  }

  /// Numbers the points in the order of the lattice, so that every cell is cut around the same diagonal.
  void number(int nx, int ny, int nz, const Naming& naming) {
    for (int k = 0; k <= nz; ++k)
      for (int j = 0; j <= ny; ++j)
        for (int i = 0; i <= nx; ++i) id(naming(i, j, k));
  }

  Mesh tetrahedra() const {
    Mesh mesh;
    mesh.points = Eigen::Map<const Points>(coordinates_.data(), static_cast<Eigen::Index>(ids_.size()), 3);
    for (const auto& cell : cells_) cut(cell, mesh);
    return mesh;
  }

 private:
  int id(const Name& name) {
    const auto [entry, fresh] = ids_.try_emplace(name, static_cast<int>(ids_.size()));
    if (fresh) {
      const Vec3 p = place_(name);
      coordinates_.insert(coordinates_.end(), {p.x(), p.y(), p.z()});
    }
    return entry->second;
  }

  /// Joins the corner of smallest id with the three faces that do not have it, each cut through its smallest id.
  static void cut(const std::array<int, 8>& cell, Mesh& mesh) {
    constexpr std::array<std::array<std::size_t, 4>, 6> faces{
        {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};
    const int apex = *std::min_element(cell.begin(), cell.end());
    for (const auto& face : faces) {
      std::array<int, 4> f{cell[face[0]], cell[face[1]], cell[face[2]], cell[face[3]]};
      if (std::find(f.begin(), f.end(), apex) != f.end()) continue;
      std::rotate(f.begin(), std::min_element(f.begin(), f.end()), f.end());
      add_tet(mesh, {f[0], f[1], f[2], apex});
      add_tet(mesh, {f[0], f[2], f[3], apex});
    }
  }

  /// Blocks may be left-handed; the sign of the volume puts each tetrahedron right.
  static void add_tet(Mesh& mesh, std::array<int, 4> ids) {
    Eigen::Matrix<double, 4, 3> corners;
    for (int i = 0; i < 4; ++i) corners.row(i) = mesh.points.row(ids[static_cast<std::size_t>(i)]);
    if (volume(corners) < 0) std::swap(ids[0], ids[1]);
    mesh.add_cell(CellKind::tet4, ids.data());
  }

  Place place_;
  std::map<Name, int> ids_;
  std::vector<double> coordinates_;
  std::vector<std::array<int, 8>> cells_;
};

/// -1..1 for -n..n, so that equal steps are equal angles seen from the centre; exact at -n, 0 and n.
double tangent(int i, int n) {
  if (std::abs(i) == n) return i < 0 ? -1 : 1;
  return std::tan(std::numbers::pi / 4 * i / n);
}

double blend(double from, double to, int step, int steps) {
  return step == steps ? to : from + (to - from) * step / steps;
}

/// Half the edge of the square or cube in the middle of a full body, relative to the radius.
constexpr double core = 0.45;

/// Place of the point (a b) on a square of half edge n, carried outwards to layer l of a disc or ring.
Eigen::Vector2d on_ring(const Cylinder& c, int a, int b, int l) {
  const Eigen::Vector2d square(tangent(a, c.around), tangent(b, c.around));
  if (c.inner > 0) return square.normalized() * blend(c.inner, c.radius, l, c.across);
  if (l <= 0) return core * c.radius * square;
  const double t = static_cast<double>(l) / c.across;
  return l == c.across ? Eigen::Vector2d(square.normalized() * c.radius)
                       : Eigen::Vector2d(c.radius * ((1 - t) * core * square + t * square.normalized()));
}

Vec3 on_shell(const Sphere& s, int a, int b, int c, int l) {
  const Vec3 cube(tangent(a, s.around), tangent(b, s.around), tangent(c, s.around));
  if (s.inner > 0) return cube.normalized() * blend(s.inner, s.radius, l, s.across);
  if (l <= 0) return core * s.radius * cube;
  const double t = static_cast<double>(l) / s.across;
  return l == s.across ? Vec3(cube.normalized() * s.radius)
                       : Vec3(s.radius * ((1 - t) * core * cube + t * cube.normalized()));
}

/// Bends an edge so that its middle has the mean of the radii of its ends; straight where `bends` is false.
Vec3 bent(const Vec3& a, const Vec3& b, bool bends) {
  const Vec3 middle = (a + b) / 2;
  return bends ? Vec3(middle.normalized() * (a.norm() + b.norm()) / 2) : middle;
}

bool reaches(double radius, double wanted) { return std::abs(radius - wanted) <= 1e-9 * wanted; }

}  // namespace

Mesh generate(const Box& box) {
  const auto [nx, ny, nz] = box.divisions;
  Grid grid([&](const Name& n) {
    return Vec3(blend(box.origin.x(), box.origin.x() + box.size.x(), n[0], box.divisions[0]),
                blend(box.origin.y(), box.origin.y() + box.size.y(), n[1], box.divisions[1]),
                blend(box.origin.z(), box.origin.z() + box.size.z(), n[2], box.divisions[2]));
  });
  const auto naming = [](int i, int j, int k) { return Name{i, j, k, 0}; };
  grid.number(nx, ny, nz, naming);
  grid.add(nx, ny, nz, naming);
  return grid.tetrahedra();
}

Mesh generate(const Cylinder& c) {
  const int n = c.around, low = c.quarter ? 0 : -n, cells = n - low;
  // A name is (a, b, layer, height); points inside the core have layer -1, those on its rim layer 0.
  Grid grid([&](const Name& name) {
    const Eigen::Vector2d xy = on_ring(c, name[0], name[1], name[2]);
    return Vec3(c.origin + Vec3(xy.x(), xy.y(), blend(0, c.height, name[3], c.along)));
  });
  const auto rim = [n](int a, int b) { return std::max(std::abs(a), std::abs(b)) == n ? 0 : -1; };
  if (c.inner == 0)
    grid.add(cells, cells, c.along, [&](int i, int j, int k) {
      return Name{low + i, low + j, rim(low + i, low + j), k};
    });
  for (int axis = 0; axis < 2; ++axis)
    for (const int side : {n, -n}) {
      if (c.quarter && side < 0) continue;
      grid.add(cells, c.across, c.along, [&](int i, int l, int k) {
        return axis == 0 ? Name{side, low + i, l, k} : Name{low + i, side, l, k};
      });
    }
  return grid.tetrahedra();
}

Mesh generate(const Sphere& s) {
  const int n = s.around, low = s.octant ? 0 : -n, cells = n - low;
  // A name is (a, b, c, layer); points inside the core have layer -1, those on its rim layer 0.
  Grid grid([&](const Name& name) { return Vec3(s.centre + on_shell(s, name[0], name[1], name[2], name[3])); });
  const auto rim = [n](int a, int b, int c) { return std::max({std::abs(a), std::abs(b), std::abs(c)}) == n ? 0 : -1; };
  if (s.inner == 0)
    grid.add(cells, cells, cells, [&](int i, int j, int k) {
      return Name{low + i, low + j, low + k, rim(low + i, low + j, low + k)};
    });
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (const int side : {n, -n}) {
      if (s.octant && side < 0) continue;
      grid.add(cells, cells, s.across, [&, axis, side](int i, int j, int l) {
        Name name{0, 0, 0, l};
        name[axis] = side;
        name[(axis + 1) % 3] = low + i;
        name[(axis + 2) % 3] = low + j;
        return name;
      });
    }
  return grid.tetrahedra();
}

Mesh generate_quadratic(const Cylinder& c) {
  return to_quadratic(generate(c), [&](const Vec3& a, const Vec3& b) {
    const Vec3 u(a.x() - c.origin.x(), a.y() - c.origin.y(), 0), v(b.x() - c.origin.x(), b.y() - c.origin.y(), 0);
    const bool bends = c.inner > 0 || (reaches(u.norm(), c.radius) && reaches(v.norm(), c.radius));
    const Vec3 middle = bent(u, v, bends);
    return Vec3(c.origin.x() + middle.x(), c.origin.y() + middle.y(), (a.z() + b.z()) / 2);
  });
}

Mesh generate_quadratic(const Sphere& s) {
  return to_quadratic(generate(s), [&](const Vec3& a, const Vec3& b) {
    const Vec3 u = a - s.centre, v = b - s.centre;
    const bool bends = s.inner > 0 || (reaches(u.norm(), s.radius) && reaches(v.norm(), s.radius));
    return Vec3(s.centre + bent(u, v, bends));
  });
}

}  // namespace msml::operators
