// SPDX-License-Identifier: GPL-3.0-or-later
// A mesh goes along the edges of the graph without being copied.
#include <gtest/gtest.h>

#include <map>

#include "msml/run/run.hpp"
#include "tests/commands/real_language.hpp"

namespace msml {
namespace {

struct Silence : Watcher {
  void started(int) override {}
  void progress(int, double, const std::string&) override {}
  void finished(int, const NodeReport&) override {}
  void note(int, const std::string&) override {}
  void warning(int, const std::string&) override {}
  void print(int, const std::string&) override {}
};

/// Keeps what each task gave.
class Keeper : public Shelf {
 public:
  explicit Keeper(const Graph& graph) : graph_(graph) {}
  bool take(int, Shelved&) override { return false; }
  void put(int node, const Shelved& result) override {
    for (const Value& value : result.outputs)
      if (type(value) != Type::nothing) kept_[graph_.nodes.at(static_cast<std::size_t>(node)).id] = value;
  }
  template <class T>
  std::shared_ptr<const T> get(const std::string& id) const {
    return std::get<std::shared_ptr<const T>>(kept_.at(id));
  }

 private:
  const Graph& graph_;
  std::map<std::string, Value> kept_;
};

TEST(SharedBuffers, AMeshThatPassesThroughTwoTasksStaysWhereItIs) {
  const tiny::Folder folder;
  const auto compilation = compile_text(
      tiny::workflow(
          "<GenerateBoxMesh id=\"box\" size=\"1 1 1\" divisions=\"3 3 3\"/>\n"
          "<ConvertVTKToVTU id=\"first\" VTKMesh=\"${box}\"/>\n"
          "<ConvertVTKToVTU id=\"second\" VTKMesh=\"${first}\"/>\n"
          "<ComputeIndicesFromBoxROI id=\"wall\" mesh=\"${second}\" select=\"points\" box=\"0 0 0 0 1 1\"/>\n"
          "<ExtractSurfaceMesh id=\"skin\" mesh=\"${second}\" targetSurfaceMeshFilename=\"skin.stl\"/>\n"
          "<ConvertSTLToVTK id=\"same\" STLMesh=\"${skin}\" targetFilename=\"skin.vtp\"/>"),
      (folder.path() / "s.xml").string(), real_language(),
      {.set = {}, .output_folder = folder.path(), .strict = false});
  ASSERT_EQ(tiny::lines(compilation.faults), "");
  Keeper keeper(compilation.graph);
  Silence silence;
  const RunResult result = run(compilation.graph, make_plan(compilation.graph, {"wall", "same"}), real_language(),
                               {.output_folder = folder.path(), .shelf = &keeper}, silence);
  ASSERT_TRUE(result.errors.empty()) << result.errors.front().str();
  const auto box = keeper.get<Mesh>("box");
  EXPECT_EQ(keeper.get<Mesh>("first").get(), box.get());
  EXPECT_EQ(keeper.get<Mesh>("second").get(), box.get());
  EXPECT_EQ(keeper.get<IndexSet>("wall")->mesh.get(), box.get());
  EXPECT_EQ(keeper.get<Surface>("same").get(), keeper.get<Surface>("skin").get());
}

}  // namespace
}  // namespace msml
