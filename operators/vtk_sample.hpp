// SPDX-License-Identifier: GPL-3.0-or-later
// Finds the cells of a mesh that points lie in.
#pragma once
#include <memory>
#include <vector>

#include "msml/core/mesh.hpp"

namespace msml::operators {

/// Where a point lies in a mesh.
struct Place {
  int cell = -1;                ///< id in the mesh
  double distance = 0;          ///< 0 inside, else to the nearest point of the mesh, which the weights belong to
  std::vector<double> weights;  ///< shape functions of the cell's nodes; their sum is 1
};

/// A search tree over the cells of highest dimension of a mesh, with its nodes at `points`.
class Sampler {
 public:
  /// Throws Error if the mesh has no lines, triangles or tetrahedra.
  Sampler(const Mesh& mesh, const Points& points);
  ~Sampler();
  Sampler(const Sampler&) = delete;
  Sampler& operator=(const Sampler&) = delete;
  Place find(const Vec3& point) const;

 private:
  struct Tree;
  std::unique_ptr<Tree> tree_;
};

}  // namespace msml::operators
