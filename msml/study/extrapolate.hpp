// SPDX-License-Identifier: GPL-3.0-or-later
// The limit of a number over ever finer settings, where no finer run and no formula is at hand.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <vector>

#include "msml/study/study.hpp"
#include "msml/study/table.hpp"

namespace msml {

/// Sizes from coarse to fine with a value each, taken as value = limit + constant * size^order; Richardson 1911,
/// doi 10.1098/rsta.1911.0009, with the order found too. `order` is within 0.1 and 10.
struct Limit {
  double value = 0, order = 0;
};
/// Nothing where the three values do not approach a limit from one side.
std::optional<Limit> richardson(const std::array<double, 3>& sizes, const std::array<double, 3>& values);

/// Why three values have no limit, or "" where richardson() finds one.
std::string why_no_limit(const std::array<double, 3>& sizes, const std::array<double, 3>& values);

/// A measure that stays without errors in the rows with some values of the other variables.
struct NoLimit {
  std::string measure, others, why;
};

/// Fills the errors of extrapolated measures: for rows that agree in all other variables, the limit of the last three
/// that have a value. The variable counts as a size where it falls, as a number of parts where it rises. Variables that
/// are refined along with it, so that each of their values goes with one of its own, divide no rows. Returns where
/// there is no limit.
std::vector<NoLimit> extrapolate(const Study& study, Table& table);

}  // namespace msml
