// SPDX-License-Identifier: GPL-3.0-or-later
// VTK's complaints as errors instead of text on the terminal.
#pragma once
#include <functional>
#include <string>

class vtkAlgorithm;

namespace msml::operators {

/// Runs `work`, which calls VTK. Whatever VTK reports as an error meanwhile in this thread, and any exception of the
/// standard library, becomes an Error "WHAT: VTK's words, shortened". Nothing is printed. Warnings are dropped.
void guarded(const std::string& what, const std::function<void()>& work);

/// Brings the algorithm's outputs up to date inside guarded().
void update(vtkAlgorithm& algorithm, const std::string& what);

}  // namespace msml::operators
