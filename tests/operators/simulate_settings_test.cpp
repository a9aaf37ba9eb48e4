// SPDX-License-Identifier: GPL-3.0-or-later
// The tags solver, step, displacement and result; and what the language refuses for now.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "operators/simulate/build_model.hpp"
#include "tests/operators/simulate_scene.hpp"

namespace msml::test {
namespace {

using simulation::build_model;
using testing::ElementsAre;
using testing::IsEmpty;

fe::Settings settings(const Attributes& attributes, Listener& listener, int threads = 2) {
  const Language language;
  Scene scene = cube(language);
  scene.solver = attributes;
  return build_model(scene.record(language), listener, threads).model.settings;
}

std::string message(const Scene& scene, const Language& language) {
  Listener listener;
  try {
    build_model(scene.record(language), listener, 1);
  } catch (const Error& error) {
    return error.str();
  }
  return "no error";
}

TEST(Solver, DefaultsAreImplicitEulerWithTheProgramsThreads) {
  Listener listener;
  const auto made = settings({}, listener);
  EXPECT_EQ(made.integrator, fe::Integrator::implicit_euler);
  EXPECT_EQ(made.linear_solver, fe::LinearSolver::automatic);
  EXPECT_EQ(made.threads, 2);
  EXPECT_FALSE(made.lumped_mass);
}

TEST(Solver, AttributesReachTheModel) {
  Listener listener;
  const auto made = settings({{"timeIntegration", std::string("static")},
                              {"linearSolver", std::string("direct")},
                              {"preconditioner", std::string("blockJacobi")},
                              {"dampingRayleighRatioMass", 0.2},
                              {"dampingRayleighRatioStiffness", 0.4},
                              {"mass", std::string("lumped")},
                              {"newtonIterations", Integer{7}},
                              {"tolerance", 1e-5},
                              {"linearTolerance", 1e-6},
                              {"lineSearch", false},
                              {"loadSteps", Integer{3}},
                              {"adaptiveStep", true},
                              {"stepTolerance", 0.01},
                              {"arcLength", true},
                              {"arcSteps", Integer{9}},
                              {"largestLoadFactor", 2.0},
                              {"largestDisplacement", 3.0},
                              {"allowInverted", true},
                              {"definiteness", std::string("always")},
                              {"beta", 0.3},
                              {"gamma", 0.6},
                              {"spectralRadius", 0.5},
                              {"allowUnstable", true},
                              {"threads", Integer{4}}},
                             listener);
  EXPECT_EQ(made.integrator, fe::Integrator::static_);
  EXPECT_EQ(made.linear_solver, fe::LinearSolver::direct);
  EXPECT_EQ(made.preconditioner, fe::Preconditioner::block_jacobi);
  EXPECT_EQ(made.damping_mass, 0.2);
  EXPECT_EQ(made.damping_stiffness, 0.4);
  EXPECT_TRUE(made.lumped_mass);
  EXPECT_EQ(made.newton_iterations, 7);
  EXPECT_EQ(made.tolerance, 1e-5);
  EXPECT_EQ(made.linear_tolerance, 1e-6);
  EXPECT_FALSE(made.line_search);
  EXPECT_EQ(made.load_steps, 3);
  EXPECT_TRUE(made.adaptive_step);
  EXPECT_EQ(made.step_tolerance, 0.01);
  EXPECT_TRUE(made.arc_length.on);
  EXPECT_EQ(made.arc_length.steps, 9);
  EXPECT_EQ(made.arc_length.load, 2);
  EXPECT_EQ(made.arc_length.displacement, 3);
  EXPECT_TRUE(made.allow_inverted);
  EXPECT_EQ(made.definiteness, fe::Definiteness::always);
  EXPECT_EQ(made.newmark_beta, 0.3);
  EXPECT_EQ(made.newmark_gamma, 0.6);
  EXPECT_EQ(made.spectral_radius, 0.5);
  EXPECT_TRUE(made.allow_unstable);
  EXPECT_EQ(made.threads, 4);
}

TEST(Solver, EveryIntegratorHasItsName) {
  for (const char* integration : {"static", "quasiStatic", "dynamicImplicitEuler", "Newmark", "generalizedAlpha",
                                  "forwardEuler", "symplecticEuler", "centralDifference"}) {
    Listener listener;
    const auto made = settings({{"timeIntegration", std::string(integration)}}, listener);
    EXPECT_STREQ(fe::name(made.integrator), integration);
  }
}

TEST(Solver, OldNamesAreAcceptedWithANoteEach) {
  Listener listener;
  const auto made = settings({{"timeIntegration", std::string("NewmarkShapeMatching")},
                              {"linearSolver", std::string("GMRES")},
                              {"preconditioner", std::string("SGAUSS_SEIDEL")},
                              {"processingUnit", std::string("GPU")},
                              {"numParallelProcessesOnCPU", Integer{4}}},
                             listener);
  EXPECT_EQ(made.integrator, fe::Integrator::newmark);
  EXPECT_EQ(made.linear_solver, fe::LinearSolver::cg);
  EXPECT_EQ(made.preconditioner, fe::Preconditioner::automatic);
  EXPECT_EQ(made.threads, 4);
  EXPECT_THAT(listener.notes,
              ElementsAre("solver: processingUnit GPU is not there; the CPU is used",
                          "solver: GMRES is taken as CG, since the matrices are symmetric",
                          "solver: NewmarkShapeMatching is taken as Newmark",
                          "solver: preconditioner SGAUSS_SEIDEL belongs to another program; taken as auto"));
}

TEST(Step, DefaultsAreThoseOfMsml) {
  const Language language;
  Listener listener;
  Scene scene = cube(language);
  scene.steps = {language.tag("step", "step")};
  const auto model = build_model(scene.record(language), listener, 1).model;
  EXPECT_EQ(model.steps[0].name, "step1");
  EXPECT_EQ(model.steps[0].dt, 0.05);
  EXPECT_EQ(model.steps[0].count, 100);
  EXPECT_EQ(model.steps[0].gravity, Vec3(0, 0, -9.81));
  EXPECT_THAT(listener.notes, ElementsAre("line 7: step: no gravity given, so it is (0, 0, -9.81) as in MSML"));
}

TEST(Displacement, TimestepAndEverySayWhichStates) {
  const Language language;
  Listener listener;
  Scene scene = cube(language);
  const std::string tag = "displacement";
  scene.outputs = {
      language.tag(tag, "output", {{"id", std::string("a")}}),
      language.tag(tag, "output", {{"id", std::string("b")}, {"timestep", Integer{0}}}),
      language.tag(tag, "output", {{"id", std::string("c")}, {"timestep", Integer{5}}}),
      language.tag(tag, "output", {{"id", std::string("d")}, {"timestep", Integer{5}}, {"every", Integer{2}}})};
  std::vector<int> every;
  for (const auto& output : build_model(scene.record(language), listener, 1).outputs) every.push_back(output.every);
  EXPECT_THAT(every, ElementsAre(1, 1, 5, 2));
}

TEST(Result, FieldsAreAListThatAlwaysHoldsTheDisplacement) {
  const Language language;
  Listener listener;
  Scene scene = cube(language);
  scene.outputs = {
      language.tag("result", "output", {{"id", std::string("a")}, {"fields", std::string("vonMises, J vonMises")}})};
  EXPECT_THAT(build_model(scene.record(language), listener, 1).outputs[0].fields,
              ElementsAre("displacement", "vonMises", "J"));
}

TEST(Result, AnIdThatIsNoFileNameIsRefused) {
  const Language language;
  Scene scene = cube(language);
  for (const std::string id : {"", "..", "a/b"}) {
    scene.outputs = {language.tag("result", "output", {{"id", id}})};
    EXPECT_EQ(message(scene, language), "scene.xml:7: result: id = '" + id + "' cannot start a file name");
  }
}

TEST(FutureTags, AreKnownAndRefusedWithWhatToUseInstead) {
  const Language language;
  for (const char* tag : {"shapeMatchingConstraint", "contactsurface"}) {
    const Description* description = language.registry().find(tag, {"constraint"});
    ASSERT_NE(description, nullptr) << tag;
    EXPECT_FALSE(description->unavailable().empty()) << tag;
  }
  EXPECT_GE(language.registry().find("springMeshToFixed", {"constraint"})->find("rayleighStiffnes"), 0);
  EXPECT_NE(language.registry().find("neoHookeanMaterial", {"material"}), nullptr);
}

TEST(Outputs, ProduceASeriesOrAFile) {
  const Language language;
  for (const char* tag : {"displacement", "result"})
    EXPECT_EQ(language.registry().find(tag, {"output"})->produces(), Type::series);
  for (const char* tag : {"probe", "energies"})
    EXPECT_EQ(language.registry().find(tag, {"output"})->produces(), Type::file);
}

}  // namespace
}  // namespace msml::test
