// SPDX-License-Identifier: GPL-3.0-or-later
// The states of one output request, written to disk while the simulation runs.
#pragma once
#include <chrono>
#include <filesystem>
#include <vector>

#include "msml/core/value.hpp"
#include "operators/simulate/output_writer.hpp"

namespace msml::simulation {

class SeriesWriter final : public OutputWriter {
 public:
  /// Writes nothing yet. `simulation` must outlive the writer.
  SeriesWriter(const Simulation& simulation, const OutputRequest& request, std::filesystem::path folder);

  /// Of a static run the states at the start and at the end of each step count.
  bool wants(const fe::State& state) const override;
  /// Writes ID_NNNN.vtu whole or not at all, and now and then ID.pvd.
  void write(const fe::State& state, StateFields& fields) override;
  /// Writes the state if it is not the one written last, then ID.pvd, and removes states that came after it and those
  /// of an earlier, longer run.
  void finish(const fe::State& last, StateFields& fields) override;
  /// The Series that was written.
  Value value() const override;
  std::size_t bytes() const override { return msml::bytes(Value(std::shared_ptr<const Mesh>(last_))); }

 private:
  void write_collection();
  void remove_older_states() const;
  std::string file_name(std::size_t number) const;

  OutputRequest request_;
  std::filesystem::path folder_;
  int stride_ = 1;              ///< increments from one state that is asked for to the next
  std::shared_ptr<Mesh> last_;  ///< the state written last; before that its cells and regions
  std::vector<double> times_;
  std::vector<std::filesystem::path> files_;
  int last_increment_ = -1;  ///< of the state written last; one that ends a run may lie between two of them
  std::chrono::steady_clock::time_point collected_{};
};

}  // namespace msml::simulation
