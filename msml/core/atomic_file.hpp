// SPDX-License-Identifier: GPL-3.0-or-later
// Files that appear whole or not at all.
#pragma once
#include <filesystem>
#include <functional>
#include <string>

namespace msml {

/// Calls `write` with a temporary name beside `path`, flushes that file to disk and renames it to `path`. Creates
/// missing folders. If `write` throws or the disk is full, nothing is left behind and the old file stays.
void write_whole(const std::filesystem::path& path, const std::function<void(const std::filesystem::path&)>& write);

/// The same for a text.
void write_whole(const std::filesystem::path& path, const std::string& text);

/// While one lives, files still appear whole or not at all, but are not flushed to disk: for what can be made again,
/// and whose time is measured.
class WithoutFlushing {
 public:
  WithoutFlushing();
  ~WithoutFlushing();
  WithoutFlushing(const WithoutFlushing&) = delete;
  WithoutFlushing& operator=(const WithoutFlushing&) = delete;
};

/// Unlinks every temporary file in the making and lets no new one begin: to be called just before the program ends,
/// while other threads may still write.
void unlink_temporaries() noexcept;

}  // namespace msml
