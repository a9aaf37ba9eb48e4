// SPDX-License-Identifier: GPL-3.0-or-later
// AddFieldToMesh: values at centres and points.
#include <gmock/gmock.h>

#include "tests/operators/shared/mesh_facts.hpp"
#include "tests/operators/shared/run_operator.hpp"
#include "tests/operators/shared/shapes.hpp"

namespace msml::test {
namespace {

Value stored(Mesh mesh) { return std::make_shared<const Mesh>(std::move(mesh)); }

Formulas formulas(const std::vector<std::string>& texts) {
  Formulas all;
  for (const std::string& text : texts) all.emplace_back(text);
  return all;
}

TEST(AddField, EvaluatesFormulasAtTheCentresOfCells) {
  const Mesh given = five_tets();
  const auto mesh = output<Mesh>(
      run("AddFieldToMesh",
          {{"mesh", stored(given)}, {"name", std::string("fibres")}, {"values", formulas({"Y+Z", "2*X", "1"})}}));
  ASSERT_EQ(mesh->cell_fields.size(), 1u);
  EXPECT_EQ(mesh->cell_fields[0].components, 3);
  for (int c = 0; c < 5; ++c) {
    Vec3 X = Vec3::Zero();
    for (int a = 0; a < 4; ++a) X += Vec3(mesh->points.row(mesh->cell(c)[a])) / 4;
    const double* found = mesh->cell_fields[0].values.data() + 3 * c;
    EXPECT_NEAR(found[0], X[1] + X[2], 1e-14);
    EXPECT_NEAR(found[1], 2 * X[0], 1e-14);
    EXPECT_EQ(found[2], 1);
  }
  EXPECT_NO_THROW(mesh->check());
}

TEST(AddField, ReplacesAFieldOfPoints) {
  Mesh given = five_tets();
  given.point_fields.push_back({"E", 1, std::vector<double>(8, 7)});
  const auto mesh = output<Mesh>(run("AddFieldToMesh", {{"mesh", stored(given)},
                                                        {"name", std::string("E")},
                                                        {"values", formulas({"1+X"})},
                                                        {"at", std::string("points")}}));
  ASSERT_EQ(mesh->point_fields.size(), 1u);
  for (int n = 0; n < 8; ++n)
    EXPECT_EQ(mesh->point_fields[0].values[static_cast<std::size_t>(n)], 1 + mesh->points(n, 0));
}

TEST(AddField, RefusesTime) {
  EXPECT_THROW(
      run("AddFieldToMesh", {{"mesh", stored(five_tets())}, {"name", std::string("E")}, {"values", formulas({"1+t"})}}),
      Error);
}

}  // namespace
}  // namespace msml::test
