// SPDX-License-Identifier: GPL-3.0-or-later
// The context an operator runs in.
#include "msml/core/operator.hpp"

namespace msml {

Context::Context(const Record& args, Reporter& reporter, std::filesystem::path output_folder, int threads)
    : outputs(args.description->slots().size()),
      args_(args),
      reporter_(reporter),
      output_folder_(std::move(output_folder)),
      threads_(threads) {}

int Operator::first_output() const {
  for (std::size_t i = 0; i < slots().size(); ++i)
    if (slots()[i].role == Role::output) return static_cast<int>(i);
  return -1;
}

}  // namespace msml
