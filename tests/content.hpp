// SPDX-License-Identifier: GPL-3.0-or-later
// Files as text.
#pragma once
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace msml::testing {

/// All that a file holds, byte by byte; "" where there is none.
inline std::string content(const std::filesystem::path& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

}  // namespace msml::testing
