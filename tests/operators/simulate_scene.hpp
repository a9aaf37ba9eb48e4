// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes as records, made by hand: a box of tetrahedra and the tags around it.
#pragma once
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "msml/core/operator.hpp"
#include "msml/core/registry.hpp"

namespace msml::test {

/// Keeps what an operator says.
struct Listener : Reporter {
  std::vector<std::string> notes, warnings, prints, words;
  std::map<std::string, std::string> facts;
  void progress(double, const std::string& text) override { words.push_back(text); }
  void note(const std::string& text) override { notes.push_back(text); }
  void warn(const std::string& text) override { warnings.push_back(text); }
  void print(const std::string& text) override { prints.push_back(text); }
  void record(const std::string& name, const std::string& json) override { facts[name] = json; }
};

using Attributes = std::map<std::string, Value>;

/// Makes records from the descriptions of the language; structural tags are described here as the compiler does.
class Language {
 public:
  Language();
  /// A tag with attributes, all others at their defaults. Throws std::logic_error for names that are not described.
  Record tag(const std::string& name, const std::string& category, const Attributes& attributes = {},
             std::vector<Record> children = {}) const;
  const Registry& registry() const { return registry_; }

 private:
  Registry registry_;
};

/// n x m x k cubes of edge h, each cut into six tetrahedra; point (i j l) is i + (n+1) (j + (m+1) l).
Mesh box(int n, int m, int k, double h = 1);

/// Ids of the points with coordinate `axis` at the value.
IndexSetPtr points_at(const MeshPtr& mesh, int axis, double value);
IndexSetPtr index_set(const MeshPtr& mesh, Indexed kind, std::vector<int> ids);

/// What a scene is made of; change what a test is about.
struct Scene {
  std::string mesh_kind = "linearTet";
  MeshPtr mesh;
  std::optional<Record> mesh_tag = {};  ///< instead of mesh_kind and mesh
  std::vector<Record> regions, constraints, outputs, steps;
  Attributes solver{{"timeIntegration", std::string("static")}, {"linearSolver", std::string("direct")}};
  Record record(const Language& language) const;
};

/// A region with the linear law.
Record region(const Language& language, const std::string& id, const IndexSetPtr& indices, double young = 1000,
              double poisson = 0.3, const std::string& strain = "corotated");
/// A condition inside a <constraint>.
Record condition(const Language& language, const std::string& tag, const Attributes& attributes,
                 const std::string& for_step = "");

/// A cube of 2 x 2 x 2 boxes of edge 1/2, of one region, without conditions, weightless.
Scene cube(const Language& language);

using Numbers = std::vector<double>;

/// The unit cube between rollers, its top pulled with a stress of 10 along z (E = 1000, nu = 0.3, small strain):
/// homogeneous, with the strain 0.01 along z and -0.003 across; in two load steps.
Scene pulled(const Language& language, const Record& output);

/// Runs the scene and gives the text of a file it writes.
std::string written(const Language& language, const Scene& scene, const std::string& file);
/// The line of names of a CSV text, and the numbers below it.
std::string first_line(const std::string& csv);
std::vector<Numbers> csv_rows(const std::string& csv);

/// A folder of its own below the system's folder for temporaries, removed at the end.
class Folder {
 public:
  Folder();
  ~Folder();
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  const std::filesystem::path& path() const { return path_; }
  std::string text(const std::string& file) const;
  std::vector<std::string> files() const;  ///< names, sorted

 private:
  std::filesystem::path path_;
};

}  // namespace msml::test
