// SPDX-License-Identifier: GPL-3.0-or-later
// Symmetric matrices that multiply without being there in numbers.
#pragma once
#include "solver/block_matrix.hpp"

namespace msml::fe {

/// A symmetric matrix that multiplies at less cost than its numbers would have.
class Products {
 public:
  virtual ~Products() = default;
  /// y = A x.
  virtual void multiply(const Vector& x, Vector& y) const = 0;
  /// The same of eight vectors; Y has the size of X.
  virtual void multiply(const std::vector<Eight>& X, std::vector<Eight>& Y) const = 0;
  /// The matrix in numbers, made at each call: as dear as many products.
  virtual const BlockMatrix& matrix() const = 0;
};

/// A symmetric matrix in numbers or, where these are null, by its products.
struct SystemMatrix {
  const BlockMatrix* numbers = nullptr;
  const Products* products = nullptr;
  /// The matrix in numbers, which it has from here on.
  const BlockMatrix& in_numbers() {
    if (!numbers) *this = {&products->matrix()};
    return *numbers;
  }
};

inline void multiply(const SystemMatrix& A, const Vector& x, Vector& y) {
  if (A.numbers)
    multiply(*A.numbers, x, y);
  else
    A.products->multiply(x, y);
}

}  // namespace msml::fe
