// SPDX-License-Identifier: GPL-3.0-or-later
// Literal file names: written by another task, or read from disk.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "msml/compile/literal.hpp"
#include "msml/compile/work.hpp"

namespace msml {
namespace {

namespace fs = std::filesystem;

fs::path beside_scene(const Work& work, const std::string& file) {
  const fs::path path(file);
  return path.is_absolute() ? path : work.document.folder / path;
}

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  std::error_code code;
  for (const auto& entry : fs::directory_iterator(folder.empty() ? "." : folder, code))
    names.push_back(entry.path().filename().string());
  return names;
}

/// A problem with reading `path` as `type`, or "".
std::string reading_problem(const Work& work, const std::string& file, const fs::path& path, Type type) {
  std::error_code code;
  if (file.size() > 4096) return "is too long for a file name";
  if (!fs::exists(path, code)) {
    auto candidates = names_in(path.parent_path());
    for (const auto& [target, written] : work.written) candidates.push_back(target);
    return fmt::format("names no file beside the scene and no task's target{}",
                       did_you_mean(path.filename().string(), candidates));
  }
  if (fs::is_directory(path, code)) return "is a folder, not a file";
  if (type == Type::file) return {};
  const auto endings = work.registry.extensions_for(type, false);
  if (std::find(endings.begin(), endings.end(), work.registry.extension(path)) != endings.end()) return {};
  return fmt::format("cannot be read as {}: such files end in {}", with_article(type), fmt::join(endings, " "));
}

Edge file_edge(Work& work, const fs::path& path, Type type, const std::string& logical, const Location& where) {
  const auto [found, fresh] =
      work.file_nodes.insert({{path.lexically_normal().string(), type}, static_cast<int>(work.out.graph.nodes.size())});
  if (fresh) {
    Node node;
    node.kind = NodeKind::file;
    node.id = path.filename().string();
    node.where = where;
    node.file = path;
    node.file_type = type;
    node.declared = logical;
    work.out.graph.nodes.push_back(std::move(node));
  }
  return {found->second, 0};
}

Source resolve_one(Work& work, const Binding& user, const Slot& slot, const std::string& file,
                   const std::string& logical, const Location& where) {
  if (const auto found = work.written.find(same_file(file)); found != work.written.end())
    return connect(work, user, slot, found->second.edge, where, file);
  const fs::path path = beside_scene(work, file);
  const Type type = slot.type == Type::images ? Type::image : slot.type;
  if (const std::string problem = reading_problem(work, file, path, type); !problem.empty()) {
    work.fault(where, fmt::format("{} = {} {}", slot.name, quoted_value(file), problem));
    return Value{};
  }
  if (slot.type == Type::file) return Value{File{path}};
  return file_edge(work, path, type, logical, where);
}

}  // namespace

std::vector<std::string> matching_files(Work& work, const std::string& pattern) {
  std::set<std::string> found;
  for (const auto& [file, written] : work.written)
    if (matches(same_file(pattern), file)) found.insert(file);
  const fs::path path = beside_scene(work, pattern);
  const fs::path folder = fs::path(pattern).parent_path();
  for (const std::string& name : names_in(path.parent_path()))
    if (const std::string file = (folder / name).string(); matches(pattern, file)) found.insert(file);
  std::vector<std::string> files(found.begin(), found.end());
  std::sort(files.begin(), files.end(), natural_less);
  return files;
}

Source resolve_file(Work& work, const Binding& user, const Slot& slot, const std::string& file,
                    const std::string& logical, const Location& where) {
  if (file.empty()) {
    if (slot.required) work.fault(where, fmt::format("{} is empty, but names a file", slot.name));
    return Value{};
  }
  if (slot.type != Type::images || file.find('*') == std::string::npos)
    return resolve_one(work, user, slot, file, logical, where);
  std::vector<Edge> edges;
  for (const std::string& each : matching_files(work, file)) {
    const Source source = resolve_one(work, user, slot, each, logical, where);
    if (const auto* edge = std::get_if<Edge>(&source))
      edges.push_back(*edge);
    else
      return Value{};
  }
  if (edges.empty())
    work.fault(where, fmt::format("{} = {} matches no file beside the scene and no task's target", slot.name,
                                  quoted_value(file)));
  return edges;
}

}  // namespace msml
