// SPDX-License-Identifier: GPL-3.0-or-later
// From an image of labels to a grid that a mesher can fill: whole numbers, small labels merged, separate parts found.
#pragma once
#include <string>
#include <vector>

#include "msml/core/image.hpp"
#include "operators/cgal_fill_labels.hpp"

namespace msml::operators {

/// One connected part (voxels that share faces) of one label.
struct Part {
  int label = 0;  ///< in the compressed grid
  long voxels = 0;
  std::size_t deepest = 0;  ///< voxel farthest from the part's boundary, counted in voxels
  int depth = 0;            ///< its distance from the boundary; 0 = it lies on the boundary
};

/// A label of the image that had too few voxels.
struct Merged {
  int value = 0;
  long voxels = 0;
  std::vector<int> into;  ///< values that its voxels received, ascending
};

/// The image made ready: compressed labels with one voxel of outside around it.
struct LabelParts {
  LabelGrid grid;
  std::vector<int> values;  ///< of each compressed label; values[0] = 0
  std::vector<Merged> merged;
  std::vector<Part> parts;
  std::vector<int> part_of;  ///< #voxels of the grid, -1 = outside
  double volume = 0;         ///< of all voxels that are not outside
};

/// Labels with fewer than `min_voxels` voxels take the most frequent value around each of their parts (the outside
/// counts as 0). Throws Error for an image with components, grey values, nothing but 0, or more than 254 labels.
LabelParts label_parts(const Image& image, long min_voxels);

/// Seeds that find a part: from its deepest voxel outwards in 20 directions.
std::vector<Seed> seeds_of(const LabelParts& parts, const Part& part, double facet_size);

/// Many more seeds for part number `id` that the mesher missed: from voxels all over it in the six axis directions.
std::vector<Seed> dense_seeds_of(const LabelParts& parts, int id);

/// For each part, whether a tetrahedron of its label lies in it. `mesh` is in the grid's coordinates.
std::vector<bool> parts_present(const LabelParts& parts, const Mesh& mesh);

}  // namespace msml::operators
