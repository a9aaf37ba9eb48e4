// SPDX-License-Identifier: GPL-3.0-or-later
// Rigid motions of each connected part against the supports.
#include "solver/conditions/rigid.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <algorithm>
#include <numeric>

#include "msml/core/error.hpp"
#include "solver/elements/assembly.hpp"

namespace msml::fe {
namespace {

/// For each point the number of its connected part, in the order of their first points, or -1 where it belongs to no
/// element.
std::vector<int> connected_parts(const Model& model) {
  std::vector<int> parent(static_cast<std::size_t>(model.mesh->point_count()), -1);
  const auto root_of = [&](int n) {
    while (parent[static_cast<std::size_t>(n)] != n) {
      int& up = parent[static_cast<std::size_t>(n)];
      up = parent[static_cast<std::size_t>(up)];
      n = up;
    }
    return n;
  };
  for (const Region& region : model.regions)
    for (const int e : region.elements) {
      const int* nodes = model.mesh->cell(e);
      const int count = node_count(model.mesh->kinds[static_cast<std::size_t>(e)]);
      for (int a = 0; a < count; ++a)
        if (parent[static_cast<std::size_t>(nodes[a])] < 0) parent[static_cast<std::size_t>(nodes[a])] = nodes[a];
      for (int a = 1; a < count; ++a) {
        const int one = root_of(nodes[0]), two = root_of(nodes[a]);
        parent[static_cast<std::size_t>(std::max(one, two))] = std::min(one, two);
      }
    }
  for (const PointMass& mass : model.point_masses)
    if (parent[static_cast<std::size_t>(mass.node)] < 0) parent[static_cast<std::size_t>(mass.node)] = mass.node;
  std::vector<int> part_of(parent.size(), -1);
  for (int n = 0, parts = 0; n < static_cast<int>(parent.size()); ++n) {
    if (parent[static_cast<std::size_t>(n)] < 0) continue;
    const int first = root_of(n);  // the smallest point of its part
    part_of[static_cast<std::size_t>(n)] = first == n ? parts++ : part_of[static_cast<std::size_t>(first)];
  }
  return part_of;
}

using Gram = Eigen::Matrix<double, 6, 6>;  ///< sum of c c^T, c = what one component of one node sees of the 6 motions

struct Part {
  int points = 0;
  Vec3 centre = Vec3::Zero();
  double radius = 0;
  Gram all = Gram::Zero();     ///< of every component of every node
  Gram absent = Gram::Zero();  ///< of components that the problem does not have
  Gram held = Gram::Zero();    ///< of those and of the supports
};

/// A support along d sees translation e as d . e and rotation w as d . (w x arm) = w . (arm x d).
Gram seen(const Vec3& arm, const Vec3& d) {
  Eigen::Matrix<double, 6, 1> row;
  row << d, arm.cross(d);
  return row * row.transpose();
}

Vec3 arm_of(const Mesh& mesh, int node, const Part& part) {
  return part.radius > 0 ? Vec3((mesh.points.row(node).transpose() - part.centre) / part.radius) : Vec3::Zero();
}

long rank(const Gram& gram) {
  const Eigen::SelfAdjointEigenSolver<Gram> solver(gram, Eigen::EigenvaluesOnly);
  const double largest = std::max(solver.eigenvalues().maxCoeff(), 1.0);
  return (solver.eigenvalues().array() >= 1e-12 * largest).count();
}

std::vector<Part> measure_parts(const Mesh& mesh, const std::vector<int>& part_of, int components) {
  const int count = part_of.empty() ? 0 : *std::max_element(part_of.begin(), part_of.end()) + 1;
  std::vector<Part> parts(static_cast<std::size_t>(count));
  for (std::size_t n = 0; n < part_of.size(); ++n) {
    if (part_of[n] < 0) continue;
    Part& part = parts[static_cast<std::size_t>(part_of[n])];
    ++part.points;
    part.centre += mesh.points.row(static_cast<Eigen::Index>(n)).transpose();
  }
  for (Part& part : parts) part.centre /= part.points;
  for (std::size_t n = 0; n < part_of.size(); ++n) {
    if (part_of[n] < 0) continue;
    Part& part = parts[static_cast<std::size_t>(part_of[n])];
    part.radius =
        std::max(part.radius, (mesh.points.row(static_cast<Eigen::Index>(n)).transpose() - part.centre).norm());
  }
  for (std::size_t n = 0; n < part_of.size(); ++n) {
    if (part_of[n] < 0) continue;
    Part& part = parts[static_cast<std::size_t>(part_of[n])];
    const Vec3 arm = arm_of(mesh, static_cast<int>(n), part);
    for (int c = 0; c < 3; ++c) {
      part.all += seen(arm, Vec3::Unit(c));
      if (c >= components) part.absent += seen(arm, Vec3::Unit(c));
    }
    part.held = part.absent;
  }
  return parts;
}

/// Adds the supports of a step.
void hold(const Model& model, const Step& step, const std::vector<int>& part_of, std::vector<Part>& parts) {
  const Mesh& mesh = *model.mesh;
  for (const Prescribed& condition : step.prescribed)
    for (const int node : condition.nodes) {
      const int id = part_of[static_cast<std::size_t>(node)];
      if (id < 0) continue;
      Part& part = parts[static_cast<std::size_t>(id)];
      for (int c = 0; c < components(model); ++c)
        if (condition.components[c]) part.held += seen(arm_of(mesh, node, part), Vec3::Unit(c));
    }
  for (const Slide& slide : step.slides)
    for (const int node : slide.nodes)
      if (const int id = part_of[static_cast<std::size_t>(node)]; id >= 0) {
        Part& part = parts[static_cast<std::size_t>(id)];
        part.held += seen(arm_of(mesh, node, part), slide.normal.normalized());
      }
}

using Motion6 = Eigen::Matrix<double, 6, 1>;  ///< translation, and rotation times the radius of the part

/// What loads do along the free motions of a part: the force, and the moment about its centre over its radius. Zero
/// where they balance.
Motion6 push_on(const Mesh& mesh, const Numbering& numbering, const std::vector<int>& part_of, int id, const Part& part,
                const Vector& loads, Gram& free) {
  Motion6 work = Motion6::Zero();
  for (int n = 0; n < numbering.body_nodes(); ++n) {
    const int point = numbering.node_of[static_cast<std::size_t>(n)];
    if (part_of[static_cast<std::size_t>(point)] != id) continue;
    const Vec3 force = loads.segment<3>(3 * n);
    work.head<3>() += force;
    work.tail<3>() += arm_of(mesh, point, part).cross(force);
  }
  const Eigen::SelfAdjointEigenSolver<Gram> solver(part.held);
  const double largest = std::max(solver.eigenvalues().maxCoeff(), 1.0);
  free = Gram::Zero();
  for (int k = 0; k < 6; ++k)
    if (solver.eigenvalues()[k] < 1e-12 * largest)
      free += solver.eigenvectors().col(k) * solver.eigenvectors().col(k).transpose();
  return free * work;
}

std::string direction_text(const Vec3& d) {
  const char* const names[] = {"x", "y", "z"};
  for (int c = 0; c < 3; ++c)
    if (std::abs(d[c]) > (1 - 1e-9) * d.norm()) return (d[c] < 0 ? "-" : "") + std::string(names[c]);
  const Vec3 n = d.normalized();
  return fmt::format("({:.3g} {:.3g} {:.3g})", n[0], n[1], n[2]);
}

std::string place_text(Vec3 x, double size) {
  for (int c = 0; c < 3; ++c)
    if (std::abs(x[c]) < 1e-12 * size) x[c] = 0;
  return fmt::format("({:g} {:g} {:g})", x[0], x[1], x[2]);
}

/// In words, such as "along x with a force of 5"; a push has a part of each of the free motions.
std::string push_text(const Motion6& push, const Gram& free, const Part& part) {
  constexpr double small = 1e-6;  // of the whole push
  const Vec3 shift = push.head<3>(), turn = push.tail<3>();
  const bool shifts = shift.norm() > small * push.norm(), turns = turn.norm() > small * push.norm();
  Motion6 shift_alone = Motion6::Zero();
  shift_alone.head<3>() = shift;
  if (turns && (free * shift_alone - shift_alone).norm() > small * push.norm()) {
    // A rotation that supports guide: its axis is where it moves nothing.
    const Vec3 axis = part.centre + part.radius * turn.cross(shift) / turn.squaredNorm();
    return fmt::format("round {} through {} with a moment of {:.4g}", direction_text(turn),
                       place_text(axis, part.radius), part.radius * push.squaredNorm() / turn.norm());
  }
  std::string text;
  if (shifts) text = fmt::format("along {} with a force of {:.4g}", direction_text(shift), shift.norm());
  if (turns)
    text += fmt::format("{}round {} through its centre with a moment of {:.4g}", shifts ? ", and " : "",
                        direction_text(turn), part.radius * turn.norm());
  return text;
}

}  // namespace

FreeMotions free_motions(const Model& model, const Step& step, const Numbering& numbering, const Mask& fixed) {
  if (!step.springs.empty()) return {};  // as in check_held
  const Mesh& mesh = *model.mesh;
  const std::vector<int> part_of = connected_parts(model);
  std::vector<Part> parts = measure_parts(mesh, part_of, components(model));
  hold(model, step, part_of, parts);
  FreeMotions free;
  for (std::size_t id = 0; id < parts.size(); ++id) {
    const Part& part = parts[id];
    if (rank(part.all) == rank(part.held)) continue;
    const Eigen::SelfAdjointEigenSolver<Gram> solver(part.held);
    const double largest = std::max(solver.eigenvalues().maxCoeff(), 1.0);
    const std::size_t before = free.modes.size();
    for (int k = 0; k < 6; ++k) {
      if (solver.eigenvalues()[k] >= 1e-12 * largest) continue;
      const Vec3 shift = solver.eigenvectors().col(k).head<3>(), turn = solver.eigenvectors().col(k).tail<3>();
      Vector mode = Vector::Zero(3 * numbering.nodes());
      for (int n = 0; n < numbering.body_nodes(); ++n) {
        const int point = numbering.node_of[static_cast<std::size_t>(n)];
        if (part_of[static_cast<std::size_t>(point)] != static_cast<int>(id)) continue;
        const Vec3 arm = arm_of(mesh, point, part);
        mode.segment<3>(3 * n) = shift + turn.cross(arm);
      }
      for (Eigen::Index i = 0; i < mode.size(); ++i)
        if (fixed[static_cast<std::size_t>(i)]) mode[i] = 0;
      const double whole = std::sqrt(static_cast<double>(part.points));
      for (const Vector& other : free.modes) mode -= mode.dot(other) * other;
      if (mode.norm() > 1e-8 * whole) free.modes.push_back(mode.normalized());
    }
    if (free.modes.size() - before < 6) continue;
    free.parts.emplace_back();
    for (int n = 0; n < numbering.body_nodes(); ++n)
      if (part_of[static_cast<std::size_t>(numbering.node_of[static_cast<std::size_t>(n)])] == static_cast<int>(id))
        free.parts.back().push_back(n);
  }
  return free;
}

void remove_free_motions(const FreeMotions& free, bool small_strain, double loads, const Vector& X, Vector& u) {
  if (small_strain) {
    for (const Vector& mode : free.modes) u -= mode.dot(u) * mode;
    return;
  }
  for (const std::vector<int>& nodes : free.parts) {
    Vec3 from = Vec3::Zero(), to = Vec3::Zero();
    for (const int n : nodes) {
      to += X.segment<3>(3 * n) / static_cast<double>(nodes.size());
      from += (X.segment<3>(3 * n) + u.segment<3>(3 * n)) / static_cast<double>(nodes.size());
    }
    Mat3 R = Mat3::Identity();
    if (loads == 0) {
      Mat3 H = Mat3::Zero();
      for (const int n : nodes)
        H += (X.segment<3>(3 * n) + u.segment<3>(3 * n) - from) * (X.segment<3>(3 * n) - to).transpose();
      const Eigen::JacobiSVD<Mat3> svd(H, Eigen::ComputeFullU | Eigen::ComputeFullV);
      Vec3 signs(1, 1, (svd.matrixV() * svd.matrixU().transpose()).determinant() < 0 ? -1 : 1);
      R = svd.matrixV() * signs.asDiagonal() * svd.matrixU().transpose();
    }
    for (const int n : nodes) {
      const Vec3 x = R * (X.segment<3>(3 * n) + u.segment<3>(3 * n) - from) + to;
      u.segment<3>(3 * n) = x - X.segment<3>(3 * n);
    }
  }
}

void refuse_unbalanced(const Model& model, const Step& step, const Numbering& numbering, const Vector& loads) {
  if (is_scalar(model)) return check_held(model, step);
  const Mesh& mesh = *model.mesh;
  const std::vector<int> part_of = connected_parts(model);
  std::vector<Part> parts = measure_parts(mesh, part_of, components(model));
  hold(model, step, part_of, parts);
  const Part* pushed = nullptr;
  Motion6 push = Motion6::Zero();
  Gram free = Gram::Zero(), each;
  for (std::size_t id = 0; id < parts.size(); ++id) {
    if (rank(parts[id].all) == rank(parts[id].held)) continue;
    const Motion6 found = push_on(mesh, numbering, part_of, static_cast<int>(id), parts[id], loads, each);
    if (found.norm() > push.norm()) pushed = &parts[id], push = found, free = each;
  }
  if (!pushed) return check_held(model, step);
  const long motions = rank(pushed->all) - rank(pushed->absent), unheld = rank(pushed->all) - rank(pushed->held);
  throw Error(fmt::format(
      "step '{}' is static, but {} of the {} rigid motions of the part of {} nodes around {} {} free, and its loads do "
      "not balance: they push it {}. Balance them, hold it, or choose a dynamic timeIntegration",
      step.name, unheld, motions, pushed->points, place_text(pushed->centre, pushed->radius),
      unheld == 1 ? "is" : "are", push_text(push, free, *pushed)));
}

void check_held(const Model& model, const Step& step) {
  // Springs hold parts against each other in ways that only the matrix can tell.
  if (!step.springs.empty()) return;
  const Mesh& mesh = *model.mesh;
  const std::vector<int> part_of = connected_parts(model);
  std::vector<Part> parts = measure_parts(mesh, part_of, components(model));
  hold(model, step, part_of, parts);
  for (const Part& part : parts) {
    const long motions = rank(part.all) - rank(part.absent), free = rank(part.all) - rank(part.held);
    if (free > 0 && is_scalar(model))
      throw Error(fmt::format(
          "step '{}': nothing gives the level of the value of the part of {} nodes around ({:g} {:g} {:g}), "
          "and its fluxes and sources do not sum to zero: give it a fixedValue, or balance them",
          step.name, part.points, part.centre[0], part.centre[1], part.centre[2]));
    if (free > 0)
      throw Error(
          fmt::format("step '{}' is static, but {} of the {} rigid motions of the part of {} nodes around "
                      "({:g} {:g} {:g}) {} free: hold it, or choose a dynamic timeIntegration",
                      step.name, free, motions, part.points, part.centre[0], part.centre[1], part.centre[2],
                      free == 1 ? "is" : "are"));
  }
}

}  // namespace msml::fe
