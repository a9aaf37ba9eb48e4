// SPDX-License-Identifier: GPL-3.0-or-later
// CGALMeshVolumeFromVoxels: an image of labels becomes a tetrahedral mesh with one region per label.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/LU>
#include <algorithm>
#include <map>

#include "operators/cgal_fill_labels.hpp"
#include "operators/mesh_labels.hpp"

namespace msml::operators {
namespace {

void note_merged(Reporter& reporter, const LabelParts& parts) {
  for (const Merged& m : parts.merged)
    reporter.note(
        fmt::format("label {} has only {} voxels and was merged into {}", m.value, m.voxels, fmt::join(m.into, ", ")));
}

/// Numbers of the parts that are large enough to be asked for and yet have no tetrahedron.
std::vector<int> missing_parts(const LabelParts& parts, const Mesh& mesh, long min_voxels) {
  const std::vector<bool> present = parts_present(parts, mesh);
  std::vector<int> missing;
  for (std::size_t p = 0; p < present.size(); ++p)
    if (!present[p] && parts.parts[p].voxels >= min_voxels) missing.push_back(static_cast<int>(p));
  return missing;
}

/// Meshes; where parts are missed, seeds them densely and meshes anew, at most twice.
Mesh fill_every_part(const LabelParts& parts, long min_voxels, const MeshingSettings& settings, Reporter& reporter) {
  const Watcher watcher = progress_in_points(reporter, parts.volume, settings);
  const Announcer announce = announce_passes(reporter);
  std::vector<Seed> seeds;
  const auto append = [&](const std::vector<Seed>& more) { seeds.insert(seeds.end(), more.begin(), more.end()); };
  for (const Part& part : parts.parts)
    if (part.voxels >= min_voxels) append(seeds_of(parts, part, settings.facet_size));
  Mesh mesh = fill_labels(parts.grid, seeds, settings, watcher, announce);
  for (int attempt = 0; attempt < 2; ++attempt) {
    const std::vector<int> missing = missing_parts(parts, mesh, min_voxels);
    if (missing.empty()) break;
    for (const int part : missing) append(dense_seeds_of(parts, part));
    mesh = fill_labels(parts.grid, seeds, settings, watcher, announce);
    reporter.note(fmt::format("{} separate parts of labels had no tetrahedron; after seeding them anew {} have none",
                              missing.size(), missing_parts(parts, mesh, min_voxels).size()));
  }
  return mesh;
}

void warn_of_losses(Reporter& reporter, const LabelParts& parts, const Mesh& mesh, long min_voxels) {
  std::map<int, long> tets;
  for (const int region : mesh.regions) ++tets[region];
  for (std::size_t label = 1; label < parts.values.size(); ++label)
    if (!tets.count(static_cast<int>(label)))
      reporter.warn(
          fmt::format("label {} is lost: no tetrahedron carries it; a smaller facetDistance, facetSize or "
                      "cellSize keeps it",
                      parts.values[label]));
  const std::size_t lost = missing_parts(parts, mesh, min_voxels).size();
  if (lost > 0)
    reporter.warn(fmt::format(
        "{} of {} separate parts of labels are lost: no tetrahedron lies in them", lost,
        std::count_if(parts.parts.begin(), parts.parts.end(), [&](const Part& p) { return p.voxels >= min_voxels; })));
}

/// From the padded grid's own axes to the place of the image; regions from codes to label values.
void place(Mesh& mesh, const Image& image, const LabelParts& parts) {
  for (Eigen::Index i = 0; i < mesh.points.rows(); ++i)
    mesh.points.row(i) =
        (image.origin + image.direction * (mesh.points.row(i).transpose() - image.spacing)).transpose();
  for (int& region : mesh.regions) region = parts.values[static_cast<std::size_t>(region)];
  if (image.direction.determinant() < 0)
    for (int c = 0; c < mesh.cell_count(); ++c)
      std::swap(mesh.nodes[static_cast<std::size_t>(4 * c)], mesh.nodes[static_cast<std::size_t>(4 * c + 1)]);
}

}  // namespace

Operator mesh_volume_from_voxels() {
  Operator op("CGALMeshVolumeFromVoxels", "Fill the labels of an image with linear tetrahedra, one region per label.");
  op.source("CGAL 5.5 Mesh_3, 3D Mesh Generation; labels between voxels by trilinear weights");
  const auto image = op.input<Image>("image", "labels as whole numbers; 0 is outside; at most 254 labels");
  const MeshingKeys keys = describe_meshing(op);
  const auto min_voxels = op.parameter<Integer>(
      "minVoxels",
      {.range = {.low = 1},
       .fallback = 50,
       .doc =
           "labels with fewer voxels are merged into what surrounds them; smaller islands of a label may be left out"});
  const auto mesh = op.output<Mesh>("mesh", "tet4, positive volumes; regions are the labels");
  op.target("meshFilename", mesh, "file to write the mesh to");
  op.note(
      "Origin, spacing and direction of the image place the mesh (MSML: the origin alone). Bodies that touch the "
      "rim of the image are closed half a voxel outside the outermost voxel centres. Labels are in the cell array "
      "region (MSML: Materials). Label parts that refinement misses are seeded anew, and what stays lost is warned "
      "of.");
  op.run([=](Context& c) {
    const Image& labels = c.get(image);
    const long least = static_cast<long>(c.get(min_voxels));
    const LabelParts parts = label_parts(labels, least);
    note_merged(c.reporter(), parts);
    const Vec3 extent = labels.spacing.cwiseProduct(Vec3(labels.size[0], labels.size[1], labels.size[2]));
    const MeshingSettings settings = meshing_settings(c, keys, extent.norm());
    Mesh filled = fill_every_part(parts, least, settings, c.reporter());
    if (filled.cell_count() == 0)
      throw Error(
          fmt::format("no tetrahedra: the labels are too thin for facetSize = {}, facetDistance = {}, cellSize = {}",
                      settings.facet_size, settings.facet_distance, settings.cell_size));
    warn_of_losses(c.reporter(), parts, filled, least);
    place(filled, labels, parts);
    c.set(mesh, std::move(filled));
  });
  return op;
}

}  // namespace msml::operators
