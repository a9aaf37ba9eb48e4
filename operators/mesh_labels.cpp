// SPDX-License-Identifier: GPL-3.0-or-later
// Merging of small labels, connected parts, and the seeds that find them.
#include "operators/mesh_labels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <set>

#include "msml/core/error.hpp"

namespace msml::operators {
namespace {

using Size = std::array<int, 3>;

/// Part of an image.
struct Box {
  Size first, size;
};

/// The six neighbours of a voxel; outside the grid none.
template <class Visit>
void for_neighbours(const Size& size, std::size_t voxel, Visit visit) {
  const auto nx = static_cast<std::size_t>(size[0]), ny = static_cast<std::size_t>(size[1]);
  const std::array<std::size_t, 3> at{voxel % nx, voxel / nx % ny, voxel / (nx * ny)}, stride{1, nx, nx * ny};
  for (std::size_t d = 0; d < 3; ++d) {
    visit(at[d] > 0, voxel - stride[d]);
    visit(at[d] + 1 < static_cast<std::size_t>(size[d]), voxel + stride[d]);
  }
}

int whole_number(const Image& image, std::size_t voxel) {
  const double value = image.at(voxel);
  if (value != std::floor(value) || std::abs(value) > std::numeric_limits<int>::max())
    throw Error(fmt::format("voxel {} of the image holds {}; a label image holds whole numbers", voxel, value));
  return static_cast<int>(value);
}

/// Calls body(i, j, k, voxel) for every voxel of an image, or of a box in it.
template <class Body>
void for_voxels(const Image& image, const Box& box, const Body& body) {
  for (int k = box.first[2]; k < box.first[2] + box.size[2]; ++k)
    for (int j = box.first[1]; j < box.first[1] + box.size[1]; ++j)
      for (int i = box.first[0]; i < box.first[0] + box.size[0]; ++i)
        body(i, j, k, (static_cast<std::size_t>(k) * image.size[1] + j) * image.size[0] + i);
}

/// The smallest box around all voxels that are not 0.
Box filled_box(const Image& image) {
  if (image.components != 1)
    throw Error(fmt::format("the image has {} components a voxel; a label image has one", image.components));
  Size low = image.size, high{-1, -1, -1};
  for_voxels(image, {{0, 0, 0}, image.size}, [&](int i, int j, int k, std::size_t voxel) {
    if (whole_number(image, voxel) == 0) return;
    const Size at{i, j, k};
    for (std::size_t d = 0; d < 3; ++d) low[d] = std::min(low[d], at[d]), high[d] = std::max(high[d], at[d]);
  });
  if (high[0] < 0) throw Error("the image holds nothing but 0, the outside");
  return {low, {high[0] - low[0] + 1, high[1] - low[1] + 1, high[2] - low[2] + 1}};
}

std::vector<int> labels_in(const Image& image, const Box& box) {
  std::vector<int> labels;
  labels.reserve(static_cast<std::size_t>(box.size[0]) * box.size[1] * box.size[2]);
  for_voxels(image, box, [&](int, int, int, std::size_t voxel) { labels.push_back(whole_number(image, voxel)); });
  return labels;
}

/// Gives one connected patch of small labels the most frequent value around it, the smallest where counts are equal.
int merge_patch(const Size& size, const std::set<int>& small, std::vector<int>& labels, std::size_t start,
                std::vector<char>& done) {
  std::map<int, long> around;
  std::vector<std::size_t> patch{start};
  done[start] = 1;
  for (std::size_t n = 0; n < patch.size(); ++n)
    for_neighbours(size, patch[n], [&](bool inside, std::size_t other) {
      if (!inside)
        ++around[0];
      else if (!small.count(labels[other]))
        ++around[labels[other]];
      else if (!done[other])
        done[other] = 1, patch.push_back(other);
    });
  const auto most =
      std::max_element(around.begin(), around.end(), [](const auto& a, const auto& b) { return a.second < b.second; });
  const int value = most == around.end() ? 0 : most->first;
  for (const std::size_t voxel : patch) labels[voxel] = value;
  return value;
}

std::vector<Merged> merge_small(const Size& size, std::vector<int>& labels, long min_voxels) {
  std::map<int, long> counts;
  for (const int label : labels) ++counts[label];
  std::set<int> small;
  std::vector<Merged> merged;
  for (const auto& [value, count] : counts)
    if (value != 0 && count < min_voxels) small.insert(value), merged.push_back({value, count, {}});
  if (small.empty()) return merged;
  const std::vector<int> before = labels;
  std::vector<char> done(labels.size(), 0);
  for (std::size_t v = 0; v < labels.size(); ++v)
    if (small.count(before[v]) && !done[v]) merge_patch(size, small, labels, v, done);
  for (Merged& m : merged) {
    std::set<int> into;
    for (std::size_t v = 0; v < labels.size(); ++v)
      if (before[v] == m.value) into.insert(labels[v]);
    m.into.assign(into.begin(), into.end());
  }
  return merged;
}

/// Compresses the labels to 0, 1, 2, … in ascending order of value and puts one voxel of outside around the box.
void compress(const Image& image, const Box& box, const std::vector<int>& labels, LabelParts& out) {
  std::set<int> distinct(labels.begin(), labels.end());
  distinct.erase(0);
  constexpr std::size_t most = 254;
  if (distinct.size() > most)
    throw Error(fmt::format("the image has {} labels; at most {} can be meshed", distinct.size(), most));
  out.values = {0};
  out.values.insert(out.values.end(), distinct.begin(), distinct.end());
  std::map<int, std::uint8_t> code{{0, 0}};
  for (std::size_t i = 1; i < out.values.size(); ++i) code[out.values[i]] = static_cast<std::uint8_t>(i);
  out.grid.whole = {image.size[0] + 2, image.size[1] + 2, image.size[2] + 2};
  out.grid.first = box.first;  // one voxel of outside before the box, as before the image
  out.grid.size = {box.size[0] + 2, box.size[1] + 2, box.size[2] + 2};
  out.grid.spacing = image.spacing;
  out.grid.labels.assign(out.grid.index(0, 0, out.grid.size[2]), 0);
  long filled = 0;
  std::size_t v = 0;
  for (int k = 1; k <= box.size[2]; ++k)
    for (int j = 1; j <= box.size[1]; ++j)
      for (int i = 1; i <= box.size[0]; ++i, ++v)
        if (labels[v] != 0) out.grid.labels[out.grid.index(i, j, k)] = code[labels[v]], ++filled;
  out.volume = static_cast<double>(filled) * image.spacing.prod();
}

/// Distance of every labelled voxel from the boundary of its label, in steps from voxel to voxel.
std::vector<int> depths(const LabelGrid& grid) {
  std::vector<int> depth(grid.labels.size(), -1);
  std::vector<std::size_t> front;
  for (std::size_t v = 0; v < grid.labels.size(); ++v) {
    if (grid.labels[v] == 0) continue;
    for_neighbours(grid.size, v, [&](bool inside, std::size_t other) {
      if (depth[v] < 0 && (!inside || grid.labels[other] != grid.labels[v])) depth[v] = 0, front.push_back(v);
    });
  }
  for (std::size_t n = 0; n < front.size(); ++n)
    for_neighbours(grid.size, front[n], [&](bool inside, std::size_t other) {
      if (inside && depth[other] < 0 && grid.labels[other] == grid.labels[front[n]])
        depth[other] = depth[front[n]] + 1, front.push_back(other);
    });
  return depth;
}

void find_parts(LabelParts& out) {
  const LabelGrid& grid = out.grid;
  const std::vector<int> depth = depths(grid);
  out.part_of.assign(grid.labels.size(), -1);
  std::vector<std::size_t> members;
  for (std::size_t start = 0; start < grid.labels.size(); ++start) {
    if (grid.labels[start] == 0 || out.part_of[start] >= 0) continue;
    const int id = static_cast<int>(out.parts.size());
    Part part{.label = grid.labels[start], .voxels = 0, .deepest = start, .depth = -1};
    members.assign(1, start);
    out.part_of[start] = id;
    for (std::size_t n = 0; n < members.size(); ++n) {
      if (depth[members[n]] > part.depth) part.depth = depth[members[n]], part.deepest = members[n];
      for_neighbours(grid.size, members[n], [&](bool inside, std::size_t other) {
        if (inside && out.part_of[other] < 0 && grid.labels[other] == part.label)
          out.part_of[other] = id, members.push_back(other);
      });
    }
    part.voxels = static_cast<long>(members.size());
    out.parts.push_back(part);
  }
}

Vec3 centre(const LabelGrid& grid, std::size_t voxel) {
  const auto nx = static_cast<std::size_t>(grid.size[0]), ny = static_cast<std::size_t>(grid.size[1]);
  const std::size_t i = voxel % nx, j = voxel / nx % ny, k = voxel / (nx * ny);
  return grid.spacing.cwiseProduct(Vec3(static_cast<double>(i) + grid.first[0], static_cast<double>(j) + grid.first[1],
                                        static_cast<double>(k) + grid.first[2]));
}

/// The segment, half a voxel long, on which the ray from a voxel's centre leaves the label.
Seed way_out(const LabelGrid& grid, const Vec3& from, const Vec3& direction, double clear) {
  const double step = 0.5 * grid.spacing.minCoeff();
  const int label = grid.at(from);
  Vec3 inside = from, outside = from + step * direction;
  while (grid.at(outside) == label) inside = outside, outside += step * direction;  // ends: the rim is outside
  return {inside, outside, clear};
}

/// The corners of a dodecahedron: 20 directions spread evenly.
std::vector<Vec3> twenty_directions() {
  const double g = (1 + std::sqrt(5.0)) / 2;
  std::vector<Vec3> directions;
  for (const double a : {-1.0, 1.0})
    for (const double b : {-1.0, 1.0}) {
      for (const double c : {-1.0, 1.0}) directions.emplace_back(a, b, c);
      directions.emplace_back(0, a / g, b * g);
      directions.emplace_back(a / g, b * g, 0);
      directions.emplace_back(a * g, 0, b / g);
    }
  for (Vec3& direction : directions) direction.normalize();
  return directions;
}

}  // namespace

LabelParts label_parts(const Image& image, long min_voxels) {
  LabelParts out;
  const Box box = filled_box(image);
  std::vector<int> labels = labels_in(image, box);
  out.merged = merge_small(box.size, labels, min_voxels);
  compress(image, box, labels, out);
  std::vector<int>().swap(labels);
  if (out.values.size() == 1)
    throw Error(fmt::format("no label of the image has minVoxels = {} voxels or more", min_voxels));
  find_parts(out);
  return out;
}

std::vector<Seed> seeds_of(const LabelParts& parts, const Part& part, double facet_size) {
  const double radius = (part.depth + 0.5) * parts.grid.spacing.minCoeff();
  std::vector<Seed> seeds;
  for (const Vec3& direction : twenty_directions())
    seeds.push_back(
        way_out(parts.grid, centre(parts.grid, part.deepest), direction, 0.3 * std::min(radius, facet_size)));
  return seeds;
}

std::vector<Seed> dense_seeds_of(const LabelParts& parts, int id) {
  constexpr long most = 200;
  const Part& part = parts.parts[static_cast<std::size_t>(id)];
  const long every = std::max(1L, part.voxels / most);
  std::vector<Seed> seeds;
  long seen = 0;
  for (std::size_t v = 0; v < parts.part_of.size(); ++v) {
    if (parts.part_of[v] != id || seen++ % every != 0) continue;
    for (int d = 0; d < 3; ++d)
      for (const double sign : {-1.0, 1.0})
        seeds.push_back(
            way_out(parts.grid, centre(parts.grid, v), sign * Vec3::Unit(d), 0.4 * parts.grid.spacing.minCoeff()));
  }
  return seeds;
}

std::vector<bool> parts_present(const LabelParts& parts, const Mesh& mesh) {
  std::vector<bool> present(parts.parts.size(), false);
  const LabelGrid& grid = parts.grid;
  for (int c = 0; c < mesh.cell_count(); ++c) {
    Vec3 middle = Vec3::Zero();
    for (int i = 0; i < 4; ++i) middle += mesh.points.row(mesh.cell(c)[i]).transpose() / 4;
    std::array<int, 3> at;
    for (int d = 0; d < 3; ++d)
      at[static_cast<std::size_t>(d)] = std::clamp(
          static_cast<int>(std::lround(middle[d] / grid.spacing[d])) - grid.first[static_cast<std::size_t>(d)], 0,
          grid.size[static_cast<std::size_t>(d)] - 1);
    const std::size_t voxel = grid.index(at[0], at[1], at[2]);
    if (grid.labels[voxel] == mesh.region(c)) present[static_cast<std::size_t>(parts.part_of[voxel])] = true;
  }
  return present;
}

}  // namespace msml::operators
