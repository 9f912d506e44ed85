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

/// A contact with its normal eliminated, in the eigenbasis of the Schur complement S. There, each lambda_t(s) costs two
/// divisions.
class SlidingContact {
 public:
  SlidingContact(const LocalContact& c, double mu) : mu_(mu), i_(1.0 / c.wnn), qn_(c.qn) {
    const double s11 = c.w11 - c.wn1 * c.wn1 * i_, s12 = c.w12 - c.wn1 * c.wn2 * i_, s22 = c.w22 - c.wn2 * c.wn2 * i_;
    const double b1 = -c.q1 + c.wn1 * c.qn * i_, b2 = -c.q2 + c.wn2 * c.qn * i_;
    const Eigen2 eigen(s11, s12, s22);
    vx_ = eigen.vx;
    vy_ = eigen.vy;
    const double least = 1e-12 * (std::abs(eigen.high) + c.wnn);
    e1_ = std::max(eigen.high, least);
    e2_ = std::max(eigen.low, least);
    g1_ = vx_ * b1 + vy_ * b2;
    g2_ = -vy_ * b1 + vx_ * b2;
    m1_ = vx_ * c.wn1 + vy_ * c.wn2;
    m2_ = -vy_ * c.wn1 + vx_ * c.wn2;
  }
  bool sticks() {
    excess(0);
    return size_ <= mu_ * n_;
  }
  /// Finds the s that puts the force on the cone, by Newton's method within a bracket.
  void slide() {
    double low = 0, high = e1_;  // excess(low) > 0
    for (int k = 0; k < 60 && excess(high) > 0; ++k) {
      low = high;
      high *= 4;
    }
    double s = high, f = excess(s);
    for (int k = 0; k < 60; ++k) {
      // d|t|/ds and dn/ds
      const double d1 = -t1_ / (e1_ + s), d2 = -t2_ / (e2_ + s);
      const double df = (size_ > 0 ? (t1_ * d1 + t2_ * d2) / size_ : 0) + mu_ * i_ * (m1_ * d1 + m2_ * d2);
      double next = df != 0 ? s - f / df : 0.5 * (low + high);
      if (!(next > low && next < high)) next = 0.5 * (low + high);
      const double step = next - s;
      s = next;
      f = excess(s);
      if (f > 0) low = s;
      else high = s;
      if (std::abs(step) <= 1e-15 * (s + e2_) || f == 0) break;
    }
    // On the cone to the last bit that matters.
    if (size_ > 0 && n_ > 0) {
      const double scale = mu_ * n_ / size_;
      t1_ *= scale;
      t2_ *= scale;
    }
  }
  void write(double* out) const {
    out[0] = n_;
    out[1] = vx_ * t1_ - vy_ * t2_;
    out[2] = vy_ * t1_ + vx_ * t2_;
  }

 private:
  /// Sets the force for s. Returns its distance outside of the cone, N.
  double excess(double s) {
    t1_ = g1_ / (e1_ + s);
    t2_ = g2_ / (e2_ + s);
    n_ = (-qn_ - m1_ * t1_ - m2_ * t2_) * i_;
    size_ = std::sqrt(t1_ * t1_ + t2_ * t2_);
    return size_ - mu_ * n_;
  }

  double mu_, i_, qn_;
  double vx_, vy_;                             ///< unit eigenvector of the larger eigenvalue
  double e1_, e2_;                             ///< eigenvalues of S
  double g1_, g2_;                             ///< right side of S lambda_t = b, in the eigenbasis
  double m1_, m2_;                             ///< coupling to the normal, in the eigenbasis
  double t1_ = 0, t2_ = 0, n_ = 0, size_ = 0;  ///< tangential force in the eigenbasis, normal force, |t|, N
};

/// Writes the force as (normal, tangent, tangent), N.
inline void solve_contact(const LocalContact& c, double mu, double* out) {
  out[0] = out[1] = out[2] = 0;
  if (c.qn >= 0 || !(c.wnn > 0)) return;  // the contact separates
  if (mu <= 0) {
    out[0] = -c.qn / c.wnn;
    return;
  }
  SlidingContact contact(c, mu);
  if (!contact.sticks()) contact.slide();
  contact.write(out);
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
