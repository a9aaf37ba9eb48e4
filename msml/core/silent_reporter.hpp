// SPDX-License-Identifier: GPL-3.0-or-later
// For calls whose progress and remarks nobody waits for.
#pragma once
#include "msml/core/operator.hpp"

namespace msml {

/// Drops everything that it is told.
class SilentReporter final : public Reporter {
 public:
  void progress(double, const std::string&) override {}
  void note(const std::string&) override {}
  void warn(const std::string&) override {}
  void print(const std::string&) override {}
  void record(const std::string&, const std::string&) override {}
};

}  // namespace msml
