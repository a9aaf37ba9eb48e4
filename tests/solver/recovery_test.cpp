// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies that start from impossible shapes: they return to rest, or the trap they fall into is named.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>

#include "tests/solver/law_by_name.hpp"
#include "tests/solver/meshes.hpp"

namespace msml::fe {
namespace {

using namespace testing;
using ::testing::HasSubstr;

/// A bar 3 x 1 x 1 of a law that survives inversion, displaced from X to place(X), without loads, and without another
/// law's help.
Model bar(const std::string& form, const std::function<Vec3(const Vec3&)>& place) {
  Model model = make_model(box_mesh(6, 2, 2, {3, 1, 1}, CellKind::tet4), {});
  model.regions[0].law = neo_hookean(form, 1000, 0.3);
  model.settings.newton_iterations = 200;
  model.settings.untangle = false;
  model.initial_displacement.resize(model.mesh->point_count(), 3);
  for (int n = 0; n < model.mesh->point_count(); ++n) {
    const Vec3 X = model.mesh->points.row(n).transpose();
    model.initial_displacement.row(n) = (place(X) - X).transpose();
  }
  return model;
}

void expect_rest(const Model& model, const std::string& what) {
  const Outcome outcome = solve(model, {});
  EXPECT_EQ(outcome.stop, Stop::converged) << what << ": " << outcome.diagnosis;
  const double off = outcome.state.displacement.rowwise().norm().maxCoeff() / 3;
  EXPECT_LT(off, 1e-6) << what;
  EXPECT_LE(outcome.newton_iterations, 200) << what;
  std::cout << what << ": " << outcome.newton_iterations << " iterations, off by " << off << "\n";
}

const char* const forms[] = {"cubic", "stable"};

TEST(Recovery, FromEveryVertexAtARandomPlaceWithTheStableLaw) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> place(-1, 2);
  expect_rest(bar("stable", [&](const Vec3&) { return Vec3(place(engine), place(engine), place(engine)); }),
              "random, stable");
}

TEST(Recovery, FromAMirrorImageWithOneFaceHeld) {
  for (const char* form : forms) {
    Model model = bar(form, [](const Vec3& X) { return Vec3(-X[0], X[1], X[2]); });
    model.steps[0].prescribed = {fix(points_where(*model.mesh, [](const Vec3& x) { return x[0] < 1e-9; }))};
    expect_rest(model, std::string("mirrored, ") + form);
  }
}

TEST(Recovery, FromAFlatBar) {
  for (const char* form : forms)
    expect_rest(bar(form, [](const Vec3& X) { return Vec3(0.05 * X[0], X[1], X[2]); }), std::string("flat, ") + form);
}

TEST(Recovery, FromAFullTwist) {
  for (const char* form : forms)
    expect_rest(bar(form,
                    [](const Vec3& X) {
                      const double a = 2 * M_PI * X[0] / 3, y = X[1] - 0.5, z = X[2] - 0.5;
                      return Vec3(X[0], 0.5 + std::cos(a) * y - std::sin(a) * z,
                                  0.5 + std::sin(a) * y + std::cos(a) * z);
                    }),
                std::string("twisted, ") + form);
}

TEST(Recovery, EveryVertexAtOnePointReturnsWithTheStableLaw) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> shake(-1e-3, 1e-3);
  expect_rest(bar("stable", [&](const Vec3&) { return Vec3(shake(engine), shake(engine), shake(engine)); }),
              "one point, stable");
}

// F = 0 is a strict local minimum of the cubic law.
TEST(Recovery, ACollapsedEquilibriumIsNamed) {
  std::mt19937 engine(5);
  std::uniform_real_distribution<double> shake(-1e-3, 1e-3);
  const Outcome point =
      solve(bar("cubic", [&](const Vec3&) { return Vec3(shake(engine), shake(engine), shake(engine)); }), {});
  EXPECT_EQ(point.stop, Stop::collapsed) << name(point.stop) << point.diagnosis;
  EXPECT_THAT(point.diagnosis, HasSubstr("worst element"));
  EXPECT_THAT(point.diagnosis, HasSubstr("form=\"stable\""));
}

// A time step so long that full Newton steps blow the body up: the line search leads it home.
TEST(Recovery, FromAFullTwistInOneLongTimeStepAfterTheOther) {
  for (const char* form : forms) {
    Model model = bar(form, [](const Vec3& X) {
      const double a = 2 * M_PI * X[0] / 3, y = X[1] - 0.5, z = X[2] - 0.5;
      return Vec3(X[0], 0.5 + std::cos(a) * y - std::sin(a) * z, 0.5 + std::sin(a) * y + std::cos(a) * z);
    });
    model.steps[0].prescribed = {fix(points_where(*model.mesh, [](const Vec3& x) { return x[0] < 1e-9; }))};
    model.settings.integrator = Integrator::implicit_euler;
    model.steps[0].dt = 0.5;
    model.steps[0].count = 40;
    model.steps[0].gravity = Vec3::Zero();
    const Outcome outcome = solve(model, {});
    EXPECT_EQ(outcome.stop, Stop::converged) << form << ": " << outcome.diagnosis;
    EXPECT_LT(outcome.state.displacement.rowwise().norm().maxCoeff() / 3, 1e-6) << form;
  }
}

TEST(Recovery, ARestInAnotherShapeIsWarnedOf) {
  const auto warned = [](const Outcome& outcome) {
    return std::any_of(outcome.warnings.begin(), outcome.warnings.end(),
                       [](const std::string& text) { return text.find("another equilibrium") != std::string::npos; });
  };
  int tangled = 0;
  for (unsigned seed = 1; seed <= 5; ++seed) {
    std::mt19937 engine(seed);
    std::uniform_real_distribution<double> place(-1, 2);
    const Outcome outcome =
        solve(bar("cubic", [&](const Vec3&) { return Vec3(place(engine), place(engine), place(engine)); }), {});
    if (outcome.stop != Stop::converged) continue;
    const bool off = outcome.state.displacement.rowwise().norm().maxCoeff() > 0.1;
    EXPECT_EQ(warned(outcome), off);
    tangled += off;
  }
  EXPECT_GT(tangled, 0);
}

std::function<Vec3(const Vec3&)> anywhere(unsigned seed) {
  return [engine = std::mt19937(seed)](const Vec3&) mutable {
    std::uniform_real_distribution<double> place(-1, 2);
    const double x = place(engine), y = place(engine), z = place(engine);
    return Vec3(x, y, z);
  };
}

TEST(Untangling, BringsTheCubicLawHomeFromRandomPlaces) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    Model model = bar("cubic", anywhere(seed));
    model.settings.untangle = true;
    expect_rest(model, "untangled, seed " + std::to_string(seed));
  }
}

TEST(Untangling, LeadsOutOfOnePointWhereTheLawAloneStays) {
  Model model = bar("cubic", [](const Vec3& X) { return Vec3(1e-3 * X); });
  model.settings.untangle = true;
  expect_rest(model, "one point, cubic, untangled");
}

// The stable law finds the way, and the model's own law the answer.
TEST(Untangling, EndsInTheEquilibriumOfTheOwnLaw) {
  const auto sagging = [](const std::function<Vec3(const Vec3&)>& place, const std::string& form, bool untangle) {
    Model model = bar(form, place);
    model.settings.untangle = untangle;
    model.steps[0].prescribed = {fix(points_where(*model.mesh, [](const Vec3& x) { return x[0] < 1e-9; }))};
    model.steps[0].gravity = Vec3(0, 0, -8);
    return solve(model, {});
  };
  const auto reference = [](const Vec3& X) { return X; };
  const Outcome plain = sagging(reference, "cubic", false), untangled = sagging(anywhere(2), "cubic", true);
  ASSERT_EQ(plain.stop, Stop::converged);
  ASSERT_EQ(untangled.stop, Stop::converged) << untangled.diagnosis;
  const double size = plain.state.displacement.cwiseAbs().maxCoeff();
  EXPECT_LT((untangled.state.displacement - plain.state.displacement).cwiseAbs().maxCoeff(), 1e-6 * size);
  const Outcome stable = sagging(reference, "stable", false);
  EXPECT_GT((stable.state.displacement - plain.state.displacement).cwiseAbs().maxCoeff(), 1e-3 * size);
  EXPECT_THAT(untangled.notes, Contains(HasSubstr("inside out")));
  EXPECT_THAT(plain.notes, Not(Contains(HasSubstr("inside out"))));
}

}  // namespace
}  // namespace msml::fe
