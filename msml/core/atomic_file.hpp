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

/// Unlinks every temporary file in the making and lets no new one begin: to be called just before the program ends,
/// while other threads may still write.
void unlink_temporaries() noexcept;

}  // namespace msml
