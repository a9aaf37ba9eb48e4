// SPDX-License-Identifier: GPL-3.0-or-later
// Tables of numbers over time, and the writers of all requests.
#include <fmt/format.h>

#include <cmath>

#include "msml/core/atomic_file.hpp"
#include "operators/simulate/output_writer.hpp"
#include "operators/simulate/series_writer.hpp"

namespace msml::simulation {
namespace {

class EnergiesWriter final : public OutputWriter {
 public:
  EnergiesWriter(const OutputRequest& request, const std::filesystem::path& folder)
      : every_(request.every),
        file_(folder / (request.id + ".csv"),
              {"time", "elastic", "kinetic", "external_work", "dissipated", "momentum_x", "momentum_y", "momentum_z",
               "angular_momentum_x", "angular_momentum_y", "angular_momentum_z", "load_factor"}) {}

  bool wants(const fe::State& state) const override { return state.increment % every_ == 0; }

  void write(const fe::State& state, StateFields&) override {
    const fe::Energies& e = state.energies;
    const Vec3 &p = e.momentum, &L = e.angular_momentum;
    file_.add({state.time, e.elastic, e.kinetic, e.external_work, e.dissipated, p[0], p[1], p[2], L[0], L[1], L[2],
               state.load_factor});
    last_ = state.increment;
    file_.save(false);
  }

  void finish(const fe::State& last, StateFields& fields) override {
    if (last_ != last.increment) write(last, fields);
    file_.save(true);
  }

  Value value() const override { return File{file_.path()}; }

 private:
  int every_, last_ = -1;
  CsvFile file_;
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

void CsvFile::save(bool at_once) {
  const auto now = std::chrono::steady_clock::now();
  if (!at_once && now - saved_ < std::chrono::seconds(1)) return;
  write_whole(path_, text_);
  saved_ = std::chrono::steady_clock::now();
}

std::unique_ptr<OutputWriter> make_energies(const OutputRequest& request, const std::filesystem::path& folder) {
  return std::make_unique<EnergiesWriter>(request, folder);
}

std::vector<std::unique_ptr<OutputWriter>> make_writers(const Simulation& simulation,
                                                        const std::filesystem::path& folder, Reporter& reporter) {
  std::vector<std::unique_ptr<OutputWriter>> writers;
  for (const OutputRequest& request : simulation.outputs) {
    if (request.kind == OutputKind::probe)
      writers.push_back(make_probe(simulation, request, reporter, folder));
    else if (request.kind == OutputKind::energies)
      writers.push_back(make_energies(request, folder));
    else
      writers.push_back(std::make_unique<SeriesWriter>(simulation, request, folder));
  }
  return writers;
}

}  // namespace msml::simulation
