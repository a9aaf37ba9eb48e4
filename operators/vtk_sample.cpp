// SPDX-License-Identifier: GPL-3.0-or-later
// Point location through vtkStaticCellLocator.
#include "operators/vtk_sample.hpp"

#include <vtkCell.h>
#include <vtkGenericCell.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkSmartPointer.h>
#include <vtkStaticCellLocator.h>
#include <vtkUnstructuredGrid.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "msml/core/error.hpp"
#include "operators/vtk_convert.hpp"
#include "operators/vtk_guard.hpp"

namespace msml::operators {

struct Sampler::Tree {
  std::vector<int> ids;  ///< of the searched cells in the mesh
  vtkSmartPointer<vtkUnstructuredGrid> grid;
  vtkNew<vtkStaticCellLocator> locator;
  vtkNew<vtkGenericCell> cell;
  bool solid = false;
  double tolerance2 = 0;
};

namespace {

/// Newton's method for the place of x in a solid cell; VTK stops at about four digits in quadratic ones.
void refine(vtkCell& cell, const std::array<double, 3>& x, std::array<double, 3>& local,
            std::array<double, 10>& weights) {
  constexpr int steps = 6;  // digits double in each
  std::array<double, 30> derivatives{};
  const vtkIdType n = cell.GetNumberOfPoints();
  for (int step = 0; step < steps; ++step) {
    cell.InterpolateFunctions(local.data(), weights.data());
    cell.InterpolateDerivs(local.data(), derivatives.data());
    Vec3 residual(x[0], x[1], x[2]);
    Mat3 jacobian = Mat3::Zero();
    for (vtkIdType i = 0; i < n; ++i) {
      Vec3 point;
      cell.GetPoints()->GetPoint(i, point.data());
      residual -= weights[static_cast<std::size_t>(i)] * point;
      for (int d = 0; d < 3; ++d) jacobian.col(d) += derivatives[static_cast<std::size_t>(d * n + i)] * point;
    }
    if (!(std::abs(jacobian.determinant()) > 0)) return;
    const Vec3 change = jacobian.inverse() * residual;
    if (!(change.norm() < 1)) return;  // leaves the cell: keep the last place
    for (int d = 0; d < 3; ++d) local[static_cast<std::size_t>(d)] += change[d];
  }
  cell.InterpolateFunctions(local.data(), weights.data());
}

}  // namespace

Sampler::Sampler(const Mesh& mesh, const Points& points) : tree_(std::make_unique<Tree>()) {
  int highest = 0;
  for (const CellKind kind : mesh.kinds) highest = std::max(highest, dimension(kind));
  if (highest == 0) throw Error("the mesh has no lines, triangles or tetrahedra to interpolate in");
  Mesh part;
  part.points = points;
  for (int c = 0; c < mesh.cell_count(); ++c) {
    const CellKind kind = mesh.kinds[static_cast<std::size_t>(c)];
    if (dimension(kind) != highest) continue;
    part.add_cell(kind, mesh.cell(c));
    tree_->ids.push_back(c);
  }
  tree_->solid = highest == 3;
  tree_->grid = to_vtk(part);
  const double diagonal = tree_->grid->GetLength();
  constexpr double round_off = 1e-10;  // of the diagonal: a node on a face is inside
  tree_->tolerance2 = round_off * round_off * diagonal * diagonal;
  tree_->locator->SetDataSet(tree_->grid);
  guarded("building the search tree", [&] { tree_->locator->BuildLocator(); });
}

Sampler::~Sampler() = default;

Place Sampler::find(const Vec3& point) const {
  std::array<double, 3> x{point[0], point[1], point[2]}, at{}, local{};
  std::array<double, 10> weights{};
  double distance2 = 0;
  int sub = 0;
  vtkIdType id = -1;
  if (tree_->solid)
    id = tree_->locator->FindCell(x.data(), tree_->tolerance2, tree_->cell.Get(), local.data(), weights.data());
  if (id < 0) {
    tree_->locator->FindClosestPoint(x.data(), at.data(), tree_->cell.Get(), id, sub, distance2);
    if (id < 0) throw Error("no cell is near the point; the mesh is degenerate");
    tree_->grid->GetCell(id, tree_->cell);
    double ignored = 0;
    std::array<double, 3> nearest{};
    tree_->cell->EvaluatePosition(at.data(), nearest.data(), sub, local.data(), ignored, weights.data());
  }
  if (tree_->solid) refine(*tree_->cell, distance2 > 0 ? at : x, local, weights);
  const auto n = static_cast<std::size_t>(tree_->cell->GetNumberOfPoints());
  return {.cell = tree_->ids[static_cast<std::size_t>(id)],
          .distance = distance2 <= tree_->tolerance2 ? 0 : std::sqrt(distance2),
          .weights = {weights.begin(), weights.begin() + static_cast<std::ptrdiff_t>(n)}};
}

}  // namespace msml::operators
