// SPDX-License-Identifier: GPL-3.0-or-later
// The whole language, and the original scenes.
#pragma once
#include <algorithm>

#include "operators/registry.hpp"
#include "tests/compile/scenes.hpp"

namespace msml {

inline const Registry& real_language() {
  static const Registry registry = [] {
    Registry all;
    add_grammar(all);
    add_operators(all);
    return all;
  }();
  return registry;
}

/// Scene files beside the repository, sorted; empty where they are not there.
inline std::vector<std::filesystem::path> original_scenes() {
  namespace fs = std::filesystem;
  const fs::path folder = fs::path(MSML_SOURCE_DIR) / "../shared/scenes";
  std::vector<fs::path> scenes;
  if (!fs::exists(folder)) return scenes;
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.path().extension() == ".xml") scenes.push_back(entry.path());
  std::sort(scenes.begin(), scenes.end());
  return scenes;
}

}  // namespace msml
