// SPDX-License-Identifier: GPL-3.0-or-later
// GenerateSpheres: triangulated spheres of one radius at given centres.
#include <vtkAppendPolyData.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSphereSource.h>

#include "msml/core/operator.hpp"
#include "operators/vtk_convert.hpp"
#include "operators/vtk_guard.hpp"

namespace msml::operators {

Operator generate_spheres();

namespace {

struct Spheres {
  std::vector<double> centers;  ///< x y z of each
  double radius;
  int theta, phi;
};

Surface spheres(const Spheres& wanted) {
  const vtkNew<vtkAppendPolyData> all;
  all->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
  for (std::size_t i = 0; i < wanted.centers.size(); i += 3) {
    const vtkNew<vtkSphereSource> sphere;
    sphere->SetOutputPointsPrecision(vtkAlgorithm::DOUBLE_PRECISION);
    sphere->GenerateNormalsOff();
    sphere->SetCenter(wanted.centers.data() + i);
    sphere->SetRadius(wanted.radius);
    sphere->SetThetaResolution(wanted.theta);
    sphere->SetPhiResolution(wanted.phi);
    all->AddInputConnection(sphere->GetOutputPort());
  }
  update(*all, "GenerateSpheres");
  return to_surface(*all->GetOutput());
}

}  // namespace

Operator generate_spheres() {
  Operator op("GenerateSpheres", "Triangulated spheres of one radius, one at each of the given centres.");
  op.source("vtkSphereSource, vtkAppendPolyData");
  op.note(
      "All corners lie on the sphere, so the enclosed volume is below 4/3 pi r^3 and approaches it with both "
      "resolutions. Spheres that overlap are not merged: the surface then intersects itself.");
  op.note("The axis of theta is z. A sphere has thetaResolution (phiResolution - 2) + 2 points.");
  const auto centers = op.parameter<std::vector<double>>(
      "centers", {.unit = "length", .multiple_of = 3, .doc = "x y z of each centre, one after another"});
  const auto radius =
      op.parameter("radius", {.unit = "length", .range = positive(), .fallback = 10.0, .doc = "radius"});
  const auto theta = op.parameter<Integer>("thetaResolution",
                                           {.range = closed(3, 1024), .fallback = 8, .doc = "points around the axis"});
  const auto phi = op.parameter<Integer>(
      "phiResolution", {.range = closed(3, 1024), .fallback = 8, .doc = "points from pole to pole, both included"});
  const auto surface = op.output<Surface>("targetsurface", "the spheres, closed, triangles seen from outside");
  op.target("outFilename", surface, "file to write the surface to");
  op.run([=](Context& c) {
    if (c.get(centers).empty()) throw Error("centers is empty; three numbers per sphere are needed");
    c.set(surface, spheres({.centers = c.get(centers),
                            .radius = c.get(radius),
                            .theta = static_cast<int>(c.get(theta)),
                            .phi = static_cast<int>(c.get(phi))}));
  });
  return op;
}

}  // namespace msml::operators
