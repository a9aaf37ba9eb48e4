// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes as records, made by hand.
#include "tests/operators/simulate_scene.hpp"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <fstream>
#include <sstream>
#include <stdexcept>

namespace msml::operators {
void add_scene_descriptions(Registry& registry);
Operator simulate();
}  // namespace msml::operators

namespace msml::test {
namespace {

void add(Registry& registry, Description description) {
  registry.add(std::make_shared<const Description>(std::move(description)));
}

std::size_t at(const Description& description, const std::string& name) {
  const int slot = description.find(name);
  if (slot < 0) throw std::logic_error(description.tag() + " has no " + name);
  return static_cast<std::size_t>(slot);
}

}  // namespace

Language::Language() {
  operators::add_scene_descriptions(registry_);
  Description region("region", "region", "");
  region.input<IndexSet>("indices", "");
  add(registry_, std::move(region));
  Description constraint("constraint", "constraint-group", "");
  constraint.parameter<std::string>("forStep", {.optional = true});
  add(registry_, std::move(constraint));
  add(registry_, Description("object", "object", ""));
  add(registry_, Description("mesh", "meshes", ""));
  add(registry_, Description("material", "materials", ""));
  add(registry_, Description("constraints", "constraints", ""));
  add(registry_, Description("output", "outputs", ""));
  add(registry_, Description("simulation", "simulation", ""));
  add(registry_, Description("Simulate", "simulate", ""));
}

Record Language::tag(const std::string& name, const std::string& category, const Attributes& attributes,
                     std::vector<Record> children) const {
  const Description* description = registry_.find(name, {category});
  if (description == nullptr) throw std::logic_error("no tag " + name + " in " + category);
  Record record{.description = description, .where = {"scene.xml", 7}, .children = std::move(children)};
  for (const Slot& slot : description->slots()) record.values.push_back(slot.fallback);
  record.given.assign(record.values.size(), false);
  for (const auto& [attribute, value] : attributes) {
    const Type wanted = description->slots()[at(*description, attribute)].type;
    record.values[at(*description, attribute)] = converts(type(value), wanted) ? convert(value, wanted) : value;
    record.given[at(*description, attribute)] = true;
    if (attribute == "id" || attribute == "name") record.id = std::get<std::string>(value);
  }
  return record;
}

Mesh box(int n, int m, int k, double h) {
  Mesh mesh;
  mesh.points.resize((n + 1) * (m + 1) * (k + 1), 3);
  const auto id = [&](int i, int j, int l) { return i + (n + 1) * (j + (m + 1) * l); };
  for (int l = 0; l <= k; ++l)
    for (int j = 0; j <= m; ++j)
      for (int i = 0; i <= n; ++i) mesh.points.row(id(i, j, l)) = h * Eigen::RowVector3d(i, j, l);
  // Six paths from corner (0 0 0) to (1 1 1) of a cube, one axis at a time; odd orders of the axes are turned round.
  constexpr int orders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1}, {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
  for (int l = 0; l < k; ++l)
    for (int j = 0; j < m; ++j)
      for (int i = 0; i < n; ++i)
        for (int o = 0; o < 6; ++o) {
          int corner[3] = {i, j, l}, nodes[4] = {id(i, j, l), 0, 0, 0};
          for (int s = 0; s < 3; ++s) {
            ++corner[orders[o][s]];
            nodes[s + 1] = id(corner[0], corner[1], corner[2]);
          }
          if (o >= 3) std::swap(nodes[1], nodes[2]);
          mesh.add_cell(CellKind::tet4, nodes);
        }
  return mesh;
}

IndexSetPtr index_set(const MeshPtr& mesh, Indexed kind, std::vector<int> ids) {
  return std::make_shared<const IndexSet>(IndexSet{kind, std::move(ids), mesh});
}

IndexSetPtr points_at(const MeshPtr& mesh, int axis, double value) {
  std::vector<int> ids;
  for (int i = 0; i < mesh->point_count(); ++i)
    if (std::abs(mesh->points(i, axis) - value) < 1e-9) ids.push_back(i);
  return index_set(mesh, Indexed::nodes, std::move(ids));
}

Record region(const Language& language, const std::string& id, const IndexSetPtr& indices, double young, double poisson,
              const std::string& strain) {
  Record record = language.tag("region", "region", {{"indices", indices}},
                               {language.tag("linearElasticMaterial", "material",
                                             {{"youngModulus", young}, {"poissonRatio", poisson}, {"strain", strain}}),
                                language.tag("mass", "mass", {{"massDensity", 2.0}})});
  record.id = id;
  return record;
}

Record condition(const Language& language, const std::string& tag, const Attributes& attributes,
                 const std::string& for_step) {
  Attributes group;
  if (!for_step.empty()) group["forStep"] = for_step;
  return language.tag("constraint", "constraint-group", group, {language.tag(tag, "constraint", attributes)});
}

Record Scene::record(const Language& language) const {
  Record object = language.tag(
      "object", "object", {},
      {language.tag("mesh", "meshes", {}, {mesh_tag ? *mesh_tag : language.tag(mesh_kind, "mesh", {{"mesh", mesh}})}),
       language.tag("material", "materials", {}, regions), language.tag("constraints", "constraints", {}, constraints),
       language.tag("output", "outputs", {}, outputs)});
  object.id = "cube";
  return language.tag(
      "Simulate", "simulate", {},
      {object, language.tag("solver", "solver", solver), language.tag("simulation", "simulation", {}, steps)});
}

Scene cube(const Language& language) {
  Scene scene;
  scene.mesh = std::make_shared<const Mesh>(box(2, 2, 2, 0.5));
  std::vector<int> all(static_cast<std::size_t>(scene.mesh->cell_count()));
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  scene.regions = {region(language, "tissue", index_set(scene.mesh, Indexed::elements, all))};
  scene.steps = {
      language.tag("step", "step", {{"name", std::string("initial")}, {"gravity", std::vector<double>{0, 0, 0}}})};
  return scene;
}

Scene pulled(const Language& language, const Record& output) {
  Scene scene = cube(language);
  std::vector<int> all(static_cast<std::size_t>(scene.mesh->cell_count()));
  for (std::size_t i = 0; i < all.size(); ++i) all[i] = static_cast<int>(i);
  scene.regions = {region(language, "a", index_set(scene.mesh, Indexed::elements, all), 1000, 0.3, "small")};
  for (int k = 0; k < 3; ++k) {
    Numbers normal{0, 0, 0};
    normal[static_cast<std::size_t>(k)] = 1;
    scene.constraints.push_back(
        condition(language, "symmetryPlane", {{"indices", points_at(scene.mesh, k, 0)}, {"normal", normal}}));
  }
  scene.constraints.push_back(condition(language, "surfaceTraction",
                                        {{"indices", points_at(scene.mesh, 2, 1)}, {"traction", Numbers{0, 0, 10}}}));
  scene.solver["loadSteps"] = Integer{2};
  scene.outputs = {output};
  return scene;
}

std::string written(const Language& language, const Scene& scene, const std::string& file) {
  const Folder folder;
  Listener listener;
  const Record record = scene.record(language);
  Context context(record, listener, folder.path(), 1);
  operators::simulate()(context);
  return folder.text(file);
}

std::vector<Numbers> csv_rows(const std::string& csv) {
  std::istringstream lines(csv);
  std::string line;
  std::getline(lines, line);
  std::vector<Numbers> all;
  while (std::getline(lines, line)) {
    std::replace(line.begin(), line.end(), ',', ' ');
    std::istringstream words(line);
    all.emplace_back();
    for (double x; words >> x;) all.back().push_back(x);
  }
  return all;
}

std::string first_line(const std::string& csv) { return csv.substr(0, csv.find('\n')); }

Folder::Folder() {
  static std::atomic<int> count{0};
  path_ = std::filesystem::temp_directory_path() /
          ("msml_simulate_" + std::to_string(::getpid()) + "_" + std::to_string(count++));
  std::filesystem::create_directories(path_);
}

Folder::~Folder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string Folder::text(const std::string& file) const {
  std::ifstream in(path_ / file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

std::vector<std::string> Folder::files() const {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(path_))
    names.push_back(entry.path().filename().string());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace msml::test
