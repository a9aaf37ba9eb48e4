// SPDX-License-Identifier: GPL-3.0-or-later
// Materials whose numbers and directions come from cell fields.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "operators/simulate/build_model.hpp"
#include "solver/materials/law.hpp"
#include "tests/operators/simulate_scene.hpp"

namespace msml::test {
namespace {

using simulation::build_model;
using testing::HasSubstr;

/// A bar of two cubes along z, 12 elements; fibres along z below and along x above, E = 1000 + 100 element.
Scene bar(const Language& language, const std::string& tag, const Attributes& attributes) {
  Scene scene = cube(language);
  auto mesh = std::make_shared<Mesh>(box(1, 1, 2));
  Field fibres{.name = "fibres", .components = 3, .values = {}}, stiffness{.name = "E", .components = 1, .values = {}};
  for (int e = 0; e < mesh->cell_count(); ++e) {
    for (const double x : {e < 6 ? 0.0 : 2.0, 0.0, e < 6 ? 1.0 : 0.0}) fibres.values.push_back(x);
    stiffness.values.push_back(1000 + 100 * e);
  }
  mesh->cell_fields = {fibres, stiffness};
  scene.mesh = mesh;
  std::vector<int> all(static_cast<std::size_t>(mesh->cell_count()));
  std::iota(all.begin(), all.end(), 0);
  scene.regions = {language.tag("region", "region", {{"indices", index_set(mesh, Indexed::elements, all)}},
                                {language.tag(tag, "material", attributes)})};
  return scene;
}

std::string message(const Language& language, const Scene& scene) {
  Listener listener;
  try {
    build_model(scene.record(language), listener, 1);
  } catch (const Error& error) {
    return error.str();
  }
  return "no error";
}

/// First Piola stress for F = diag(x, y, z), in lane k.
Mat3 stress(const fe::Law& law, double x, double y, double z, int lane) {
  fe::Gradients H{};
  H(0, 0) += x - 1;
  H(1, 1) += y - 1;
  H(2, 2) += z - 1;
  fe::Response response;
  law.evaluate(fe::Want::stress, {&H, 1}, {&response, 1});
  Mat3 P;
  for (int k = 0; k < 9; ++k) P(k / 3, k % 3) = response.P.c[k][lane];
  return P;
}

const Attributes fibre_law{{"youngModulus", 1000.0}, {"poissonRatio", 0.3}, {"k1", 300.0}, {"k2", 0.5}};

Attributes with(Attributes attributes, const std::string& name, const Value& value) {
  attributes[name] = value;
  return attributes;
}

TEST(Materials, TakeFibresFromACellField) {
  const Language language;
  Listener listener;
  const Scene scene = bar(language, "transverselyIsotropicMaterial", with(fibre_law, "fiber", std::string("fibres")));
  const auto simulation = build_model(scene.record(language), listener, 1);
  const fe::Region& region = simulation.model.regions[0];
  ASSERT_TRUE(region.local_law);
  const std::vector<int> elements{5, 6, 11};  // the last repeats in the other lanes
  const auto law = region.local_law(elements);
  const double l = 1.3, f = l * l - 1, fibre = 2 * 300 * f * std::exp(0.5 * f * f) * l;
  const Mat3 below = stress(*law, 1, 1, l, 0), above = stress(*law, 1, 1, l, 1);
  EXPECT_NEAR(below(2, 2) - above(2, 2), fibre, 1e-9);
  EXPECT_EQ(stress(*law, l, 1, 1, 1), stress(*law, l, 1, 1, 7));
}

TEST(Materials, TakeNumbersFromACellField) {
  const Language language;
  Listener listener;
  const Attributes attributes{{"youngModulus", 1.0},
                              {"poissonRatio", 0.25},
                              {"strain", std::string("small")},
                              {"fields", std::string("youngModulus=E")}};
  const auto simulation = build_model(bar(language, "linearElasticMaterial", attributes).record(language), listener, 1);
  const std::vector<int> elements{3, 7};
  const auto law = simulation.model.regions[0].local_law(elements);
  // lambda = mu = 0.4 E: P = 0.4 E (2 e + tr(e)).
  EXPECT_NEAR(stress(*law, 1.01, 1, 1, 0)(0, 0), 0.4 * 1300 * 0.03, 1e-10);
  EXPECT_NEAR(stress(*law, 1.01, 1, 1, 1)(0, 0), 0.4 * 1700 * 0.03, 1e-10);
}

TEST(Materials, MayBeExpressionsInThePlace) {
  const Language language;
  Listener listener;
  const auto scene = [&](const std::string& young) {
    return bar(language, "linearElasticMaterial",
               {{"youngModulus", Formula(young)}, {"poissonRatio", 0.25}, {"strain", std::string("small")}});
  };
  const auto simulation = build_model(scene("1000*(1+Z)").record(language), listener, 1);
  ASSERT_TRUE(simulation.model.regions[0].point_law);
  const std::vector<Vec3> places{{0, 0, 0.5}, {3, 1, 2}};
  const auto law = simulation.model.regions[0].point_law(std::vector<int>{0}, places);
  EXPECT_NEAR(stress(*law, 1.01, 1, 1, 0)(0, 0), 0.4 * 1500 * 0.03, 1e-10);
  EXPECT_NEAR(stress(*law, 1.01, 1, 1, 7)(0, 0), 0.4 * 3000 * 0.03, 1e-10);
  EXPECT_THAT(message(language, scene("1000+t")), HasSubstr("depends on t"));
  EXPECT_THAT(message(language, scene("Z-1")), HasSubstr("youngModulus"));
}

TEST(Materials, TakeExpressionsInListsAndDirections) {
  const Language language;
  Listener listener;
  const auto law_at = [&](const std::string& tag, const Attributes& attributes, const Vec3& X) {
    const auto simulation = build_model(bar(language, tag, attributes).record(language), listener, 1);
    const std::vector<int> elements{7};
    return simulation.model.regions[0].point_law(elements, std::vector<Vec3>{{0, 0, 0}, X});
  };
  const auto same = [&](const std::string& tag, const Attributes& varying, const Attributes& there) {
    const auto one = law_at(tag, varying, {0.5, 0.25, 2});
    const auto simulation = build_model(bar(language, tag, there).record(language), listener, 1);
    EXPECT_LT((stress(*one, 1.3, 1.2, 0.8, 1) - stress(*simulation.model.regions[0].law, 1.3, 1.2, 0.8, 0)).norm(),
              1e-12)
        << tag;
    EXPECT_GT((stress(*one, 1.3, 1.2, 0.8, 1) - stress(*one, 1.3, 1.2, 0.8, 0)).norm(), 1e-2) << tag;
  };
  same("ogdenMaterial",
       {{"mu", Formulas{Formula("1+Z"), 2.0}}, {"alpha", Formulas{2.0, Formula("4-Z")}}, {"bulkModulus", 50.0}},
       {{"mu", Formulas{3.0, 2.0}}, {"alpha", Formulas{2.0, 2.0}}, {"bulkModulus", 50.0}});
  same("reducedPolynomialMaterial", {{"c", Formulas{Formula("1+X"), Formula("Y")}}, {"bulkModulus", 50.0}},
       {{"c", Formulas{1.5, 0.25}}, {"bulkModulus", 50.0}});
  same("polynomialMaterial", {{"terms", Formulas{1.0, 0.0, Formula("1+Z")}}, {"bulkModulus", 50.0}},
       {{"terms", Formulas{1.0, 0.0, 3.0}}, {"bulkModulus", 50.0}});
  same("transverselyIsotropicMaterial", with(fibre_law, "fiber", std::string("-Y, X, 1 - Z/2")),
       with(fibre_law, "fiber", std::string("-1 2 0")));
  EXPECT_THAT(
      message(language, bar(language, "transverselyIsotropicMaterial", with(fibre_law, "fiber", std::string("t 0 1")))),
      HasSubstr("fiber = 't' depends on t"));
}

TEST(Materials, TakeEntriesOfListsFromCellFields) {
  const Language language;
  const auto model_of = [&](const std::string& tag, const Attributes& attributes) {
    Listener listener;
    Scene scene = bar(language, tag, attributes);
    auto mesh = std::make_shared<Mesh>(*scene.mesh);
    Field both{.name = "both", .components = 2, .values = {}};
    for (int e = 0; e < mesh->cell_count(); ++e) both.values.insert(both.values.end(), {100.0 + e, 200.0 - e});
    mesh->cell_fields.push_back(both);
    scene.mesh = mesh;
    return build_model(scene.record(language), listener, 1);
  };
  const std::vector<int> elements{3, 7};
  const auto same = [&](const std::string& tag, const Attributes& varying, const Attributes& there) {
    const auto one = model_of(tag, varying), other = model_of(tag, there);
    const auto law = one.model.regions[0].local_law(elements);
    EXPECT_LT((stress(*law, 1.3, 1.2, 0.8, 1) - stress(*other.model.regions[0].law, 1.3, 1.2, 0.8, 0)).norm(), 1e-9)
        << tag;
    EXPECT_GT((stress(*law, 1.3, 1.2, 0.8, 1) - stress(*law, 1.3, 1.2, 0.8, 0)).norm(), 1e-2) << tag;
  };
  // E = 1700 and both = (107, 193) in element 7.
  const Attributes ogden{{"mu", Formulas{300.0, 50.0}}, {"alpha", Formulas{2.0, 3.0}}, {"bulkModulus", 500.0}};
  same("ogdenMaterial", with(ogden, "fields", std::string("mu[1]=E")), with(ogden, "mu", Formulas{1700.0, 50.0}));
  same("ogdenMaterial", with(ogden, "fields", std::string("mu=both")), with(ogden, "mu", Formulas{107.0, 193.0}));
  const Attributes reduced{{"c", Formulas{1.0, 2.0}}, {"bulkModulus", 500.0}};
  same("reducedPolynomialMaterial", with(reduced, "fields", std::string("c[2]=E")),
       with(reduced, "c", Formulas{1.0, 1700.0}));
  const Attributes polynomial{{"terms", Formulas{1.0, 0.0, 9.0, 0.0, 1.0, 60.0}}, {"bulkModulus", 500.0}};
  same("polynomialMaterial", with(polynomial, "fields", std::string("terms[3]=E")),
       with(polynomial, "terms", Formulas{1.0, 0.0, 1700.0, 0.0, 1.0, 60.0}));

  const auto fault = [&](const std::string& fields) {
    return message(language, bar(language, "ogdenMaterial", with(ogden, "fields", fields)));
  };
  EXPECT_THAT(fault("mu[3]=E"), HasSubstr("fields: 'mu[3]' is no number of mu, which has those from mu[1] to mu[2]"));
  EXPECT_THAT(fault("mu[0]=E"), HasSubstr("'mu[0]' is no number of mu"));
  EXPECT_THAT(fault("mu[=E"), HasSubstr("'mu[' is no number of mu"));
  EXPECT_THAT(fault("bulkModulus[1]=E"), HasSubstr("which is one number: leave out the brackets"));
  EXPECT_THAT(fault("mu=E"), HasSubstr("mu is taken from the cell field 'E', which has 1 component instead of 2"));
  EXPECT_THAT(fault("mu=E mu[2]=E"), HasSubstr("fields names mu[2] twice"));
  EXPECT_THAT(fault("mu[2]=E mu[2]=E"), HasSubstr("fields names mu[2] twice"));
  EXPECT_EQ(fault("mu[1]=E mu[2]=E"), "no error");
  EXPECT_THAT(
      message(language, bar(language, "polynomialMaterial", with(polynomial, "fields", std::string("terms[1]=E")))),
      HasSubstr("terms"));
}

// What numbers must fulfil together is asked in every element before the run: the powers are 1 0, but 0.5 0 in the
// last.
TEST(Materials, AreMadeInEveryElementBeforeTheRun) {
  const Language language;
  Scene scene =
      bar(language, "polynomialMaterial",
          {{"terms", Formulas{1.0, 0.0, 9.0}}, {"bulkModulus", 500.0}, {"fields", std::string("terms[1]=power")}});
  auto mesh = std::make_shared<Mesh>(*scene.mesh);
  mesh->cell_fields.push_back({.name = "power", .components = 1, .values = std::vector<double>(12, 1.0)});
  scene.mesh = mesh;
  EXPECT_EQ(message(language, scene), "no error");
  mesh->cell_fields.back().values.back() = 0.5;
  EXPECT_THAT(message(language, scene), HasSubstr("terms holds the powers 0.5 0; powers are whole numbers"));
}

TEST(Guccione, MayHaveASheetWhichChangesNothing) {
  const Language language;
  const Attributes muscle{{"C", 100.0}, {"bf", 18.0},           {"bt", 4.0},
                          {"bfs", 2.0}, {"bulkModulus", 500.0}, {"fiber", std::string("1 0 0")}};
  const auto law = [&](const Attributes& attributes) {
    Listener listener;
    return build_model(bar(language, "guccioneMaterial", attributes).record(language), listener, 1)
        .model.regions[0]
        .law;
  };
  const Mat3 plain = stress(*law(muscle), 1.1, 1.2, 0.9, 0);
  EXPECT_GT(plain.norm(), 1);
  EXPECT_EQ(stress(*law(with(muscle, "sheet", std::string("0 1 0"))), 1.1, 1.2, 0.9, 0), plain);
  EXPECT_EQ(stress(*law(with(muscle, "sheet", std::string("1 0 2"))), 1.1, 1.2, 0.9, 0), plain);
  EXPECT_THAT(message(language, bar(language, "guccioneMaterial", with(muscle, "sheet", std::string("-2 0 0")))),
              HasSubstr("sheet lies along fiber"));
}

TEST(Materials, AreClampedBelowAStretchThatVaries) {
  const Language language;
  Listener listener;
  const Attributes attributes{{"youngModulus", 1000.0},
                              {"poissonRatio", 0.3},
                              {"inversion", std::string("clamped")},
                              {"clampedBelow", Formula("0.2 + 0.1*Z")}};
  const auto law_with = [&](const Value& below) {
    return build_model(bar(language, "neoHookeanMaterial", with(attributes, "clampedBelow", below)).record(language),
                       listener, 1);
  };
  const auto varying = law_with(Formula("0.2 + 0.1*Z")), there = law_with(0.4);
  const auto law = varying.model.regions[0].point_law(std::vector<int>{0}, std::vector<Vec3>{{0, 0, 0}, {0, 0, 2}});
  const Mat3 expected = stress(*there.model.regions[0].law, 1, 1, 0.1, 0);
  EXPECT_LT((stress(*law, 1, 1, 0.1, 1) - expected).norm(), 1e-9);
  EXPECT_GT((stress(*law, 1, 1, 0.1, 0) - expected).norm(), 1);
}

TEST(Materials, TakeExpressionsBesideFields) {
  const Language language;
  Listener listener;
  Attributes attributes = with(fibre_law, "fiber", std::string("fibres"));
  attributes["k1"] = Formula("100*(1+X)");
  const Scene scene = bar(language, "transverselyIsotropicMaterial", attributes);
  const auto simulation = build_model(scene.record(language), listener, 1);
  const std::vector<int> elements{5, 6};  // fibres along z, then along x
  const auto law = simulation.model.regions[0].point_law(elements, std::vector<Vec3>{{0, 0, 0}, {2, 0, 0}});
  const double l = 1.3, f = l * l - 1, fibre = 2 * f * std::exp(0.5 * f * f) * l;
  EXPECT_NEAR(stress(*law, 1, 1, l, 0)(2, 2) - stress(*law, 1, 1, l, 1)(2, 2), 100 * fibre, 1e-9);
  EXPECT_NEAR(stress(*law, l, 1, 1, 1)(0, 0) - stress(*law, l, 1, 1, 0)(0, 0), 300 * fibre, 1e-9);
}

TEST(Mass, MayVaryFromPlaceToPlace) {
  const Language language;
  Listener listener;
  const auto density = [&](const Attributes& attributes) {
    Scene scene = bar(language, "linearElasticMaterial", {{"youngModulus", 1.0}, {"poissonRatio", 0.25}});
    scene.regions[0].children.push_back(language.tag("mass", "mass", attributes));
    return build_model(scene.record(language), listener, 1).model.regions[0];
  };
  EXPECT_FALSE(density({{"massDensity", 3.0}}).density_at);
  const fe::Region sloping = density({{"massDensity", Formula("1+Z")}});
  ASSERT_TRUE(sloping.density_at);
  EXPECT_EQ(sloping.density_at(4, {0, 0, 1.5}), 2.5);
  EXPECT_EQ(density({{"fields", std::string("massDensity=E")}}).density_at(4, {0, 0, 1.5}), 1400);
  EXPECT_THROW(density({{"massDensity", Formula("1+t")}}), Error);
}

TEST(Materials, RefuseFieldsThatDoNotFit) {
  const Language language;
  const auto fibre = [&](const std::string& name) {
    return message(language, bar(language, "transverselyIsotropicMaterial", with(fibre_law, "fiber", name)));
  };
  EXPECT_THAT(fibre("fibers"), HasSubstr("fiber = 'fibers' is no cell field of the mesh; it has fibres, E"));
  EXPECT_THAT(fibre("E"), HasSubstr("fiber is taken from the cell field 'E', which has 1 component instead of 3"));
  const auto numbers = [&](const std::string& fields) {
    const Attributes attributes{{"youngModulus", 1.0}, {"poissonRatio", 0.25}, {"fields", fields}};
    return message(language, bar(language, "neoHookeanMaterial", attributes));
  };
  EXPECT_THAT(numbers("youngModulus"), HasSubstr("'youngModulus' is no pair attribute=field"));
  EXPECT_THAT(numbers("young=E"), HasSubstr("'young' is no attribute that takes a number"));
  EXPECT_THAT(numbers("form=E"), HasSubstr("'form' is no attribute that takes a number"));
  EXPECT_THAT(numbers("poissonRatio=E"), HasSubstr("the field 'E' holds 1000 in element 0"));
  EXPECT_EQ(numbers("youngModulus=E"), "no error");
}

TEST(Materials, RefuseIncompressibleLawsOutsideMixedElements) {
  const Language language;
  Listener listener;
  const Scene scene = bar(language, "mooneyRivlinMaterial", {{"c1", 1.0}, {"incompressible", true}});
  const auto simulation = build_model(scene.record(language), listener, 1);
  try {
    simulation.model.check();
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.str(), HasSubstr("needs a mesh with formulation=\"mixed\""));
  }
}

TEST(Prony, MayDifferFromPlaceToPlace) {
  const Language language;
  const auto scene = [&](const Attributes& attributes) {
    Scene one = bar(language, "linearElasticMaterial", {{"youngModulus", 1.0}, {"poissonRatio", 0.25}});
    one.regions[0].children.push_back(language.tag("prony", "prony", attributes));
    return one;
  };
  Listener listener;
  const Attributes varying{{"g", Formulas{Formula("0.1 + Z/10"), 0.2}},
                           {"tau", Formulas{1.0, Formula("0.5 + X")}},
                           {"fields", std::string("tau[1]=E")},
                           {"given", std::string("longTerm")}};
  const auto simulation = build_model(scene(varying).record(language), listener, 1);
  const fe::Region& region = simulation.model.regions[0];
  ASSERT_TRUE(region.prony_at);
  const fe::Prony there = region.prony_at(7, {0.5, 0, 2});
  EXPECT_THAT(there.g, testing::ElementsAre(testing::DoubleNear(0.3, 1e-15), 0.2));
  EXPECT_THAT(there.tau, testing::ElementsAre(1700, 1));
  EXPECT_TRUE(there.long_term);
  ASSERT_EQ(region.prony.tau.size(), 2u);
  EXPECT_EQ(region.prony.tau[0], 1000);  // the shortest
  const Attributes here_and_there{{"g", Formulas{Formula("max(0, Z - 1)/9")}}, {"tau", Formulas{1.0}}};
  const auto partly = build_model(scene(here_and_there).record(language), listener, 1);
  EXPECT_EQ(partly.model.regions[0].prony_at(0, {0, 0, 0.5}).g[0], 0);  // no relaxation there
  EXPECT_THAT(message(language, scene({{"g", Formulas{Formula("Z"), 0.2}}, {"tau", Formulas{1.0, 1.0}}})),
              HasSubstr("g = "));
  EXPECT_THAT(message(language, scene({{"g", Formulas{Formula("Z/2"), 0.2}}, {"tau", Formulas{1.0, 1.0}}})),
              testing::AllOf(HasSubstr("is not < 1, in element "), HasSubstr(" at (")));
  EXPECT_THAT(message(language, scene({{"g", Formulas{Formula("t")}}, {"tau", Formulas{1.0}}})),
              HasSubstr("depends on t"));
}

TEST(Prony, SaysHowTimePassesInStaticsAndWarnsOfLongSteps) {
  const Language language;
  Scene scene = bar(language, "linearElasticMaterial", {{"youngModulus", 1.0}, {"poissonRatio", 0.25}});
  scene.regions[0].children.push_back(
      language.tag("prony", "prony", {{"g", std::vector<double>{0.3}}, {"tau", std::vector<double>{0.2}}}));
  scene.steps = {
      language.tag("step", "step", {{"dt", 0.1}, {"iterations", Integer{10}}, {"gravity", Numbers{0, 0, 0}}})};
  Listener one, ten;
  build_model(scene.record(language), one, 1);
  ASSERT_EQ(one.warnings.size(), 1u);
  EXPECT_THAT(one.warnings[0], HasSubstr("its time steps of 1 are longer than the shortest tau of prony, 0.2"));
  scene.solver["loadSteps"] = Integer{10};
  build_model(scene.record(language), ten, 1);
  EXPECT_TRUE(ten.warnings.empty());
  EXPECT_THAT(ten.notes, testing::Contains("step 'step1': prony relaxes over dt * iterations = 1, in which the loads "
                                           "grow in 10 parts of 0.1"));
}

}  // namespace
}  // namespace msml::test
