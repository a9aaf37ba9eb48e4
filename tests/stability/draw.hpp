// SPDX-License-Identifier: GPL-3.0-or-later
// Random numbers from a seed, and the scene that is drawn with them.
#pragma once
#include <cmath>
#include <random>
#include <string>

#include "solver/model.hpp"

namespace msml::fe::testing {

class Draw {
 public:
  explicit Draw(unsigned seed) : engine_(seed) {}
  double number(double low, double high) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  /// From low to high, every power of ten as likely.
  double power(double low, double high) { return std::exp(number(std::log(low), std::log(high))); }
  int index(int count) { return std::uniform_int_distribution<int>(0, count - 1)(engine_); }
  bool chance(double p) { return number(0, 1) < p; }
  Vec3 direction() { return Vec3(number(-1, 1), number(-1, 1), number(-1, 1)).normalized(); }

 private:
  std::mt19937 engine_;
};

struct Drawn {
  std::string words;  ///< what was drawn, for messages
  Model model;
};

constexpr double drawn_length = 2, drawn_young = 1000;

inline bool at_wall(const Vec3& x) { return x[0] < 1e-9; }
inline bool at_end(const Vec3& x) { return x[0] > drawn_length - 1e-9; }

}  // namespace msml::fe::testing
