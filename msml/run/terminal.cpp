// SPDX-License-Identifier: GPL-3.0-or-later
// Lines and the live bar.
#include "msml/run/terminal.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>

namespace msml {
namespace {

constexpr int bar_width = 16;

/// The first `columns` columns of a UTF-8 text.
std::string clipped(const std::string& text, std::size_t columns) {
  std::size_t used = 0, i = 0;
  for (; i < text.size(); ++i) {
    if ((static_cast<unsigned char>(text[i]) & 0xC0) == 0x80) continue;
    if (used++ == columns) break;
  }
  return text.substr(0, i);
}

std::size_t terminal_columns() {
  winsize size{};
  return ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 20 ? size.ws_col - 1u : 79u;
}

}  // namespace

std::string duration(double seconds) {
  if (seconds < 0.9995) return fmt::format("{:.0f} ms", seconds * 1e3);
  if (seconds < 60) return fmt::format("{:.1f} s", seconds);
  return fmt::format("{} min {:02d} s", static_cast<int>(seconds) / 60, static_cast<int>(seconds) % 60);
}

std::string megabytes(std::size_t bytes) { return fmt::format("{:.1f} MB", static_cast<double>(bytes) / 1e6); }

Terminal::Terminal(const Graph& graph, const Plan& plan, Verbosity verbosity)
    : graph_(graph), count_(plan.order.size()), verbosity_(verbosity), live_(::isatty(STDERR_FILENO) == 1) {
  for (const int i : plan.order) {
    tag_width_ = std::max(tag_width_, node(i).tag().size());
    id_width_ = std::max(id_width_, node(i).id.size());
  }
}

Terminal::~Terminal() {
  if (bar_) std::fputs("\r\033[K", stderr);
}

void Terminal::line(const std::string& text) {
  if (bar_) std::fputs("\r\033[K", stderr);
  bar_ = false;
  std::fprintf(stderr, "%s\n", text.c_str());
}

std::string Terminal::head(int i, int number) const {
  return fmt::format("[{}/{}] {:<{}}  {:<{}}", number, count_, node(i).tag(), tag_width_, node(i).id, id_width_);
}

void Terminal::draw(int i, double share, const std::string& words) {
  const double inside = std::clamp(share, 0.0, 1.0);
  const int filled = static_cast<int>(inside * bar_width + 0.5);
  const std::string bar = std::string(static_cast<std::size_t>(filled), '#') +
                          std::string(static_cast<std::size_t>(bar_width - filled), '.');
  const std::string text = fmt::format("[{}/{}] {} {}  [{}] {:.0f} %  {}", done_ + 1, count_, node(i).tag(), node(i).id,
                                       bar, inside * 100, words);
  std::fprintf(stderr, "\r\033[K%s", clipped(text, terminal_columns()).c_str());
  std::fflush(stderr);
  bar_ = true;
  last_draw_ = std::chrono::steady_clock::now();
}

void Terminal::started(int i) {
  const std::lock_guard lock(mutex_);
  if (live_ && verbosity_ != Verbosity::quiet) draw(i, 0, "");
}

void Terminal::progress(int i, double share, const std::string& words) {
  const std::lock_guard lock(mutex_);
  if (!live_ || verbosity_ == Verbosity::quiet) return;
  if (std::chrono::steady_clock::now() - last_draw_ > std::chrono::milliseconds(100)) draw(i, share, words);
}

void Terminal::finished(int i, const NodeReport& report) {
  const std::lock_guard lock(mutex_);
  ++done_;
  if (verbosity_ == Verbosity::quiet) return;
  const std::string result = report.status == NodeStatus::done ? report.summary : "failed";
  line(fmt::format("{}  {}  {}", head(i, done_), result, duration(report.seconds)));
}

void Terminal::note(int i, const std::string& text) {
  const std::lock_guard lock(mutex_);
  if (verbosity_ == Verbosity::verbose) line(fmt::format("note: {}: {}", node(i).id, text));
}

void Terminal::warning(int i, const std::string& text) {
  const std::lock_guard lock(mutex_);
  line(fmt::format("{}: warning: {}: {}", node(i).where.str(), node(i).id, text));
}

void Terminal::print(int, const std::string& text) {
  const std::lock_guard lock(mutex_);
  if (verbosity_ != Verbosity::quiet) line(text);
}

}  // namespace msml
