// SPDX-License-Identifier: GPL-3.0-or-later
// From what varies to the settings of each run.
#pragma once
#include "msml/study/study.hpp"

namespace msml {

/// The values of a list: tuples between ';', or, without one, single words; {1 2 3} is one word. A tuple with a wrong
/// number of words is told to `fault`.
std::vector<std::vector<std::string>> parse_values(const std::string& text, const Vary& vary, const FaultSink& fault);

/// `count` values from one end of the range to the other, both included, in the scale of the range.
std::vector<std::vector<std::string>> range_values(const Vary& vary, int count);

/// The settings of all runs, in order: the last variable changes fastest. What does not go together is told to `fault`.
/// Latin hypercube: each range in as many equal parts as there are samples, one sample in each part, in random order
/// (McKay, Beckman and Conover 1979, doi 10.1080/00401706.1979.10489755).
std::vector<Settings> expand(const Study& study, const FaultSink& fault);

}  // namespace msml
