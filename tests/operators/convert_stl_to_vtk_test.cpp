// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include "tests/operators/shared/files.hpp"
#include "tests/operators/shared/run_operator.hpp"
#include "tests/operators/shared/shapes.hpp"

namespace msml {
namespace {

TEST(ConvertSTLToVTK, JoinsTheCornersOfAnStlAndWritesPolydata) {
  const test::Folder folder("msml_stl");
  std::string stl = "solid box\n";
  const Surface box = test::box(Vec3::Zero(), Vec3::Ones());
  for (const auto& t : box.triangles) {
    stl += "facet normal 0 0 0\nouter loop\n";
    for (const int i : t)
      stl += "vertex " + std::to_string(box.points(i, 0)) + " " + std::to_string(box.points(i, 1)) + " " +
             std::to_string(box.points(i, 2)) + "\n";
    stl += "endloop\nendfacet\n";
  }
  test::put_bytes(folder / "box.stl", stl + "endsolid box\n");
  const Registry registry = test::all();
  const Value read = registry.read(folder / "box.stl", Type::surface);
  const Value made = test::run("ConvertSTLToVTK", {{"STLMesh", read}});
  registry.write(made, folder / "box.vtk");
  const auto back = test::output<Surface>(registry.read(folder / "box.vtk", Type::surface));
  EXPECT_EQ(back->point_count(), 8);
  EXPECT_DOUBLE_EQ(test::volume(*back), 1);
  EXPECT_NE(test::bytes_of(folder / "box.vtk").find("DATASET POLYDATA"), std::string::npos);
}

}  // namespace
}  // namespace msml
