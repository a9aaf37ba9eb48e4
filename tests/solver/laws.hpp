// SPDX-License-Identifier: GPL-3.0-or-later
// Every material of the registry in every combination of its choices, and helpers to evaluate them at one point.
#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "msml/core/mesh.hpp"
#include "solver/registry.hpp"

namespace msml::fe::testing {

struct NamedLaw {
  std::string name;
  std::shared_ptr<const Law> law;
};

/// A record with each number inside its range: 1000 where only positive, 13/15 of the way where bounded (Poisson .3).
/// What is optional is given too, where it is a number.
inline Record sample_record(const Description& description) {
  Record record{.description = &description};
  for (const Slot& slot : description.slots()) {
    Value value = slot.fallback;
    if (type(slot.fallback) == Type::nothing && slot.type == Type::number)
      value = std::isfinite(slot.range.high) ? slot.range.low + 13.0 / 15 * (slot.range.high - slot.range.low) : 1000.0;
    if (type(slot.fallback) == Type::nothing && slot.type == Type::formula) value = Formula(1000.0);
    record.values.push_back(value);
    record.given.push_back(slot.required);
  }
  return record;
}

/// Every law of displacements in the registry, once for each combination of text choices.
inline std::vector<NamedLaw> all_laws() {
  std::vector<NamedLaw> laws;
  for (const MaterialFactory& material : materials()) {
    std::vector<std::pair<std::string, Record>> variants{{material.tag(), sample_record(material)}};
    for (std::size_t s = 0; s < material.slots().size(); ++s) {
      const Slot& slot = material.slots()[s];
      if (slot.choices.empty()) continue;
      std::vector<std::pair<std::string, Record>> more;
      for (const auto& [name, record] : variants)
        for (const std::string& choice : slot.choices) {
          more.emplace_back(name + " " + slot.name + "=" + choice, record);
          more.back().second.values[s] = choice;
        }
      variants = more;
    }
    for (const auto& [name, record] : variants)
      if (const auto law = material.make(record); law->components() == 3) laws.push_back({name, law});
  }
  return laws;
}

struct Point {
  double energy;
  Mat3 P;
  Eigen::Matrix<double, 9, 9> tangent;  ///< row and column 3 i + k for F_ik
};

inline Point evaluate(const Law& law, const Mat3& F, Want want = Want::tangent, int lane = 3) {
  Gradients H{};  // the other lanes stay at rest
  for (int k = 0; k < 9; ++k) H.c[k][lane] = F(k / 3, k % 3) - (k % 4 == 0 ? 1 : 0);
  Response response{};
  law.evaluate(want, {&H, 1}, {&response, 1});
  Point point;
  point.energy = response.energy[lane];
  for (int k = 0; k < 9; ++k) point.P(k / 3, k % 3) = response.P.c[k][lane];
  for (int i = 0; i < 9; ++i)
    for (int j = 0; j < 9; ++j)
      point.tangent(i, j) = response.tangent[i >= j ? i * (i + 1) / 2 + j : j * (j + 1) / 2 + i][lane];
  return point;
}

class Random {
 public:
  double number(double low = -1, double high = 1) { return std::uniform_real_distribution<double>(low, high)(engine_); }
  Mat3 matrix() {
    Mat3 m;
    for (int k = 0; k < 9; ++k) m(k / 3, k % 3) = number();
    return m;
  }
  Mat3 rotation() {
    Eigen::Quaterniond q(number(), number(), number(), number());
    return q.normalized().toRotationMatrix();
  }
  /// A deformation gradient with given principal stretches in random directions.
  Mat3 stretched(double a, double b, double c) {
    const Mat3 V = rotation();
    return rotation() * V * Vec3(a, b, c).asDiagonal() * V.transpose();
  }

 private:
  std::mt19937 engine_{7};
};

}  // namespace msml::fe::testing
