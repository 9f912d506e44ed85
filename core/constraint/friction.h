// SPDX-License-Identifier: GPL-3.0-or-later
// Friction of one contact, and of a patch of contacts. One contact with Coulomb friction is solved exactly: Signorini's
// condition on the normal, |lambda_t| <= mu lambda_n with the tangential force opposite to the slip.
//   sticking   lambda = -W^-1 q, if inside the cone
//   sliding    delta_n = 0, delta_t = -s lambda_t with s > 0 and |lambda_t| = mu lambda_n: with the normal eliminated
//              (S + s I) lambda_t = b, S the 2x2 Schur complement; one scalar equation for s, bracketed Newton.
#pragma once
#include <algorithm>
#include <cmath>

namespace insula {

struct LocalContact {
  double wnn, wn1, wn2, w11, w12, w22;  ///< block of W (symmetric), m/N
  double qn, q1, q2;                    ///< delta with lambda of this contact at zero, m
};

/// Eigenvalues of a symmetric 2x2 matrix, and the unit eigenvector of the larger one.
struct Eigen2 {
  double high, low, vx = 1, vy = 0;
  Eigen2(double a11, double a12, double a22) {
    const double mean = 0.5 * (a11 + a22), half = 0.5 * (a11 - a22), radius = std::sqrt(half * half + a12 * a12);
    high = mean + radius;
    low = mean - radius;
    if (!(radius > 0)) return;
    vx = half >= 0 ? half + radius : a12;
    vy = half >= 0 ? a12 : radius - half;
    const double norm = std::sqrt(vx * vx + vy * vy);
    vx /= norm;
    vy /= norm;
  }
};

/// Writes (normal, tangent, tangent) in newtons.
inline void solve_contact(const LocalContact& c, double mu, double* out) {
  out[0] = out[1] = out[2] = 0;
  if (c.qn >= 0 || !(c.wnn > 0)) return;  // separates
  if (mu <= 0) {
    out[0] = -c.qn / c.wnn;
    return;
  }
  // The normal is eliminated: S lambda_t = b holds in sticking.
  const double i = 1.0 / c.wnn;
  const double s11 = c.w11 - c.wn1 * c.wn1 * i, s12 = c.w12 - c.wn1 * c.wn2 * i, s22 = c.w22 - c.wn2 * c.wn2 * i;
  const double b1 = -c.q1 + c.wn1 * c.qn * i, b2 = -c.q2 + c.wn2 * c.qn * i;
  // With the eigenvalues and eigenvectors of S, each lambda_t(s) costs two divisions.
  const Eigen2 eigen(s11, s12, s22);
  const double vx = eigen.vx, vy = eigen.vy;
  const double least = 1e-12 * (std::abs(eigen.high) + c.wnn);
  const double e1 = std::max(eigen.high, least), e2 = std::max(eigen.low, least);
  const double g1 = vx * b1 + vy * b2, g2 = -vy * b1 + vx * b2;              // b in the eigenbasis
  const double m1 = vx * c.wn1 + vy * c.wn2, m2 = -vy * c.wn1 + vx * c.wn2;  // normal coupling in the eigenbasis
  double s = 0, t1 = g1 / e1, t2 = g2 / e2;
  auto normal = [&] { return (-c.qn - m1 * t1 - m2 * t2) * i; };
  double n = normal();
  double size = std::sqrt(t1 * t1 + t2 * t2);
  if (!(size <= mu * n)) {
    double low = 0, high = e1;  // f(low) > 0
    auto excess = [&](double at) {
      t1 = g1 / (e1 + at);
      t2 = g2 / (e2 + at);
      n = normal();
      size = std::sqrt(t1 * t1 + t2 * t2);
      return size - mu * n;
    };
    for (int k = 0; k < 60 && excess(high) > 0; ++k) {
      low = high;
      high *= 4;
    }
    s = high;
    double f = excess(s);
    for (int k = 0; k < 60; ++k) {
      // d|t|/ds and dn/ds
      const double d1 = -t1 / (e1 + s), d2 = -t2 / (e2 + s);
      const double df = (size > 0 ? (t1 * d1 + t2 * d2) / size : 0) + mu * i * (m1 * d1 + m2 * d2);
      double next = df != 0 ? s - f / df : 0.5 * (low + high);
      if (!(next > low && next < high)) next = 0.5 * (low + high);
      const double step = next - s;
      s = next;
      f = excess(s);
      if (f > 0) low = s;
      else high = s;
      if (std::abs(step) <= 1e-15 * (s + e2) || f == 0) break;
    }
    // Onto the cone, to the last significant bit.
    if (size > 0 && n > 0) {
      const double scale = mu * n / size;
      t1 *= scale;
      t2 *= scale;
    }
  }
  out[0] = n;
  out[1] = vx * t1 - vy * t2;
  out[2] = vy * t1 + vx * t2;
}

/// Coulomb friction of given strength: |lambda| <= bound, opposite to the slip w lambda + q, with w symmetric 2x2.
/// Writes two numbers, N.
inline void solve_disc(double w11, double w12, double w22, double q1, double q2, double bound, double* out) {
  out[0] = out[1] = 0;
  if (!(bound > 0) || !(w11 + w22 > 0)) return;
  const Eigen2 eigen(w11, w12, w22);
  const double vx = eigen.vx, vy = eigen.vy;
  const double e1 = eigen.high, e2 = std::max(eigen.low, 1e-12 * eigen.high);
  const double g1 = -(vx * q1 + vy * q2), g2 = -(-vy * q1 + vx * q2);  // in the eigenbasis
  double t1 = g1 / e1, t2 = g2 / e2, size = std::sqrt(t1 * t1 + t2 * t2);
  // (w + s) lambda = -q with |lambda| = bound. 1/|lambda| is nearly linear in s, so Newton's method converges from
  // below in a few steps.
  double s = 0;
  for (int k = 0; k < 60 && size > bound * (1 + 1e-15); ++k) {
    const double slope = -(t1 * t1 / (e1 + s) + t2 * t2 / (e2 + s)) / size;  // d|lambda|/ds
    const double step = (size - bound) * size / (-slope * bound);
    if (!(step > 1e-15 * (s + e2))) break;
    s += step;
    t1 = g1 / (e1 + s);
    t2 = g2 / (e2 + s);
    size = std::sqrt(t1 * t1 + t2 * t2);
  }
  if (size > bound) {
    t1 *= bound / size;
    t2 *= bound / size;
  }
  out[0] = vx * t1 - vy * t2;
  out[1] = vy * t1 + vx * t2;
}

}  // namespace insula
