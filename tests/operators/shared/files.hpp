// SPDX-License-Identifier: GPL-3.0-or-later
// A folder that vanishes with the test, and reading and writing through the full registry.
#pragma once
#include <unistd.h>

#include <cstdlib>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "operators/registry.hpp"

namespace msml::test {

class Folder {
 public:
  explicit Folder(const std::string& name) {
    std::string pattern = (std::filesystem::temp_directory_path() / (name + "_XXXXXX")).string();
    path_ = ::mkdtemp(pattern.data());
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

inline Registry all() {
  Registry registry;
  add_operators(registry);
  return registry;
}

inline std::string bytes_of(const std::filesystem::path& path) {
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

inline void put_bytes(const std::filesystem::path& path, const std::string& bytes) {
  std::ofstream(path, std::ios::binary) << bytes;
}

/// The message of the Error thrown while reading the file, with the folder cut out, or "no error".
inline std::string read_error(const std::filesystem::path& path, Type type) {
  try {
    all().read(path, type);
  } catch (const Error& e) {
    std::string text = e.what();
    const std::string folder = path.parent_path().string() + "/";
    if (const auto at = text.find(folder); at != std::string::npos) text.erase(at, folder.size());
    return text;
  }
  return "no error";
}

}  // namespace msml::test
