// SPDX-License-Identifier: GPL-3.0-or-later
// What the curves of a study's charts say: slopes, and where errors pass round numbers.
#pragma once
#include "msml/study/page.hpp"

namespace msml {

/// Fitted slopes of all curves on doubly logarithmic axes, except along a measured time, with their confidence: of all
/// runs, and of the finer half (at least three) where there are more than three. The finer end is the one with the
/// smaller error; for other measures that of larger x.
Page slope_blocks(const Study& study, const Table& table);

/// For each chart of a relative error over a variable: the value of the variable at which each curve passes 10 %, 5 %,
/// 1 % and 0.1 %.
Page passing_blocks(const Study& study, const Table& table);

}  // namespace msml
