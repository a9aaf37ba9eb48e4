// SPDX-License-Identifier: GPL-3.0-or-later
// ID_0000.vtu, ID_0001.vtu, … and ID.pvd.
#include "operators/simulate/series_writer.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "msml/core/atomic_file.hpp"
#include "operators/formats/formats.hpp"

namespace msml::simulation {
namespace {

/// Cells and region ids of the results: those of the mesh, or the number of the material region.
Mesh frame_of(const Simulation& simulation) {
  const Mesh& mesh = *simulation.body.mesh;
  Mesh frame;
  frame.kinds = mesh.kinds;
  frame.offsets = mesh.offsets;
  frame.nodes = mesh.nodes;
  frame.regions = mesh.regions;
  if (!frame.regions.empty()) return frame;
  frame.regions.assign(mesh.kinds.size(), 0);
  for (std::size_t r = 0; r < simulation.model.regions.size(); ++r)
    for (const int element : simulation.model.regions[r].elements)
      frame.regions[static_cast<std::size_t>(element)] = static_cast<int>(r);
  return frame;
}

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '&')
      safe += "&amp;";
    else if (c == '<')
      safe += "&lt;";
    else if (c == '>')
      safe += "&gt;";
    else if (c == '"')
      safe += "&quot;";
    else
      safe += c;
  }
  return safe;
}

}  // namespace

SeriesWriter::SeriesWriter(const Simulation& simulation, const OutputRequest& request, std::filesystem::path folder)
    : request_(request),
      folder_(std::move(folder)),
      stride_(request.every),
      last_(std::make_shared<Mesh>(frame_of(simulation))) {
  const fe::Settings& settings = simulation.model.settings;
  if (settings.integrator == fe::Integrator::static_ && !settings.arc_length.on) stride_ *= settings.load_steps;
}

bool SeriesWriter::wants(const fe::State& state) const { return state.increment % stride_ == 0; }

std::string SeriesWriter::file_name(std::size_t number) const {
  return fmt::format("{}_{:04}.vtu", request_.id, number);
}

void SeriesWriter::write(const fe::State& state, StateFields& fields) {
  last_->point_fields.clear();
  last_->cell_fields.clear();
  last_->points = fields.positions();
  for (const std::string& name : request_.fields) fields.add_to(*last_, name);
  const std::filesystem::path path = folder_ / file_name(files_.size());
  static const Format format = operators::vtk_xml_grid();
  write_whole(path,
              [&](const std::filesystem::path& temporary) { format.write(Value(MeshPtr(last_)), temporary, ".vtu"); });
  files_.push_back(path);
  times_.push_back(state.time);
  last_increment_ = state.increment;
  const auto now = std::chrono::steady_clock::now();
  if (now - collected_ > std::chrono::seconds(1)) write_collection();
}

void SeriesWriter::finish(const fe::State& last, StateFields& fields) {
  bool missing = last_increment_ != last.increment || times_.back() != last.time;
  while (!times_.empty() && times_.back() > last.time) {  // states that a run went back from
    times_.pop_back();
    files_.pop_back();
    missing = times_.empty() || times_.back() != last.time;
  }
  if (missing) write(last, fields);
  write_collection();
  remove_older_states();
}

void SeriesWriter::write_collection() {
  std::string text =
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"0.1\" byte_order=\"LittleEndian\">\n"
      "  <Collection>\n";
  for (std::size_t i = 0; i < files_.size(); ++i)
    text +=
        fmt::format("    <DataSet timestep=\"{:.17g}\" part=\"0\" file=\"{}\"/>\n", times_[i], escaped(file_name(i)));
  write_whole(folder_ / (request_.id + ".pvd"), text + "  </Collection>\n</VTKFile>\n");
  collected_ = std::chrono::steady_clock::now();
}

void SeriesWriter::remove_older_states() const {
  const std::string start = request_.id + "_";
  std::error_code ignored;
  for (const auto& entry : std::filesystem::directory_iterator(folder_, ignored)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(start) || !name.ends_with(".vtu") || name.size() < start.size() + 8) continue;
    const std::string digits = name.substr(start.size(), name.size() - start.size() - 4);
    const bool number =
        digits.size() <= 9 && std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (number && name == file_name(std::stoul(digits)) && std::stoul(digits) >= files_.size())
      std::filesystem::remove(entry.path(), ignored);
  }
}

Value SeriesWriter::value() const {
  return std::make_shared<const Series>(
      Series{.pattern = request_.id + "_*.vtu", .folder = folder_, .times = times_, .files = files_, .last = last_});
}

}  // namespace msml::simulation
