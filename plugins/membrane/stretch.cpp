// SPDX-License-Identifier: GPL-3.0-or-later
// Plane-stress triangles.
#include "plugins/membrane/stretch.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "plugins/membrane/stretch_formula.h"

namespace insula {
namespace {

StretchOf<double> stretch_at(const double* x, const int node[3], const double (&b)[3][2]) {
  double u[3], v[3];
  for (int c = 0; c < 3; ++c) {
    u[c] = x[3 * node[1] + c] - x[3 * node[0] + c];
    v[c] = x[3 * node[2] + c] - x[3 * node[0] + c];
  }
  return stretch_of(u, v, b);
}

/// The part of a symmetric 2x2 matrix with eigenvalues above zero.
void keep_positive(double& a, double& b, double& d) {
  const double mean = 0.5 * (a + d), half = 0.5 * (a - d), radius = std::sqrt(half * half + b * b);
  if (mean - radius >= 0) return;
  const double top = mean + radius;
  if (top <= 0 || radius == 0) {
    a = b = d = std::max(0.0, top);
    b = 0;
    return;
  }
  // top times the projector (I + deviator / radius) / 2
  a = 0.5 * top * (1 + half / radius);
  d = 0.5 * top * (1 - half / radius);
  b = 0.5 * top * b / radius;
}

}  // namespace

void StretchTriangles::add(const std::vector<Vec3>& rest, const std::array<int, 3>& nodes, const Material& m) {
  Triangle t;
  Vec3 p[3];
  for (int k = 0; k < 3; ++k) {
    t.node[k] = nodes[std::size_t(k)];
    p[k] = rest[std::size_t(t.node[k])];
  }
  const Vec3 along = (p[1] - p[0]).normalized(), normal = (p[1] - p[0]).cross(p[2] - p[0]).normalized(),
             across = normal.cross(along);
  const double u1 = (p[1] - p[0]).dot(along), u2 = (p[2] - p[0]).dot(along), v2 = (p[2] - p[0]).dot(across),
               twice = u1 * v2;
  t.b[1][0] = v2 / twice;
  t.b[1][1] = -u2 / twice;
  t.b[2][0] = 0;
  t.b[2][1] = u1 / twice;
  for (int c = 0; c < 2; ++c) t.b[0][c] = -t.b[1][c] - t.b[2][c];
  const double weight = 0.5 * twice * m.thickness;
  t.mu = weight * m.young / (2 * (1 + m.poisson));
  t.lambda = weight * m.young * m.poisson / (1 - m.poisson * m.poisson);
  std::fill(std::begin(t.slot), std::end(t.slot), -1);
  std::fill(std::begin(t.pre), std::end(t.pre), 0.0);
  triangles_.push_back(t);
}

void StretchTriangles::couplings(std::vector<std::pair<int, int>>& pairs) const {
  for (const Triangle& t : triangles_)
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < i; ++j) pairs.emplace_back(t.node[i], t.node[j]);
}

// Nodes are in the order of the matrix, so no block is stored transposed. The sign of the normal has no effect.
void StretchTriangles::bind(const BlockMatrix& a, const std::vector<int>& free_of_node) {
  for (Triangle& t : triangles_) {
    int order[3] = {0, 1, 2};
    std::sort(order, order + 3, [&](int i, int j) {
      const int fi = free_of_node[std::size_t(t.node[i])], fj = free_of_node[std::size_t(t.node[j])];
      return fi != fj ? fi < fj : t.node[i] < t.node[j];
    });
    const Triangle old = t;
    for (int k = 0; k < 3; ++k) {
      t.node[k] = old.node[order[k]];
      t.b[k][0] = old.b[order[k]][0];
      t.b[k][1] = old.b[order[k]][1];
    }
    for (int i = 0, s = 0; i < 3; ++i)
      for (int j = 0; j <= i; ++j, ++s) {
        const int fi = free_of_node[std::size_t(t.node[i])], fj = free_of_node[std::size_t(t.node[j])];
        t.slot[s] = fi < 0 || fj < 0 ? -1 : a.slot(fi, fj);
      }
  }
  pack();
}

void StretchTriangles::pack() {
  batches_.resize((triangles_.size() + wall_lanes - 1) / wall_lanes);
  for (std::size_t i = 0; i < batches_.size(); ++i) {
    TriangleBatch& b = batches_[i];
    const std::size_t first = i * wall_lanes;
    b.count = int(std::min(triangles_.size() - first, std::size_t(wall_lanes)));
    for (int l = 0; l < wall_lanes; ++l) {
      const Triangle& t = triangles_[first + std::size_t(std::min(l, b.count - 1))];
      b.mu[l] = t.mu;
      b.lambda[l] = t.lambda;
      for (int k = 0; k < 3; ++k) {
        b.node[k][l] = t.node[k];
        b.pre[k][l] = t.pre[k];
        for (int c = 0; c < 2; ++c) b.b[k][c][l] = t.b[k][c];
      }
    }
  }
}

void StretchTriangles::prestrain(const double* rest, const double* u) {
  for (Triangle& t : triangles_) {
    double h[2][2] = {};  // gradient of u in the rest frame, whose axes are F at rest
    const StretchOf<double> s = stretch_at(rest, t.node, t.b);
    const Eigen::Map<const Vec3> f0(s.f0), f1(s.f1);
    for (int i = 0; i < 3; ++i) {
      const Eigen::Map<const Vec3> ui(u + 3 * t.node[i]);
      for (int c = 0; c < 2; ++c) {
        h[0][c] += f0.dot(ui) * t.b[i][c];
        h[1][c] += f1.dot(ui) * t.b[i][c];
      }
    }
    t.pre[0] -= h[0][0];
    t.pre[1] -= 0.5 * (h[0][1] + h[1][0]);
    t.pre[2] -= h[1][1];
  }
  pack();
}

void StretchTriangles::linearise(const double* x, double* force, BlockMatrix* stiffness, double scale,
                                 Tangent which) const {
  for (const TriangleBatch& b : batches_) wall_kernels().stretch(b, x, force);
  if (!stiffness) return;
  for (const Triangle& t : triangles_) {
    const StretchOf<double> s = stretch_at(x, t.node, t.b);
    const StressOf<double> stress = stress_of(s, t.mu, t.lambda, t.pre);
    const Eigen::Map<const Vec3> f0(s.f0), f1(s.f1);
    const double strain = s.trace - 2, trace = std::max(s.trace, 1e-9), d = stress.d, o = stress.o, h = stress.h;
    double g00 = stress.g00, g01 = stress.g01, g11 = stress.g11;
    const Vec3 r0 = f0 * s.i00 + f1 * s.i01, r1 = f0 * s.i01 + f1 * s.i11;
    const Vec3 n = f0.cross(f1) / std::max(s.det, 1e-30);
    double spin = ((t.mu + t.lambda) * strain + stress.z - h / trace) / trace;
    if (which == Tangent::system) {
      spin = std::max(spin, 0.0);
      keep_positive(g00, g01, g11);
    }
    const bool deviator = which == Tangent::exact && (d != 0 || o != 0);
    const Vec3 y0 = f0 * d + f1 * o, y1 = f0 * o - f1 * d;
    Vec3 g[3], p[3], y[3];
    for (int i = 0; i < 3; ++i) {
      y[i] = y0 * t.b[i][0] + y1 * t.b[i][1];
      g[i] = r0 * t.b[i][0] + r1 * t.b[i][1];
      p[i] = n.cross(g[i]);
    }
    const double mu = scale * t.mu, lambda = scale * t.lambda;
    for (int i = 0, slot = 0; i < 3; ++i)
      for (int j = 0; j <= i; ++j, ++slot) {
        if (t.slot[slot] < 0) continue;
        double* out = stiffness->block(t.slot[slot]);
        const double hooke = mu * g[i].dot(g[j]);
        const double tension =
            scale * (t.b[i][0] * (g00 * t.b[j][0] + g01 * t.b[j][1]) + t.b[i][1] * (g01 * t.b[j][0] + g11 * t.b[j][1]));
        const double across = tension - hooke;
        for (int c = 0; c < 3; ++c) {
          const double gi = mu * g[i][c], gj = lambda * g[j][c], pj = scale * spin * p[j][c], nc = across * n[c];
          for (int r = 0; r < 3; ++r) out[3 * c + r] += gi * g[j][r] + gj * g[i][r] + pj * p[i][r] + nc * n[r];
          out[4 * c] += hooke;
        }
        if (!deviator) continue;
        const double both = t.b[i][0] * (d * t.b[j][0] + o * t.b[j][1]) + t.b[i][1] * (o * t.b[j][0] - d * t.b[j][1]);
        Eigen::Map<Mat3>(out, 3, 3) +=
            2 * scale / trace *
            (both * (Mat3::Identity() - n * n.transpose()) -
             (y[i] * g[j].transpose() + g[i] * y[j].transpose() - h * g[i] * g[j].transpose()) / trace);
      }
  }
}

void StretchTriangles::add_stress(const double* x, const std::vector<int>& of, const std::vector<double>& volume,
                                  std::vector<Mat3>& stress) const {
  for (std::size_t i = 0; i < triangles_.size(); ++i) {
    const Triangle& t = triangles_[i];
    const StretchOf<double> s = stretch_at(x, t.node, t.b);
    const StressOf<double> p = stress_of(s, t.mu, t.lambda, t.pre);
    const auto v = [](const double(&a)[3]) { return Eigen::Map<const Vec3>(a); };
    stress[std::size_t(of[i])] += (v(p.p0) * v(s.f0).transpose() + v(p.p1) * v(s.f1).transpose()) / (volume[i] * s.det);
  }
}

double StretchTriangles::energy(const double* x) const {
  double sum = 0;
  for (const Triangle& t : triangles_) {
    const StretchOf<double> s = stretch_at(x, t.node, t.b);
    const double strain = s.trace - 2 + t.pre[0] + t.pre[2];
    // |e|^2 = tr C - 2 tr S + 2, in a form without cancellation: |S - I|^2 with S = (C + det I) / tr S.
    const double e00 = (s.c00 + s.det) / s.trace - 1 + t.pre[0], e01 = s.c01 / s.trace + t.pre[1],
                 e11 = (s.c11 + s.det) / s.trace - 1 + t.pre[2];
    sum += t.mu * (e00 * e00 + 2 * e01 * e01 + e11 * e11) + 0.5 * t.lambda * strain * strain;
  }
  return sum;
}

}  // namespace insula
