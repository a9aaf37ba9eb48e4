// SPDX-License-Identifier: GPL-3.0-or-later
// The matrix of a time step by its products.
#pragma once
#include "solver/elements/assembly.hpp"
#include "solver/linear/products.hpp"

namespace msml::fe {

/// K + s M with a tangent that the elements keep.
class EffectiveProducts final : public Products {
 public:
  /// `room` becomes the matrix where numbers are asked for.
  EffectiveProducts(const KeptTangent& K, double s, const ScalarMatrix& M, BlockMatrix& room)
      : K_(K), s_(s), M_(M), room_(room) {}
  void multiply(const Vector& x, Vector& y) const override { K_.multiply(s_, M_, x, y); }
  void multiply(const std::vector<Eight>& X, std::vector<Eight>& Y) const override { K_.multiply(s_, M_, X, Y); }
  const BlockMatrix& matrix() const override {
    K_.assemble(room_);
    add(room_, s_, M_);
    return room_;
  }

 private:
  const KeptTangent& K_;
  double s_;
  const ScalarMatrix& M_;
  BlockMatrix& room_;
};

}  // namespace msml::fe
