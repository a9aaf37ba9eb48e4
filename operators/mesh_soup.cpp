// SPDX-License-Identifier: GPL-3.0-or-later
// Connectivity of triangle soups by sorted edges.
#include "operators/mesh_soup.hpp"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <numeric>
#include <set>

#include "msml/core/error.hpp"

namespace msml::operators {
namespace {

using Triangle = std::array<int, 3>;

/// A triangle's edge; `first` < `second`, `same` tells whether the triangle runs from first to second.
struct Side {
  int first, second, triangle;
  bool same;
};

/// All sides, sorted so that those of one edge stand together in the order of their triangles.
std::vector<Side> sorted_sides(const std::vector<Triangle>& triangles) {
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = triangles[t][i], b = triangles[t][(i + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), static_cast<int>(t), a < b});
    }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    return std::tie(a.first, a.second, a.triangle) < std::tie(b.first, b.second, b.triangle);
  });
  return sides;
}

/// Calls visit(begin, end) for the sides of each edge.
template <class Visit>
void for_edges(const std::vector<Side>& sides, Visit visit) {
  for (std::size_t i = 0, j = 0; i < sides.size(); i = j) {
    while (j < sides.size() && sides[j].first == sides[i].first && sides[j].second == sides[i].second) ++j;
    visit(i, j);
  }
}

struct Neighbour {
  int triangle;
  bool agrees;  ///< the two run through their edge in opposite directions
};

/// Triangles across edges that have exactly two.
std::vector<std::vector<Neighbour>> neighbours(const std::vector<Triangle>& triangles) {
  std::vector<std::vector<Neighbour>> across(triangles.size());
  const std::vector<Side> sides = sorted_sides(triangles);
  for_edges(sides, [&](std::size_t i, std::size_t j) {
    if (j - i != 2) return;
    const bool agrees = sides[i].same != sides[i + 1].same;
    across[static_cast<std::size_t>(sides[i].triangle)].push_back({sides[i + 1].triangle, agrees});
    across[static_cast<std::size_t>(sides[i + 1].triangle)].push_back({sides[i].triangle, agrees});
  });
  return across;
}

/// Turns triangles so that neighbours agree; returns how many.
long orient(std::vector<Triangle>& triangles) {
  const auto across = neighbours(triangles);
  std::vector<int> turn(triangles.size(), -1);
  long turned = 0;
  for (std::size_t start = 0; start < triangles.size(); ++start) {
    if (turn[start] >= 0) continue;
    std::vector<std::size_t> part{start};
    turn[start] = 0;
    for (std::size_t n = 0; n < part.size(); ++n)
      for (const auto& [other, agrees] : across[part[n]]) {
        const int wanted = agrees ? turn[part[n]] : 1 - turn[part[n]];
        int& known = turn[static_cast<std::size_t>(other)];
        if (known >= 0 && known != wanted) throw Error("the surface has one side only (like a Moebius strip)");
        if (known < 0) known = wanted, part.push_back(static_cast<std::size_t>(other));
      }
    const auto ones = std::count_if(part.begin(), part.end(), [&](std::size_t t) { return turn[t] == 1; });
    const int minority = 2 * static_cast<std::size_t>(ones) > part.size() ? 0 : 1;
    for (const std::size_t t : part)
      if (turn[t] == minority) std::swap(triangles[t][1], triangles[t][2]), ++turned;
  }
  return turned;
}

/// Gives points with equal coordinates one id and leaves out unused ones; returns the new triangles.
std::vector<Triangle> merge_points(const Surface& surface, Points& points, SoupRepairs& done) {
  const auto count = static_cast<std::size_t>(surface.point_count());
  std::vector<int> order(count), same(count);
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](int i) {
    return std::make_tuple(surface.points(i, 0), surface.points(i, 1), surface.points(i, 2));
  };
  std::sort(order.begin(), order.end(), [&](int a, int b) { return key(a) != key(b) ? key(a) < key(b) : a < b; });
  for (std::size_t n = 0; n < count; ++n) {
    const bool repeated = n > 0 && key(order[n]) == key(order[n - 1]);
    same[static_cast<std::size_t>(order[n])] = repeated ? same[static_cast<std::size_t>(order[n - 1])] : order[n];
    done.merged_points += repeated;
  }
  std::vector<int> fresh(count, -1), kept;
  std::vector<Triangle> triangles;
  std::set<Triangle> known;
  for (const Triangle& old : surface.triangles) {
    Triangle t{same[static_cast<std::size_t>(old[0])], same[static_cast<std::size_t>(old[1])],
               same[static_cast<std::size_t>(old[2])]};
    Triangle sorted = t;
    std::sort(sorted.begin(), sorted.end());
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0] || !known.insert(sorted).second) {
      ++done.dropped_triangles;
      continue;
    }
    for (int& id : t) {
      int& name = fresh[static_cast<std::size_t>(id)];
      if (name < 0) name = static_cast<int>(kept.size()), kept.push_back(id);
      id = name;
    }
    triangles.push_back(t);
  }
  done.unused_points = static_cast<long>(count) - done.merged_points - static_cast<long>(kept.size());
  points.resize(static_cast<Eigen::Index>(kept.size()), 3);
  for (std::size_t n = 0; n < kept.size(); ++n) points.row(static_cast<Eigen::Index>(n)) = surface.points.row(kept[n]);
  return triangles;
}

std::string counted(long count, const char* one, const char* many) {
  return fmt::format("{} {}", with_commas(count), count == 1 ? one : many);
}

}  // namespace

std::string SoupFaults::str() const {
  std::string text;
  const auto add = [&](long count, const char* one, const char* many) {
    if (count > 0) text += (text.empty() ? "" : ", ") + counted(count, one, many);
  };
  add(border_edges, "border edge", "border edges");
  add(nonmanifold_edges, "non-manifold edge", "non-manifold edges");
  add(nonmanifold_vertices, "non-manifold vertex", "non-manifold vertices");
  return text;
}

Surface repair(const Surface& surface, SoupRepairs& done) {
  Surface out;
  out.triangles = merge_points(surface, out.points, done);
  done.turned_triangles = orient(out.triangles);
  return out;
}

void note_repairs(Reporter& reporter, const SoupRepairs& done) {
  const auto note = [&](long count, const char* one, const char* many) {
    if (count > 0) reporter.note("surface: " + counted(count, one, many));
  };
  note(done.merged_points, "point with the coordinates of another was merged",
       "points with the coordinates of others were merged");
  note(done.dropped_triangles, "repeated or degenerate triangle was dropped",
       "repeated or degenerate triangles were dropped");
  note(done.unused_points, "point without triangles was dropped", "points without triangles were dropped");
  note(done.turned_triangles, "triangle was turned to agree with its neighbours",
       "triangles were turned to agree with their neighbours");
}

SoupFaults faults(const Surface& surface) {
  SoupFaults found;
  const std::vector<Side> sides = sorted_sides(surface.triangles);
  // Around each vertex: its triangles, and which of them share an edge at the vertex; one fan is one connected set.
  std::vector<long> corners(static_cast<std::size_t>(surface.point_count()), 0);
  std::vector<std::map<int, int>> parent(corners.size());
  const auto root = [&](int vertex, int triangle) {
    auto& tree = parent[static_cast<std::size_t>(vertex)];
    while (tree.at(triangle) != triangle) triangle = tree.at(triangle);
    return triangle;
  };
  for (std::size_t t = 0; t < surface.triangles.size(); ++t)
    for (const int v : surface.triangles[t]) {
      parent[static_cast<std::size_t>(v)][static_cast<int>(t)] = static_cast<int>(t);
      ++corners[static_cast<std::size_t>(v)];
    }
  for_edges(sides, [&](std::size_t i, std::size_t j) {
    found.border_edges += j - i == 1;
    found.nonmanifold_edges += j - i > 2;
    for (std::size_t n = i + 1; n < j; ++n)
      for (const int v : {sides[i].first, sides[i].second}) {
        const int a = root(v, sides[i].triangle), b = root(v, sides[n].triangle);
        if (a != b) parent[static_cast<std::size_t>(v)][b] = a, --corners[static_cast<std::size_t>(v)];
      }
  });
  found.nonmanifold_vertices = std::count_if(corners.begin(), corners.end(), [](long fans) { return fans > 1; });
  return found;
}

std::vector<int> parts_of(const Surface& surface) {
  const auto across = neighbours(surface.triangles);
  std::vector<int> part(surface.triangles.size(), -1);
  int parts = 0;
  for (std::size_t start = 0; start < part.size(); ++start) {
    if (part[start] >= 0) continue;
    std::vector<std::size_t> members{start};
    part[start] = parts;
    for (std::size_t n = 0; n < members.size(); ++n)
      for (const auto& [other, agrees] : across[members[n]])
        if (part[static_cast<std::size_t>(other)] < 0)
          part[static_cast<std::size_t>(other)] = parts, members.push_back(static_cast<std::size_t>(other));
    ++parts;
  }
  return part;
}

double enclosed_volume(const Surface& surface) {
  double six = 0;
  for (const auto& [a, b, c] : surface.triangles)
    six += surface.points.row(a).dot(surface.points.row(b).cross(surface.points.row(c)));
  return six / 6;
}

}  // namespace msml::operators
