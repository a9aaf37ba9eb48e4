// SPDX-License-Identifier: GPL-3.0-or-later
// Tetrahedra for a grid of labels: the meshing core behind CGALMeshVolumeFromVoxels.
#pragma once
#include <array>
#include <cstdint>
#include <vector>

#include "operators/cgal_meshing.hpp"

namespace msml::operators {

/// Labels 0..255 on a grid, 0 = outside, of which a box is kept beyond which there is nothing but 0; x runs fastest.
/// Voxel (i j k) of the box has its centre at spacing .* (first + (i j k)).
struct LabelGrid {
  std::array<int, 3> size{0, 0, 0};   ///< of the box
  std::array<int, 3> first{0, 0, 0};  ///< place of the box in the whole grid
  std::array<int, 3> whole{0, 0, 0};  ///< size of the whole grid
  Vec3 spacing = Vec3::Ones();
  std::vector<std::uint8_t> labels;
  std::size_t index(int i, int j, int k) const {
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(size[0]) *
               (static_cast<std::size_t>(j) + static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(k));
  }
  /// The label at a point: of the eight voxels around it, the label with the largest sum of trilinear weights; the
  /// smaller label where two are equal. 0 outside the centres of the outermost voxels of the box.
  int at(const Vec3& point) const;
};

/// Fills every label but 0 with tetrahedra (CGAL Mesh_3, Labeled_mesh_domain_3), starting from the seeds. Sequential;
/// the same input gives the same mesh. Regions are the labels. May return a mesh without cells.
Mesh fill_labels(const LabelGrid& grid, const std::vector<Seed>& seeds, const MeshingSettings& settings,
                 const Watcher& watcher, const Announcer& announce);

}  // namespace msml::operators
