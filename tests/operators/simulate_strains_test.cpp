// SPDX-License-Identifier: GPL-3.0-or-later
// Strains, their principal values and the stresses of linear theory in a homogeneous state of every kind of element.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <map>
#include <numeric>

#include "tests/operators/simulate_scene.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::operators {
Operator simulate();
}  // namespace msml::operators

namespace msml::test {
namespace {

struct Kind {
  const char* tag;
  CellKind cell;
  Attributes attributes;
};

std::vector<Kind> kinds() {
  const auto said = [](const char* formulation) -> Attributes { return {{"formulation", std::string(formulation)}}; };
  return {{"linearLine", CellKind::line2, {}},
          {"quadraticLine", CellKind::line3, {}},
          {"linearTriangle", CellKind::tri3, {}},
          {"quadraticTriangle", CellKind::tri6, {}},
          {"linearTet", CellKind::tet4, {}},
          {"linearTet", CellKind::tet4, said("fbar")},
          {"quadraticTet", CellKind::tet10, {}},
          {"quadraticTet", CellKind::tet10, {{"quadrature", std::string("8")}}},
          {"quadraticTet", CellKind::tet10, said("singleRotation")},
          {"quadraticTet", CellKind::tet10, said("mixed")},
          {"quadraticTet", CellKind::tet10, {{"formulation", std::string("mixed")}, {"quadrature", std::string("8")}}}};
}

std::string called(const Kind& kind) {
  const auto found = kind.attributes.find("formulation");
  return std::string(kind.tag) + (found == kind.attributes.end() ? "" : std::get<std::string>(found->second));
}

/// F = (1.2 0.3 0; 0.1 0.9 0; 0 0 1.05), as far as the kind has dimensions.
Mat3 deformation_gradient(CellKind cell) {
  Mat3 F = Mat3::Identity();
  F(0, 0) = 1.2;
  if (dimension(cell) > 1) F.topLeftCorner<2, 2>() << 1.2, 0.3, 0.1, 0.9;
  if (dimension(cell) > 2) F(2, 2) = 1.05;
  return F;
}

using Found = std::map<std::string, Numbers>;

/// The fields in one element of a body whose points all move by that F.
Found fields_in(const Language& language, const Kind& kind, const Record& material,
                const std::vector<std::string>& fields) {
  const Mat3 F = deformation_gradient(kind.cell);
  Scene scene = cube(language);
  scene.mesh = std::make_shared<const Mesh>(fe::testing::unit_mesh(1, kind.cell));
  Attributes attributes = kind.attributes;
  attributes["mesh"] = scene.mesh;
  scene.mesh_tag = language.tag(kind.tag, "mesh", attributes);
  std::vector<int> cells(static_cast<std::size_t>(scene.mesh->cell_count()));
  std::iota(cells.begin(), cells.end(), 0);
  scene.regions = {language.tag("region", "region", {{"indices", index_set(scene.mesh, Indexed::elements, cells)}},
                                {material, language.tag("mass", "mass", {{"massDensity", 0.0}})})};
  std::vector<int> nodes;
  Numbers displacement;
  for (int n = 0; n < scene.mesh->point_count(); ++n) {
    nodes.push_back(n);
    const Vec3 X = scene.mesh->points.row(n).transpose(), u = F * X - X;
    displacement.insert(displacement.end(), u.data(), u.data() + 3);
  }
  scene.constraints = {
      condition(language, "displacementConstraint",
                {{"indices", index_set(scene.mesh, Indexed::nodes, nodes)}, {"displacement", displacement}})};
  const double across = dimension(kind.cell) > 1 ? 0.2 : 0, up = dimension(kind.cell) > 2 ? 0.3 : 0;
  for (const std::string& field : fields)
    scene.outputs.push_back(
        language.tag("probe", "output", {{"id", field}, {"point", Numbers{0.3, across, up}}, {"field", field}}));
  const Folder folder;
  Listener listener;
  const Record record = scene.record(language);
  Context context(record, listener, folder.path(), 1);
  operators::simulate()(context);
  Found found;
  for (const std::string& field : fields) {
    found[field] = csv_rows(folder.text(field + ".csv")).back();
    found[field].erase(found[field].begin());
  }
  return found;
}

Numbers six(const Mat3& a) { return {a(0, 0), a(1, 1), a(2, 2), a(0, 1), a(1, 2), a(0, 2)}; }

/// Of a symmetric tensor without xz and yz, whose zz lies between the others.
Numbers principal(const Mat3& a) {
  const double mean = 0.5 * (a(0, 0) + a(1, 1)), radius = std::hypot(0.5 * (a(0, 0) - a(1, 1)), a(0, 1));
  return {mean + radius, a(2, 2), mean - radius};
}

void expect_near(const Numbers& found, const Numbers& expected, double tolerance, const std::string& what) {
  ASSERT_EQ(found.size(), expected.size()) << what;
  for (std::size_t i = 0; i < found.size(); ++i) EXPECT_NEAR(found[i], expected[i], tolerance) << what << ' ' << i;
}

// Each law has both strains by name; the differences of positions leave some 1e-15.
TEST(Strains, OfEveryKindOfElementAreThoseOfTheDeformation) {
  const Language language;
  for (const Kind& kind : kinds()) {
    const Record material =
        language.tag("linearElasticMaterial", "material", {{"youngModulus", 1000.0}, {"poissonRatio", 0.3}});
    const Mat3 F = deformation_gradient(kind.cell), small = 0.5 * (F + F.transpose()) - Mat3::Identity(),
               green = 0.5 * (F.transpose() * F - Mat3::Identity());
    Found found = fields_in(language, kind, material,
                            {"smallStrain", "smallStrain_nodal", "principalSmallStrain", "greenLagrange",
                             "principalGreenLagrange", "principalGreenLagrange_nodal", "principalStrain"});
    expect_near(found["smallStrain"], six(small), 1e-13, called(kind));
    expect_near(found["smallStrain_nodal"], six(small), 1e-13, called(kind));
    expect_near(found["principalSmallStrain"], principal(small), 1e-13, called(kind));
    expect_near(found["greenLagrange"], six(green), 1e-13, called(kind));
    expect_near(found["principalGreenLagrange"], principal(green), 1e-13, called(kind));
    expect_near(found["principalGreenLagrange_nodal"], principal(green), 1e-13, called(kind));
    // U = sqrt(F^T F): its principal values are the stretches.
    Numbers stretches = principal(2 * green + Mat3::Identity());
    for (double& each : stretches) each = std::sqrt(each) - 1;
    expect_near(found["principalStrain"], stretches, 1e-12, called(kind));
  }
}

TEST(Strains, OfHyperelasticLawsHaveBothNamesToo) {
  const Language language;
  const Record material =
      language.tag("neoHookeanMaterial", "material", {{"youngModulus", 1000.0}, {"poissonRatio", 0.3}});
  for (const Kind& kind : kinds()) {
    if (called(kind) == "quadraticTetsingleRotation") continue;  // of corotated laws alone
    const Mat3 F = deformation_gradient(kind.cell), small = 0.5 * (F + F.transpose()) - Mat3::Identity(),
               green = 0.5 * (F.transpose() * F - Mat3::Identity());
    Found found = fields_in(language, kind, material, {"smallStrain", "strain", "principalStrain"});
    expect_near(found["smallStrain"], six(small), 1e-13, called(kind));
    expect_near(found["strain"], six(green), 1e-13, called(kind));
    expect_near(found["principalStrain"], principal(green), 1e-13, called(kind));
  }
}

// Linear theory knows one stress, 2 mu e + lambda tr(e) I, whatever the size of the strain.
TEST(SmallStrain, HasOneStressByAllNames) {
  const Language language;
  const Record material =
      language.tag("linearElasticMaterial", "material",
                   {{"youngModulus", 1000.0}, {"poissonRatio", 0.3}, {"strain", std::string("small")}});
  const double mu = 1000 / 2.6, lambda = 2 * mu * 0.3 / 0.4;
  for (const Kind& kind : kinds()) {
    if (called(kind) == "quadraticTetsingleRotation") continue;
    const Mat3 F = deformation_gradient(kind.cell), e = 0.5 * (F + F.transpose()) - Mat3::Identity(),
               stress = 2 * mu * e + lambda * e.trace() * Mat3::Identity();
    Found found = fields_in(language, kind, material,
                            {"stress", "secondPiola", "secondPiola_nodal", "firstPiola", "strain", "principalStrain"});
    for (const char* field : {"stress", "secondPiola", "secondPiola_nodal"})
      expect_near(found[field], six(stress), 1e-6, called(kind) + ' ' + field);
    const Numbers& P = found["firstPiola"];
    expect_near({P[0], P[4], P[8], P[1], P[5], P[2]}, six(stress), 1e-6, called(kind) + " firstPiola");
    expect_near(found["strain"], six(e), 1e-13, called(kind));
    expect_near(found["principalStrain"], principal(e), 1e-13, called(kind));
  }
}

// W = mu/2 (tr C - 3) - mu ln J + lambda/2 (ln J)^2: the multiplier is minus dU/d(ln J) = -lambda ln J - …, the mean
// stress (mu tr(F F^T)/3 - mu + lambda ln J) / J.
TEST(HydrostaticPressure, OfEveryKindOfElementIsMinusAThirdOfTheTraceOfStress) {
  const Language language;
  const Record material =
      language.tag("neoHookeanMaterial", "material", {{"youngModulus", 1000.0}, {"poissonRatio", 0.3}});
  const double mu = 1000 / 2.6, lambda = 2 * mu * 0.3 / 0.4;
  for (const Kind& kind : kinds()) {
    if (called(kind) == "quadraticTetsingleRotation") continue;
    const Mat3 F = deformation_gradient(kind.cell);
    const double J = F.determinant();
    const double expected = -(mu * (F.squaredNorm() / 3 - 1) + lambda * std::log(J)) / J;
    for (const auto& [field, found] :
         fields_in(language, kind, material, {"hydrostaticPressure", "hydrostaticPressure_nodal"}))
      expect_near(found, {expected}, 1e-6, called(kind));
  }
}

}  // namespace
}  // namespace msml::test
