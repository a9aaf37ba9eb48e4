// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "tests/operators/shared/files.hpp"
#include "tests/operators/shared/run_operator.hpp"
#include "tests/operators/shared/shapes.hpp"

namespace msml {
namespace {

TEST(ConvertVTKToVTU, KeepsTheMeshAndItsRegions) {
  const test::Folder folder("msml_vtu");
  Mesh mesh = test::five_tets();
  mesh.regions = {1, 1, 2, 2, 84};
  const Registry registry = test::all();
  registry.write(std::make_shared<const Mesh>(mesh), folder / "m.vtk");
  const Value made = test::run("ConvertVTKToVTU", {{"VTKMesh", registry.read(folder / "m.vtk", Type::mesh)}});
  registry.write(made, folder / "m.vtu");
  const auto back = test::output<Mesh>(registry.read(folder / "m.vtu", Type::mesh));
  EXPECT_EQ(back->points, mesh.points);
  EXPECT_EQ(back->nodes, mesh.nodes);
  EXPECT_EQ(back->regions, mesh.regions);
  EXPECT_NE(test::bytes_of(folder / "m.vtu").find("type=\"UnstructuredGrid\""), std::string::npos);
}

}  // namespace
}  // namespace msml
