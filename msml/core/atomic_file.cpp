// SPDX-License-Identifier: GPL-3.0-or-later
// Temporary name, fsync, rename; and the list of temporaries that an interrupt removes.
#include "msml/core/atomic_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <mutex>
#include <set>

#include "msml/core/error.hpp"

namespace msml {
namespace {

/// The one piece of process-wide state: the names that must not survive an interrupt.
struct Temporaries {
  std::mutex mutex;
  std::set<std::string> names;
};
Temporaries& temporaries() {
  static Temporaries all;
  return all;
}

class Temporary {
 public:
  explicit Temporary(const std::filesystem::path& path) {
    static std::atomic<unsigned> counter{0};
    path_ = path;
    path_ += ".tmp" + std::to_string(::getpid()) + "_" + std::to_string(counter++);
    const std::lock_guard lock(temporaries().mutex);
    temporaries().names.insert(path_.string());
  }
  ~Temporary() {
    const std::lock_guard lock(temporaries().mutex);
    ::unlink(path_.c_str());
    temporaries().names.erase(path_.string());
  }
  Temporary(const Temporary&) = delete;
  Temporary& operator=(const Temporary&) = delete;
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

std::atomic<int> without_flushing = 0;

void flush_to_disk(const std::filesystem::path& path, bool required) {
  if (without_flushing > 0) return;
  const int file = ::open(path.c_str(), O_RDONLY);
  const bool flushed = file >= 0 && ::fsync(file) == 0;
  const int reason = errno;
  if (file >= 0) ::close(file);
  if (required && !flushed) throw Error("cannot write " + path.string() + ": " + std::strerror(reason));
}

}  // namespace

WithoutFlushing::WithoutFlushing() { ++without_flushing; }
WithoutFlushing::~WithoutFlushing() { --without_flushing; }

void write_whole(const std::filesystem::path& path, const std::function<void(const std::filesystem::path&)>& write) {
  std::error_code code;
  const auto folder = path.parent_path();
  if (!folder.empty()) std::filesystem::create_directories(folder, code);
  if (code) throw Error("cannot create the folder " + folder.string() + ": " + code.message());
  const Temporary temporary(path);
  write(temporary.path());
  flush_to_disk(temporary.path(), true);
  std::filesystem::rename(temporary.path(), path, code);
  if (code) throw Error("cannot write " + path.string() + ": " + code.message());
  flush_to_disk(folder.empty() ? "." : folder, false);
}

void write_whole(const std::filesystem::path& path, const std::string& text) {
  write_whole(path, [&](const std::filesystem::path& temporary) {
    std::ofstream out(temporary, std::ios::binary);
    out << text;
    out.close();
    if (!out) throw Error("cannot write " + path.string() + ": " + std::strerror(errno));
  });
}

void unlink_temporaries() noexcept {
  // The lock is never given back: no thread can start another file in the instant before the process ends.
  temporaries().mutex.lock();
  for (const std::string& name : temporaries().names) ::unlink(name.c_str());
}

}  // namespace msml
