// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>

#include <cmath>

#include "tests/operators/shared/run_operator.hpp"
#include "tests/operators/shared/shapes.hpp"
#include "tests/operators/simulate_scene.hpp"

namespace msml {
namespace {

/// A unit cube of five tets with a point field.
Value cube(const std::string& name, int components, const std::function<double(const Vec3&, int)>& value) {
  Mesh mesh = test::five_tets();
  Field field{.name = name, .components = components};
  for (int n = 0; n < mesh.point_count(); ++n)
    for (int c = 0; c < components; ++c) field.values.push_back(value(mesh.points.row(n).transpose(), c));
  mesh.point_fields.push_back(field);
  return std::make_shared<const Mesh>(std::move(mesh));
}

double error(const Value& mesh, const std::vector<std::string>& expected, const std::string& norm, bool relative,
             const std::string& field = "heat") {
  Formulas formulas;
  for (const std::string& text : expected) formulas.push_back(Formula(text));
  return std::get<double>(
      test::run("ComputeFieldError",
                {{"mesh", mesh}, {"field", field}, {"expected", formulas}, {"norm", norm}, {"relative", relative}}));
}

TEST(FieldError, IsZeroForALinearFieldInEveryNorm) {
  const Value mesh = cube("heat", 1, [](const Vec3& X, int) { return 1 + X[0] - 2 * X[1] + 3 * X[2]; });
  for (const char* norm : {"L2", "H1", "RMS", "maximum"})
    EXPECT_NEAR(error(mesh, {"1 + X - 2*Y + 3*Z"}, norm, true), 0, 1e-10) << norm;  // H1: differences to 1e-11
}

// Against zero the error is the field itself: the integral of X^2 over the cube is 1/3, its gradient has length 1.
TEST(FieldError, IntegratesOverTheBody) {
  const Value mesh = cube("heat", 1, [](const Vec3& X, int) { return X[0]; });
  EXPECT_NEAR(error(mesh, {"0*X"}, "L2", false), std::sqrt(1.0 / 3), 1e-14);
  EXPECT_NEAR(error(mesh, {"0*X"}, "H1", false), 1, 1e-12);
  EXPECT_NEAR(error(mesh, {"0*X"}, "RMS", false), std::sqrt(0.5), 1e-14);
  EXPECT_NEAR(error(mesh, {"0*X"}, "maximum", false), 1, 1e-14);
  EXPECT_NEAR(error(mesh, {"2*X"}, "L2", true), 0.5, 1e-14);
}

TEST(FieldError, TakesTheDisplacementOffThePoints) {
  const Value mesh = cube("displacement", 3, [](const Vec3& X, int c) { return c == 0 ? 0.5 * X[0] : 0.0; });
  // The points are X + u, so X = x - u; x = 1 is X = 1 - 0.5.
  const double at_node = error(mesh, {"0*X", "0*X", "0*X"}, "maximum", false, "displacement");
  EXPECT_NEAR(at_node, 0.5, 1e-14);
  EXPECT_NEAR(error(mesh, {"X", "0*X", "0*X"}, "maximum", false, "displacement"), 0, 1e-14);
}

TEST(FieldError, RefusesWhatCannotBeCompared) {
  const Value mesh = cube("heat", 1, [](const Vec3& X, int) { return X[0]; });
  const Formulas two{Formula("X"), Formula("Y")};
  EXPECT_EQ(test::error_of("ComputeFieldError", {{"mesh", mesh}, {"field", std::string("heat")}, {"expected", two}}),
            "expected has 2 components, but the field 'heat' has 1");
  EXPECT_EQ(test::error_of("ComputeFieldError", {{"mesh", mesh}, {"field", std::string("heat")}}),
            "give either expected or referenceMesh, what the field is to be compared with");
  EXPECT_EQ(test::error_of("ComputeFieldError",
                           {{"mesh", mesh}, {"field", std::string("head")}, {"expected", Formulas{Formula("X")}}}),
            "field = 'head' is no point field of the mesh (did you mean 'heat'?); it has heat");
}

TEST(FieldError, AgreesWithItselfOnTheSameMesh) {
  const Value mesh = cube("heat", 1, [](const Vec3& X, int) { return X[0]; });
  const Value other = cube("heat", 1, [](const Vec3& X, int) { return 2 * X[0]; });
  EXPECT_EQ(std::get<double>(test::run("ComputeFieldError",
                                       {{"mesh", mesh}, {"referenceMesh", mesh}, {"field", std::string("heat")}})),
            0);
  EXPECT_NEAR(
      std::get<double>(test::run(
          "ComputeFieldError",
          {{"mesh", mesh}, {"referenceMesh", other}, {"field", std::string("heat")}, {"norm", std::string("RMS")}})),
      0.5, 1e-12);
}

// Between nodes x0 and x1 the slope of the interpolant of X^2 is x0 + x1. In cells of h against cells of h/4 the slopes
// differ by h/4 times -3, -1, 1 and 3: sqrt(5)/4 h in the mean of squares.
TEST(FieldError, ComparesGradientsWithThoseOnAFinerMesh) {
  const auto squares = [](int n) {
    Mesh mesh = test::box(n, n, n, 1.0 / n);
    Field field{.name = "heat", .components = 1};
    for (int k = 0; k < mesh.point_count(); ++k) field.values.push_back(mesh.points(k, 0) * mesh.points(k, 0));
    mesh.point_fields = {field};
    return std::make_shared<const Mesh>(std::move(mesh));
  };
  const double found = std::get<double>(test::run("ComputeFieldError", {{"mesh", squares(2)},
                                                                        {"referenceMesh", squares(8)},
                                                                        {"field", std::string("heat")},
                                                                        {"norm", std::string("H1")},
                                                                        {"relative", false}}));
  EXPECT_NEAR(found, std::sqrt(5.0) / 4 * 0.5, 1e-9);
}

}  // namespace
}  // namespace msml
