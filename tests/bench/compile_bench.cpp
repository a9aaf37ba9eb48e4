// SPDX-License-Identifier: GPL-3.0-or-later
// Time from file to graph, and memory, of generated scenes with many tasks.
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <vector>

#include "msml/compile/compile.hpp"
#include "msml/compile/grammar.hpp"
#include "msml/run/memory.hpp"
#include "operators/registry.hpp"

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

/// Groups of four tasks; each group reads the mesh of the group before it, so that edges are long chains.
std::string scene_of(int tasks) {
  std::string text = "<msml:msml xmlns:msml=\"http://sfb125.de/msml\">\n<workflow>\n";
  for (int i = 0; i < tasks / 4; ++i) {
    text += fmt::format(
        "<GenerateBoxMesh id=\"box{0}\" size=\"1 2 3\" divisions=\"4 5 6\" meshFilename=\"box{0}.vtu\"/>\n", i);
    text += fmt::format(
        "<ComputeIndicesFromBoxROI id=\"set{0}\" mesh=\"${{box{1}}}\" select=\"points\" box=\"0 0 0 1 1 {0}\"/>\n", i,
        std::max(0, i - 1));
    text += fmt::format("<ExtractPointPositions id=\"at{0}\" mesh=\"${{box{1}.mesh}}\" indices=\"${{set{0}}}\"/>\n", i,
                        std::max(0, i - 1));
    text += fmt::format(
        "<ExtractSurfaceMesh id=\"skin{0}\" mesh=\"${{box{0}}}\" targetSurfaceMeshFilename=\"skin{0}.vtp\"/>\n", i);
  }
  return text + "</workflow>\n</msml:msml>\n";
}

/// Median time of `repeats` compilations in milliseconds; refuses a scene with faults.
double median_milliseconds(const fs::path& scene, const msml::Registry& registry, int repeats) {
  std::vector<double> times;
  for (int i = 0; i < repeats; ++i) {
    const auto start = Clock::now();
    const msml::Compilation compilation = msml::compile_file(scene, registry);
    times.push_back(std::chrono::duration<double, std::milli>(Clock::now() - start).count());
    if (!compilation.faults.empty()) throw compilation.faults.front();
  }
  std::nth_element(times.begin(), times.begin() + repeats / 2, times.end());
  return times[static_cast<std::size_t>(repeats) / 2];
}

void print_row(const msml::Registry& registry, int tasks) {
  const fs::path scene = fs::temp_directory_path() / fmt::format("msml_bench_{}.msml.xml", tasks);
  const std::string text = scene_of(tasks);
  std::ofstream(scene) << text;
  msml::reset_peak_memory();
  const std::size_t before = msml::peak_memory();
  const double milliseconds = median_milliseconds(scene, registry, 9);
  fmt::print("{:>6}  {:>8} kB  {:>10.2f} ms  {:>8.1f} us  {:>8.1f} MB\n", tasks, text.size() / 1024, milliseconds,
             1000 * milliseconds / tasks, static_cast<double>(msml::peak_memory() - before) / 1048576);
  fs::remove(scene);
}

}  // namespace

int main() {
  msml::Registry registry;
  msml::add_grammar(registry);
  msml::add_operators(registry);
  fmt::print(" tasks        file  file to graph    per task   memory grown\n");
  try {
    for (const int tasks : {100, 1000, 10000}) print_row(registry, tasks);
  } catch (const msml::Fault& fault) {
    fmt::print(stderr, "{}: {}\n", fault.where.str(), fault.message);
    return 1;
  }
}
