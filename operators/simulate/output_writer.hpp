// SPDX-License-Identifier: GPL-3.0-or-later
// What every output request does while the simulation runs.
#pragma once
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "msml/core/value.hpp"
#include "operators/simulate/build_model.hpp"
#include "operators/simulate/state_fields.hpp"

namespace msml::simulation {

class OutputWriter {
 public:
  OutputWriter() = default;
  OutputWriter(const OutputWriter&) = delete;
  OutputWriter& operator=(const OutputWriter&) = delete;
  virtual ~OutputWriter() = default;
  /// Whether the request asks for this state, whatever comes after it.
  virtual bool wants(const fe::State& state) const = 0;
  /// Writes the state, and files whole or not at all.
  virtual void write(const fe::State& state, StateFields& fields) = 0;
  /// Writes the last state if it has not been written yet, takes away those that came after it, and brings the files to
  /// their end.
  virtual void finish(const fe::State& last, StateFields& fields) = 0;
  /// What `${id}` stands for.
  virtual Value value() const = 0;
  /// Held in memory.
  virtual std::size_t bytes() const { return 0; }
};

/// One writer per request of the simulation, which must outlive them. Throws Error where a request does not fit the
/// body, such as a probe outside it.
std::vector<std::unique_ptr<OutputWriter>> make_writers(const Simulation& simulation,
                                                        const std::filesystem::path& folder, Reporter& reporter);

/// Lines of numbers under a line of names, in a file ID.csv.
class CsvFile {
 public:
  CsvFile(std::filesystem::path path, const std::vector<std::string>& names);
  void add(const std::vector<double>& row);
  /// Takes away the last lines whose first number, the time, is larger; true if none is left of that time.
  bool end_at(double time);
  /// Writes the file as it is now: at once, or at most once a second.
  void save(bool at_once);
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
  std::string text_;
  std::chrono::steady_clock::time_point saved_{};
};

/// A request that becomes lines of a CSV file for each state it wants.
class TableWriter : public OutputWriter {
 public:
  TableWriter(const OutputRequest& request, const std::filesystem::path& folder, const std::vector<std::string>& names);
  bool wants(const fe::State& state) const override { return state.increment % every_ == 0; }
  void write(const fe::State& state, StateFields& fields) override;
  void finish(const fe::State& last, StateFields& fields) override;
  Value value() const override { return File{file_.path()}; }

 protected:
  /// The lines of a state, mostly one, with one number per name.
  virtual std::vector<std::vector<double>> rows(const fe::State& state, StateFields& fields) const = 0;

 private:
  int every_, last_ = -1;
  double last_time_ = 0;  ///< the state that ends a run may lie between two increments
  CsvFile file_;
};

/// A field at a place or at nodes over time: ID.csv.
std::unique_ptr<OutputWriter> make_probe(const Simulation& simulation, const OutputRequest& request, Reporter& reporter,
                                         const std::filesystem::path& folder);
/// Energies, work and momentum over time: ID.csv.
std::unique_ptr<OutputWriter> make_energies(const OutputRequest& request, const std::filesystem::path& folder);
/// Area, force and moment on a plane over time: ID.csv. Throws Error where the plane misses the body.
std::unique_ptr<OutputWriter> make_section(const Simulation& simulation, const OutputRequest& request,
                                           const std::filesystem::path& folder);
/// Volumes of the regions over time: ID.csv.
std::unique_ptr<OutputWriter> make_volume(const Simulation& simulation, const OutputRequest& request,
                                          const std::filesystem::path& folder);

}  // namespace msml::simulation
