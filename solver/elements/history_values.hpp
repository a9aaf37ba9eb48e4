// SPDX-License-Identifier: GPL-3.0-or-later
// What the histories of all batches hold, in the order of the elements.
#pragma once
#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "solver/elements/prony_history.hpp"

namespace msml::fe {

/// True if a batch has a history.
template <class Batch>
bool remembers(const std::vector<Batch>& batches) {
  return std::any_of(batches.begin(), batches.end(), [](const Batch& b) { return !b.history.empty(); });
}

/// State::history_stress; `element(batch, lane)` is a place in Numbering::elements, of which there are `elements`.
template <class Batch, class Element>
std::shared_ptr<const std::vector<double>> history_stresses(const std::vector<Batch>& batches, std::size_t elements,
                                                            std::size_t points, const Element& element) {
  if (!remembers(batches)) return nullptr;
  auto values = std::make_shared<std::vector<double>>(elements * points * 6, 0.0);
  for (const Batch& batch : batches)
    for (std::size_t q = 0; q < batch.history.stress().size(); ++q)
      for (int lane = 0; lane < batch.count; ++lane)
        for (std::size_t k = 0; k < 6; ++k)
          (*values)[(element(batch, lane) * points + q) * 6 + k] = batch.history.stress()[q].c[k][lane];
  return values;
}

/// State::history_energy, likewise.
template <class Batch, class Element>
std::shared_ptr<const std::vector<double>> history_energies(const std::vector<Batch>& batches, std::size_t elements,
                                                            std::size_t points, const Element& element) {
  if (!remembers(batches)) return nullptr;
  auto values = std::make_shared<std::vector<double>>(elements * points, 0.0);
  for (const Batch& batch : batches)
    for (std::size_t q = 0; q < batch.history.energy().size(); ++q)
      for (int lane = 0; lane < batch.count; ++lane)
        (*values)[element(batch, lane) * points + q] = batch.history.energy()[q][lane];
  return values;
}

/// Stored energy less the potential of the step's forces in a batch: the responses are those of PronyHistory::apply.
inline double stored_beside(const PronyHistory& history, std::span<const Response> responses,
                            std::span<const Lanes> weights, int count) {
  double sum = 0;
  for (std::size_t q = 0; q < responses.size(); ++q)
    for (int lane = 0; lane < count; ++lane)
      sum += weights[q][lane] * (history.energy()[q][lane] - responses[q].energy[lane]);
  return sum;
}

}  // namespace msml::fe
