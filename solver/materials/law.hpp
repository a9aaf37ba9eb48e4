// SPDX-License-Identifier: GPL-3.0-or-later
// The interface of a constitutive law: batches of points in, energies, stresses and tangents out.
#pragma once
#include <array>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "solver/materials/lanes.hpp"

namespace msml::fe {

/// Displacement gradient H = du/dX = F - I of eight points (H rather than F keeps small strains exact).
using Gradients = Tensor<Lanes>;

/// What a law gives for points of scalar T, per reference volume.
template <class T>
struct ResponseOf {
  T energy;       ///< W(F), with W(I) = 0
  Tensor<T> P;    ///< first Piola stress dW/dF
  T tangent[45];  ///< d2W/dF2, lower triangle by rows: entry (I, J), I >= J, at I(I+1)/2 + J; I = 3 i + k for F_ik
};
using Response = ResponseOf<Lanes>;

/// The same where the tangent is that of Hooke's law turned by a rotation R (I in small strain): dP_ik/dF_jl =
/// mu (d_ij d_kl + R_il R_jk) + lambda R_ik R_jl.
struct RotatedResponse {
  Lanes energy, mu, lambda;
  Tensor<Lanes> P, R;
};

/// What of a Response is wanted; energy and stress always. `tangent` is the law's own choice for Newton's method,
/// `single_tangent` its choice where each step has one linear solve, `definite_tangent` a positive semidefinite
/// replacement for Newton steps where the exact one is indefinite.
enum class Want { stress, tangent, single_tangent, definite_tangent };

/// What one reads off a law for eight points.
struct Measures {
  Tensor<Lanes> cauchy;  ///< Cauchy stress
  Tensor<Lanes> strain;  ///< the strain of the law
  Lanes energy;
};

class Law;

/// A law taken apart: W = rest + modulus/2 g^2, where g(F) measures the volume change (ln J, J - 1, I3 - 1, tr H, …).
struct Split {
  std::shared_ptr<const Law> rest;        ///< W without its volumetric term
  std::shared_ptr<const Law> constraint;  ///< g as if it were an energy: Response holds g, dg/dF and d2g/dF2
  Lanes modulus = lanes_of(std::numeric_limits<double>::infinity());  ///< stress; infinite if incompressible
};

/// Place of entry (i, j), i >= j, in Response::tangent.
constexpr int packed_at(int i, int j) { return i * (i + 1) / 2 + j; }

/// A hyperelastic material law. Immutable, so that threads share it. One virtual call serves a whole batch.
class Law {
 public:
  virtual ~Law() = default;
  /// Fills responses[i] from gradients[i]; both have the same length.
  virtual void evaluate(Want want, std::span<const Gradients> gradients, std::span<Response> responses) const = 0;
  /// False where the tangent of `want` does not have this form; otherwise fills responses[i] from gradients[i].
  virtual bool evaluate_rotated(Want /*want*/, std::span<const Gradients> /*gradients*/,
                                std::span<RotatedResponse> /*responses*/) const {
    return false;
  }
  /// Fills measures[i] from gradients[i].
  virtual void measure(std::span<const Gradients> gradients, std::span<Measures> measures) const = 0;
  virtual std::string name() const = 0;      ///< the tag of the language
  virtual double poisson_ratio() const = 0;  ///< of the small-strain limit
  virtual double shear_modulus() const = 0;  ///< of the small-strain limit, stress
  /// True if Want::tangent is the derivative of the stress; otherwise Newton's method converges, but not quadratically.
  virtual bool exact_tangent() const { return true; }
  /// The law taken apart for elements that treat the volume change apart; nothing where it cannot be.
  virtual std::optional<Split> split() const { return std::nullopt; }
  /// True if energy and stress are finite and smooth where det F <= 0.
  virtual bool survives_inversion() const { return false; }
  /// True if the volume cannot change. Such a law is of use through split() alone: evaluate() leaves out the pressure.
  virtual bool incompressible() const { return false; }
  /// True if the response is the same in all directions; otherwise the moduli above are typical ones.
  virtual bool isotropic() const { return true; }
  /// The unit vector along the first family of fibres in the reference configuration; nothing where there are none.
  virtual std::optional<std::array<Lanes, 3>> fibre() const { return std::nullopt; }
  /// The law whose lane k has the parameters of others[k], all of them of this kind; null where it cannot be made.
  virtual std::shared_ptr<const Law> merged(std::span<const std::shared_ptr<const Law>> /*others*/) const { return {}; }
  /// Unknowns per node: 3 displacements, or 1 for a scalar problem, whose gradient is row 0 of H.
  virtual int components() const { return 3; }
  /// Sets the entries of H that the law itself determines (plane stress: H_33 such that P_33 = 0).
  virtual void complete(std::span<Gradients> /*gradients*/) const {}
  virtual bool small_strain() const { return false; }  ///< true if the law is linear in H and sees no rotation
};

}  // namespace msml::fe
