// SPDX-License-Identifier: GPL-3.0-or-later
// Progress that a person can read, on stderr.
#pragma once
#include <chrono>
#include <map>
#include <mutex>
#include <vector>

#include "msml/run/run.hpp"

namespace msml {

enum class Verbosity : std::uint8_t { quiet, normal, verbose };

/// One plain line per finished node; a live bar below them where stderr is a terminal. Warnings always appear.
class Terminal : public Watcher {
 public:
  Terminal(const Graph& graph, const Plan& plan, Verbosity verbosity);
  ~Terminal() override;
  void started(int node) override;
  void progress(int node, double share, const std::string& words) override;
  void finished(int node, const NodeReport& report) override;
  void note(int node, const std::string& text) override;
  void warning(int node, const std::string& text) override;
  void print(int node, const std::string& text) override;

 private:
  const Node& node(int i) const { return graph_.nodes[static_cast<std::size_t>(i)]; }
  void line(const std::string& text);  ///< removes the bar, writes the line
  void draw(int node, double share, const std::string& words);
  std::string head(int node, int number) const;

  const Graph& graph_;
  const std::size_t count_;
  const Verbosity verbosity_;
  const bool live_;
  std::size_t tag_width_ = 0, id_width_ = 0;
  int done_ = 0;
  bool bar_ = false;
  std::chrono::steady_clock::time_point last_draw_{};
  std::mutex mutex_;
};

/// "1.2 s", "320 ms", "2 min 05 s"
std::string duration(double seconds);
/// "12.3 MB"
std::string megabytes(std::size_t bytes);

}  // namespace msml
