// SPDX-License-Identifier: GPL-3.0-or-later
// The largest stable time step of the explicit methods.
#pragma once
#include <optional>

#include "solver/linear/linear_system.hpp"
#include "solver/model.hpp"

namespace msml::fe {

/// Largest eigenvalue w^2 of K x = w^2 M x on the free unknowns, from below, to a relative 1e-6 and better, by Lanczos
/// iterations (Lanczos 1950, doi 10.6028/jres.045.026). M is diagonal with positive entries, K symmetric. 0 if all
/// unknowns are fixed.
double largest_eigenvalue(const BlockMatrix& K, const ScalarMatrix& M, const Mask& fixed);

/// The largest time step at which no vibration x'' + (alpha + c) x' + w^2 x = 0 with 0 <= w^2 <= `largest` and 0 <= c
/// <= `damping` grows under an explicit method, for forward Euler with c = damping w^2/largest; infinite if nothing
/// acts. Without damping 2/w and, for forward Euler, 0. Otherwise, from Schur's criterion on the amplification matrix
/// of one step:
/// - symplectic Euler, damped by the velocity before the kick: (w dt)^2 + 2 (alpha + c) dt < 4,
///   so dt < 2 (sqrt(1 + z^2) - z)/w with z = (alpha + c)/(2 w);
/// - central differences, alpha x' with the velocity of the present, c x' with 3/2 and -1/2 of those of the last two
///   half steps: (w dt)^2 + 4 c dt < 4 at any alpha, so dt < 2 (sqrt(1 + 4 z^2) - 2 z)/w with z = c/(2 w);
/// - forward Euler: dt < 2 z/w with z = (alpha + c)/(2 w), or, overdamped, dt < 2 (z - sqrt(z^2 - 1))/w.
double stable_step(Integrator integrator, double largest, double alpha, double damping);

/// The largest time step of forward Euler for M x'' + C x' + K x = 0 on few free unknowns: |1 + dt l| <= 1 for every
/// eigenvalue l of the motion, so dt <= -2 Re l / |l|^2. 0 if a vibration is not damped; infinite if nothing moves but
/// freely. Nothing with more than `most_dense` free unknowns.
std::optional<double> forward_euler_step(const BlockMatrix& K, const BlockMatrix& C, const ScalarMatrix& M,
                                         const Mask& fixed);
/// The factor by which forward Euler lets the fastest growing motion grow in one step of dt: the largest |1 + dt l|.
/// Nothing with more than `most_dense` free unknowns.
std::optional<double> forward_euler_growth(const BlockMatrix& K, const BlockMatrix& C, const ScalarMatrix& M,
                                           const Mask& fixed, double dt);
inline constexpr int most_dense = 150;

}  // namespace msml::fe
