// SPDX-License-Identifier: GPL-3.0-or-later
// Results by key.
#include "msml/study/shelf.hpp"

namespace msml {

void SharedResults::expect(const std::vector<std::string>& keys) {
  const std::lock_guard lock(mutex_);
  for (const std::string& key : keys) ++entries_[key].users;
}

void SharedResults::release(const std::vector<std::string>& keys) {
  const std::lock_guard lock(mutex_);
  for (const std::string& key : keys)
    if (const auto found = entries_.find(key); found != entries_.end() && --found->second.users <= 0)
      entries_.erase(found);
}

bool SharedResults::take(const std::string& key, std::size_t pass, Shelved& into) {
  std::unique_lock lock(mutex_);
  Entry& entry = entries_[key];
  changed_.wait(lock, [&] { return !entry.busy; });
  if (entry.failed || entry.reports.size() <= pass) {
    entry.busy = true;
    return false;
  }
  ++shared_;
  into = {entry.outputs, entry.reports[pass]};
  return true;
}

void SharedResults::put(const std::string& key, const Shelved& result) {
  const std::lock_guard lock(mutex_);
  Entry& entry = entries_[key];
  ++computed_;
  entry.busy = false;
  entry.failed = result.report.status != NodeStatus::done;
  entry.outputs = result.outputs;
  entry.reports.push_back(result.report);
  changed_.notify_all();
}

const std::vector<Value>* SharedResults::outputs(const std::string& key) {
  const std::lock_guard lock(mutex_);
  const auto found = entries_.find(key);
  return found == entries_.end() || found->second.reports.empty() ? nullptr : &found->second.outputs;
}

}  // namespace msml
