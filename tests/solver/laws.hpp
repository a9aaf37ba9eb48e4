// SPDX-License-Identifier: GPL-3.0-or-later
// Every material of the registry in every combination of its choices, and helpers to evaluate them at one point.
#pragma once
#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "msml/core/error.hpp"
#include "msml/core/mesh.hpp"
#include "solver/registry.hpp"

namespace msml::fe::testing {

struct NamedLaw {
  std::string name;
  std::shared_ptr<const Law> law;
};

/// The value that a test takes for an attribute: one that suits the laws, else 1000 where only positive, 13/15 of the
/// way where bounded (Poisson .3). Absent where the attribute may be left out and is no number.
inline Value sample_value(const Slot& slot) {
  static const std::map<std::string, Value> values{
      {"c1", 200.0},
      {"c2", 60.0},
      {"bulkModulus", 1500.0},
      {"k1", 300.0},
      {"k2", 0.4},
      {"kappa", 0.1},
      {"bf", 1.8},
      {"bt", 0.9},
      {"bfs", 1.3},
      {"fiber", std::string("1 2 -0.5")},
      {"fiber2", std::string("-1 0.3 2")},
      {"c", std::vector<double>{200, -20, 6}},
      {"alpha", std::vector<double>{1.3, -2.2}},
      {"terms", std::vector<double>{1, 0, 200, 0, 1, 60, 1, 1, 12, 2, 0, 9}}};
  if (slot.type == Type::formulas && slot.name == "mu") return std::vector<double>{400, -150};
  if (const auto found = values.find(slot.name); found != values.end()) return found->second;
  if (type(slot.fallback) != Type::nothing || slot.type != Type::formula) return slot.fallback;
  return std::isfinite(slot.range.high) ? slot.range.low + 13.0 / 15 * (slot.range.high - slot.range.low) : 1000.0;
}

/// A record with a value for every attribute, or what `set` says instead; monostate there leaves an attribute out.
inline Record sample_record(const Description& description, const std::map<std::string, Value>& set = {}) {
  Record record{.description = &description};
  for (const Slot& slot : description.slots()) {
    const auto found = set.find(slot.name);
    const Value value = found != set.end() ? found->second : sample_value(slot);
    record.values.push_back(type(value) == Type::nothing ? value : convert(value, slot.type));
    record.given.push_back(found != set.end());
  }
  return record;
}

/// A law of the registry with these attributes and samples for the others.
inline std::shared_ptr<const Law> law_of(const std::string& tag, const std::map<std::string, Value>& set = {}) {
  for (const MaterialFactory& material : materials())
    if (material.tag() == tag) return material.make(sample_record(material, set));
  throw Error("no material " + tag);
}

/// Every law of displacements in the registry, once for each combination of text choices; `set` as in sample_record.
inline std::vector<NamedLaw> all_laws(const std::map<std::string, Value>& set = {}) {
  std::vector<NamedLaw> laws;
  for (const MaterialFactory& material : materials()) {
    std::vector<std::pair<std::string, Record>> variants{{material.tag(), sample_record(material, set)}};
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
    std::erase_if(variants, [](const auto& variant) {  // refused: it has no stretches
      return variant.first.find("strain=small") != std::string::npos &&
             variant.first.find("inversion=clamped") != std::string::npos;
    });
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
