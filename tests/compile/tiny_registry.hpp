// SPDX-License-Identifier: GPL-3.0-or-later
// A small language with every type of slot, for exact tests of the compiler and the runner.
#pragma once
#include <fstream>
#include <memory>

#include "msml/compile/grammar.hpp"
#include "msml/core/registry.hpp"

namespace msml::tiny {

/// One tetrahedron.
inline Mesh one_tet() {
  Mesh mesh;
  mesh.points.resize(4, 3);
  mesh.points << 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1;
  const int ids[4] = {0, 1, 2, 3};
  mesh.add_cell(CellKind::tet4, ids);
  return mesh;
}

/// One triangle.
inline Surface one_triangle() {
  Surface surface;
  surface.points.resize(3, 3);
  surface.points << 0, 0, 0, 1, 0, 0, 0, 1, 0;
  surface.triangles.push_back({0, 1, 2});
  return surface;
}

inline std::string no_fives(const Value& value) {
  for (const double x : std::get<std::vector<double>>(value))
    if (x == 5) return "5 does not belong there";
  return {};
}

/// A surface from nothing: settings of every kind of number and text.
inline Operator make_surface() {
  Operator op("MakeSurface", "Make a triangle.");
  op.parameter("radius", {.unit = "length", .range = positive(), .fallback = 1.0, .doc = "its size"});
  op.parameter("angle", {.unit = "degree", .range = closed(0, 30), .fallback = 25.0, .doc = "its angle"});
  op.parameter("share", {.range = half_open(0, 1), .fallback = 0.5, .doc = "its share"});
  op.parameter<Integer>("count", {.range = closed(1, 100), .fallback = 8, .doc = "how many"});
  op.parameter<bool>("smooth", {.fallback = false, .doc = "smooth it"});
  op.parameter<std::string>("method", {.fallback = "fast", .choices = {"fast", "exact"}, .doc = "how"});
  op.parameter<std::string>("label", {.optional = true, .doc = "any words"});
  op.parameter<std::vector<double>>("centers", {.optional = true, .multiple_of = 3, .doc = "points"});
  op.parameter<std::vector<Integer>>("ids", {.optional = true, .doc = "whole numbers"});
  op.parameter<Formula>("height", {.range = positive(), .optional = true, .doc = "above the plane"});
  op.parameter<Formulas>("normal", {.optional = true, .counts = {3}, .doc = "which way it looks"});
  op.parameter<Formulas>("weights", {.optional = true, .doc = "one or more"});
  op.parameter<Words>("sides", {.optional = true, .choices = {"left", "right"}, .doc = "which are closed"});
  op.parameter<std::vector<double>>("table", {.optional = true, .check = no_fives, .doc = "no fives"});
  const auto surface = op.output<Surface>("surface", "the triangle");
  op.target("file", surface, "where it is written");
  op.run([=](Context& c) { c.set(surface, one_triangle()); });
  return op;
}

inline Operator fill() {
  Operator op("Fill", "Fill a closed surface.");
  const auto surface = op.input<Surface>("surfaceMesh", "what is filled");
  const auto size = op.parameter("cellSize", {.unit = "length", .range = positive(), .doc = "size of the cells"});
  const auto mesh = op.output<Mesh>("mesh", "the tetrahedra");
  const auto cells = op.output<Integer>("cells", "how many");
  op.target("meshFilename", mesh, "where the mesh is written");
  op.run([=](Context& c) {
    if (c.get(surface).triangle_count() == 0 || c.get(size) > 100)
      throw Error("the surface is open: 12 edges are free");
    c.set(mesh, one_tet());
    c.set(cells, Integer{1});
  });
  return op;
}

inline Operator skin() {
  Operator op("Skin", "The surface of a mesh.");
  const auto mesh = op.input<Mesh>("mesh", "what is skinned");
  const auto surface = op.output<Surface>("surface", "its skin");
  op.target("file", surface, "where it is written");
  op.run([=](Context& c) {
    if (c.get(mesh).point_count() > 0) c.set(surface, one_triangle());
  });
  return op;
}

inline Operator pick() {
  Operator op("Pick", "Choose what lies in a box.");
  op.input<Mesh>("mesh", "where to look");
  op.parameter<std::vector<double>>("box", {.counts = {6}, .doc = "two corners"});
  op.parameter<std::string>("select", {.choices = {"points", "elements"}, .doc = "what is chosen"});
  const auto indices = op.output<IndexSet>("indices", "what was found");
  op.run([=](Context& c) { c.set(indices, IndexSet{.ids = {0, 1}}); });
  return op;
}

inline Operator paint() {
  Operator op("Paint", "A field by index and its mean.");
  op.input<IndexSet>("where", "which nodes");
  op.input<Field>("field", "values so far", true);
  const auto field = op.output<Field>("painted", "the new values");
  const auto mean = op.output<double>("mean", "of the values");
  op.run([=](Context& c) {
    c.set(field, Field{.name = "paint", .components = 1, .values = {0.5}});
    c.set(mean, 0.5);
  });
  return op;
}

inline Operator voxelize() {
  Operator op("Voxelize", "Voxels of a surface.");
  op.input<Surface>("surface", "what is voxelized");
  const auto image = op.output<Image>("image", "the voxels");
  op.target("imageFile", image, "where it is written");
  op.run([=](Context& c) { c.set(image, make_image<std::uint8_t>({1, 2, 3})); });
  return op;
}

inline Operator sum() {
  Operator op("Sum", "The sum of images.");
  const auto images = op.input<ImageList>("image", "one image or a pattern of files");
  const auto total = op.output<Image>("total", "their sum");
  const auto count = op.output<Integer>("count", "how many");
  op.target("totalFile", total, "where it is written");
  op.run([=](Context& c) {
    c.set(total, make_image<std::uint8_t>({1, 2, 3}));
    c.set(count, static_cast<Integer>(c.get(images).size()));
  });
  return op;
}

inline Operator copy() {
  Operator op("Copy", "Hand a file on.");
  const auto from = op.input<File>("from", "the file");
  const auto to = op.output<File>("copy", "the same");
  op.target("to", to, "its new name");
  op.run([=](Context& c) { c.set(to, c.get(from)); });
  return op;
}

inline Operator measure() {
  Operator op("Measure", "Say what a mesh holds.");
  const auto mesh = op.input<Mesh>("mesh", "what is measured");
  const auto volume = op.output<double>("volume", "its volume");
  op.reports();
  op.run([=](Context& c) {
    c.reporter().print("cells: " + std::to_string(c.get(mesh).cell_count()));
    c.set(volume, 1.0 / 6);
  });
  return op;
}

inline Operator later() {
  Operator op("Later", "Not there.");
  op.not_available_yet("use Fill");
  op.output<Mesh>("mesh", "nothing");
  return op;
}

inline void add_tag(Registry& registry, Description description) {
  registry.add(std::make_shared<const Description>(std::move(description)));
}

inline void add_scene_tags(Registry& registry) {
  for (const char* tag : {"linearTet", "quadraticTet"}) {
    Description mesh(tag, "mesh", "A mesh of tetrahedra.");
    mesh.input<Mesh>("mesh", "the mesh");
    add_tag(registry, mesh);
  }
  Description material("softMaterial", "material", "A law.");
  material.parameter("youngModulus", {.unit = "stress", .range = positive(), .doc = "stiffness"});
  material.parameter("poissonRatio", {.range = open(-1, 0.5), .fallback = 0.3, .doc = "sideways"});
  add_tag(registry, material);
  Description mass("mass", "mass", "A density.");
  mass.parameter("massDensity", {.range = positive(), .fallback = 1.0, .doc = "per volume"});
  add_tag(registry, mass);
  Description hold("hold", "constraint", "Nodes that stay.");
  hold.input<IndexSet>("indices", "which nodes");
  hold.parameter<std::string>("forStep", {.optional = true, .doc = "when"});
  add_tag(registry, hold);
  Description springs("springs", "constraint", "Springs.");
  springs.not_available_yet("hold nodes with hold");
  add_tag(registry, springs);
  Description states("states", "output", "The states.");
  states.parameter<std::string>("id", {.doc = "start of the file names"});
  states.parameter<Integer>("every", {.range = closed(1, 1e9), .fallback = 1, .doc = "which states"});
  states.produces(Type::series);
  add_tag(registry, states);
  Description solver("solver", "solver", "How.");
  solver.parameter("tolerance", {.range = open(0, 1), .fallback = 1e-6, .doc = "when to stop"});
  add_tag(registry, solver);
  Description step("step", "step", "A stage.");
  step.parameter<std::string>("name", {.optional = true, .doc = "what forStep refers to"});
  step.parameter("dt", {.range = positive(), .fallback = 0.05, .doc = "time step"});
  add_tag(registry, step);
}

/// Three states on disk for each output request.
inline Operator simulate() {
  Operator op("Simulate", "Computes an object.");
  for (const char* category : {"object", "solver", "simulation"}) op.allow({category, 1, 1});
  op.run([](Context& c) {
    int slot = 0;
    std::filesystem::create_directories(c.output_folder());
    for (const Record& child : c.args().children)
      for (const Record* output : child.of_category("outputs"))
        for (const Record& request : output->children) {
          auto series = std::make_shared<Series>();
          series->folder = c.output_folder();
          for (int i = 0; i < 3; ++i) {
            series->files.push_back(c.output_folder() / (request.id + "_000" + std::to_string(i) + ".tet"));
            series->times.push_back(i);
            std::ofstream(series->files.back()) << "tet";
          }
          series->last = std::make_shared<const Mesh>(one_tet());
          c.set(slot++, Value{SeriesPtr(series)});
        }
  });
  return op;
}

inline void write_word(const std::filesystem::path& path, const std::string& word) {
  std::ofstream out(path);
  out << word;
  if (!out) throw Error("cannot write " + path.string());
}

inline void add_formats(Registry& registry) {
  registry.add(Format{.extensions = {".tet"},
                      .doc = "a mesh",
                      .reads = {Type::mesh},
                      .writes = {Type::mesh},
                      .read = [](const auto&, Type) { return Value{std::make_shared<const Mesh>(one_tet())}; },
                      .write = [](const Value&, const auto& path, const auto&) { write_word(path, "tet"); }});
  registry.add(Format{.extensions = {".tri"},
                      .doc = "a surface",
                      .reads = {Type::surface},
                      .writes = {Type::surface},
                      .read = [](const auto&, Type) { return Value{std::make_shared<const Surface>(one_triangle())}; },
                      .write = [](const Value&, const auto& path, const auto&) { write_word(path, "tri"); }});
  registry.add(Format{.extensions = {".img", ".img.gz"},
                      .doc = "an image",
                      .reads = {Type::image},
                      .writes = {Type::image},
                      .read =
                          [](const auto&, Type) {
                            return Value{std::make_shared<const Image>(make_image<std::uint8_t>({1, 2, 3}))};
                          },
                      .write = [](const Value&, const auto& path, const auto&) { write_word(path, "img"); }});
}

/// The whole small language.
inline Registry registry() {
  Registry all;
  add_grammar(all);
  add_scene_tags(all);
  for (const auto& make : {make_surface, fill, skin, pick, paint, voxelize, sum, copy, measure, later, simulate})
    all.add(make());
  add_formats(all);
  return all;
}

}  // namespace msml::tiny
