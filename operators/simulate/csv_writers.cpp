// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of numbers over time, and the writers of all requests.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "msml/core/atomic_file.hpp"
#include "operators/simulate/output_writer.hpp"
#include "operators/simulate/series_writer.hpp"

namespace msml::simulation {
namespace {

class EnergiesWriter final : public TableWriter {
 public:
  EnergiesWriter(const OutputRequest& request, const std::filesystem::path& folder)
      : TableWriter(request, folder,
                    {"time", "elastic", "kinetic", "external_work", "dissipated", "momentum_x", "momentum_y",
                     "momentum_z", "angular_momentum_x", "angular_momentum_y", "angular_momentum_z", "load_factor"}) {}

 private:
  std::vector<std::vector<double>> rows(const fe::State& state, StateFields&) const override {
    const fe::Energies& e = state.energies;
    const Vec3 &p = e.momentum, &L = e.angular_momentum;
    return {{state.time, e.elastic, e.kinetic, e.external_work, e.dissipated, p[0], p[1], p[2], L[0], L[1], L[2],
             state.load_factor}};
  }
};

constexpr fe::ElementRequest only_volume{.law = false, .J = false, .rotation = false, .volume = true};

class VolumeWriter final : public TableWriter {
 public:
  VolumeWriter(const Simulation& simulation, const OutputRequest& request, const std::filesystem::path& folder)
      : TableWriter(request, folder, names(simulation.model)), model_(simulation.model) {}

 private:
  static std::vector<std::string> names(const fe::Model& model) {
    std::vector<std::string> all{"time"};
    for (const fe::Region& region : model.regions) all.push_back(region.name);
    all.push_back("body");
    return all;
  }

  std::vector<std::vector<double>> rows(const fe::State& state, StateFields& fields) const override {
    const std::vector<double> volumes = fields.measure(only_volume).deformed_volume;
    std::vector<double> numbers{state.time};
    double body = 0;
    for (const fe::Region& region : model_.regions) {
      double sum = 0;
      for (const int element : region.elements) sum += volumes[static_cast<std::size_t>(element)];
      numbers.push_back(sum);
      body += sum;
    }
    numbers.push_back(body);
    return {numbers};
  }

  const fe::Model& model_;
};

}  // namespace

CsvFile::CsvFile(std::filesystem::path path, const std::vector<std::string>& names) : path_(std::move(path)) {
  for (const std::string& name : names) text_ += (text_.empty() ? "" : ",") + name;
  text_ += '\n';
}

void CsvFile::add(const std::vector<double>& row) {
  for (std::size_t i = 0; i < row.size(); ++i) {
    if (!std::isfinite(row[i])) throw Error(fmt::format("{}: column {} is not finite", path_.string(), i + 1));
    text_ += fmt::format("{}{:.15g}", i == 0 ? "" : ",", row[i]);
  }
  text_ += '\n';
}

bool CsvFile::end_at(double time) {
  const double round_off = 1e-14 * std::abs(time);  // of numbers with fifteen digits
  const auto last_line = [&] { return text_.rfind('\n', text_.size() - 2) + 1; };
  double found = 0;
  for (std::size_t first = text_.find('\n') + 1; text_.size() > first; text_.resize(last_line())) {
    found = std::strtod(text_.c_str() + last_line(), nullptr);
    if (found <= time + round_off) return found < time - round_off;
  }
  return true;
}

void CsvFile::save(bool at_once) {
  const auto now = std::chrono::steady_clock::now();
  if (!at_once && now - saved_ < std::chrono::seconds(1)) return;
  write_whole(path_, text_);
  saved_ = std::chrono::steady_clock::now();
}

TableWriter::TableWriter(const OutputRequest& request, const std::filesystem::path& folder,
                         const std::vector<std::string>& names)
    : every_(request.every), file_(folder / (request.id + ".csv"), names) {}

void TableWriter::write(const fe::State& state, StateFields& fields) {
  for (const std::vector<double>& row : rows(state, fields)) file_.add(row);
  last_ = state.increment;
  last_time_ = state.time;
  file_.save(false);
}

void TableWriter::finish(const fe::State& last, StateFields& fields) {
  bool missing = last_ != last.increment || last_time_ != last.time;
  if (last_time_ > last.time) missing = file_.end_at(last.time);
  if (missing) write(last, fields);
  file_.save(true);
}

std::unique_ptr<OutputWriter> make_volume(const Simulation& simulation, const OutputRequest& request,
                                          const std::filesystem::path& folder) {
  return std::make_unique<VolumeWriter>(simulation, request, folder);
}

std::unique_ptr<OutputWriter> make_energies(const OutputRequest& request, const std::filesystem::path& folder) {
  return std::make_unique<EnergiesWriter>(request, folder);
}

std::vector<std::unique_ptr<OutputWriter>> make_writers(const Simulation& simulation,
                                                        const std::filesystem::path& folder, Reporter& reporter) {
  std::vector<std::unique_ptr<OutputWriter>> writers;
  for (const OutputRequest& request : simulation.outputs) {
    switch (request.kind) {
      case OutputKind::probe:
        writers.push_back(make_probe(simulation, request, reporter, folder));
        break;
      case OutputKind::energies:
        writers.push_back(make_energies(request, folder));
        break;
      case OutputKind::section:
        writers.push_back(make_section(simulation, request, folder));
        break;
      case OutputKind::volume:
        writers.push_back(make_volume(simulation, request, folder));
        break;
      case OutputKind::series:
        writers.push_back(std::make_unique<SeriesWriter>(simulation, request, folder));
    }
  }
  return writers;
}

}  // namespace msml::simulation
