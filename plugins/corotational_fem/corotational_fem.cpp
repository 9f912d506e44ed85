// SPDX-License-Identifier: GPL-3.0-or-later
/*
# corotational_fem

Co-rotational linear finite elements on tetrahedra: small strain in a frame that turns with each element, isotropic
Hooke's law. With F the deformation gradient, F = R S (polar), e = S - I:

    energy density   mu |e|^2 + lambda/2 tr(e)^2
    P = R (2 mu e + lambda tr(e) I),   force on node i = -V P b_i,   b_i the rest gradient of its shape function

which is the exact gradient of the energy. Hooke's law lets an element be crushed flat, and through itself, by a few times
E; soft tissue stiffens long before. So a principal stretch s below `least_stretch` s0 costs in addition

    energy density   stiffening E / 2 (s0 - s)^2           (s < s0; nothing above)

which keeps elements under a tool's tip from inverting and leaves the law as it is elsewhere. Hooke's exact derivative adds
to the rotated stiffness a term on the spin of the element; it is part of `tangent="exact"` with negative eigenvalues set to
zero, and left out otherwise.

Sources: Felippa, Haugen 2005 (co-rotational formulation); Mueller, Gross 2004; Dequidt et al. 2015, section 3.1; Smith,
de Goes, Kim 2019 (Hessian of energies of the principal stretches).
*/
#include <Eigen/Eigenvalues>
#include <cmath>

#include "core/mechanics/soft_body.h"
#include "core/registry/registry.h"
#include "plugins/corotational_fem/polar.h"

namespace insula {
namespace {

class CorotationalFem final : public ForceModel {
 public:
  Param<Pressure> young{this, {.name = "young", .fallback = "2100 Pa", .min = "1 Pa", .max = "1 GPa", .doc = "Young's modulus"}};
  Param<Scalar> poisson{this, {.name = "poisson", .fallback = "0.45", .min = "0", .max = "0.495", .doc = "Poisson's ratio"}};
  Param<Density> density{this, {.name = "density", .fallback = "1 g/cm3", .min = "0.01 g/cm3", .max = "25 g/cm3", .doc = "mass density"}};
  Param<Rate> rayleigh_mass{this, {.name = "rayleigh_mass", .fallback = "1 1/s", .min = "0 1/s", .max = "1000 1/s", .doc = "Rayleigh damping in proportion to mass"}};
  Param<Duration> rayleigh_stiffness{this, {.name = "rayleigh_stiffness", .fallback = "20 ms", .min = "0 s", .max = "1 s", .doc = "Rayleigh damping in proportion to stiffness"}};
  Param<Choice> tangent{this, {.name = "tangent", .fallback = "rotated", .choices = {"rotated", "exact"}, .doc = "stiffness used in a step: rotated Hooke, or with the element's spin as well"}};

  Param<Scalar> least_stretch{this, {.name = "least_stretch", .fallback = "0.4", .min = "0", .max = "0.9", .doc = "principal stretch below which an element stiffens; 0: only once it is inverted"}};
  Param<Scalar> stiffening{this, {.name = "stiffening", .fallback = "30", .min = "0", .max = "1000", .doc = "stiffness below that stretch, in Young's moduli; 0: none"}};

  void attach(PrepareContext& context, DeformableBody& body) override;
  void couplings(std::vector<std::pair<int, int>>& pairs, Tangent) const override;
  void bind(const BlockMatrix& a, const std::vector<int>& free_of_node) override;
  void add_mass(std::vector<double>& mass, std::vector<double>& damping) const override;
  void linearise(const double* x, double* force, BlockMatrix* stiffness, double h, Tangent which) override;
  double energy(const double* x) override;
  double stiffness_damping() const override { return rayleigh_stiffness(); }
  void reset() override;

 private:
  struct Element {
    int node[4];
    int slot[10];          // blocks (0,0) (1,0) (1,1) (2,0) ...; -1 where a node is held
    bool transpose[10];    // the pair is stored the other way round
    double volume;
    double b[4][3];        // rest gradients of the shape functions, 1/m
  };
  Mat3 gradient(const Element& e, const double* x) const;
  bool crushed(const Mat3& strain) const;
  void stiffen(const Element& e, const Mat3& r, const Mat3& s, double* force, BlockMatrix* stiffness, double scale, bool project) const;
  void spin_stiffness(const Mat3& r, const Mat3& s, double mu, double lambda, bool project, Mat3& out) const;

  std::vector<Element> elements_;
  std::vector<Quat> rotation_;
  int nodes_ = 0;
};

void CorotationalFem::attach(PrepareContext& context, DeformableBody& body) {
  const auto* solid = dynamic_cast<const SoftBody*>(&body);
  if (!solid) return error(context, "needs tetrahedra: it belongs in a <soft_body>");
  const TetMesh& mesh = solid->rest();
  nodes_ = body.nodes();
  elements_.resize(mesh.tets.size());
  for (std::size_t t = 0; t < mesh.tets.size(); ++t) {
    Element& e = elements_[t];
    Vec3 p[4];
    for (int k = 0; k < 4; ++k) {
      e.node[k] = mesh.tets[t][std::size_t(k)];
      p[k] = mesh.nodes[std::size_t(e.node[k])];
    }
    Mat3 d;
    d << p[1] - p[0], p[2] - p[0], p[3] - p[0];
    e.volume = d.determinant() / 6;
    const Mat3 inverse = d.inverse();
    Vec3 sum = Vec3::Zero();
    for (int k = 1; k < 4; ++k) {
      const Vec3 g = inverse.row(k - 1);
      sum += g;
      Eigen::Map<Vec3>(e.b[k]) = g;
    }
    Eigen::Map<Vec3>(e.b[0]) = -sum;
  }
  reset();
}

void CorotationalFem::reset() { rotation_.assign(elements_.size(), Quat::Identity()); }

void CorotationalFem::couplings(std::vector<std::pair<int, int>>& pairs, Tangent) const {
  for (const Element& e : elements_)
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < i; ++j) pairs.emplace_back(e.node[i], e.node[j]);
}

void CorotationalFem::bind(const BlockMatrix& a, const std::vector<int>& free_of_node) {
  for (Element& e : elements_)
    for (int i = 0, k = 0; i < 4; ++i)
      for (int j = 0; j <= i; ++j, ++k) {
        const int fi = free_of_node[std::size_t(e.node[i])], fj = free_of_node[std::size_t(e.node[j])];
        e.transpose[k] = fi < fj;
        e.slot[k] = fi < 0 || fj < 0 ? -1 : a.slot(std::max(fi, fj), std::min(fi, fj));
      }
}

void CorotationalFem::add_mass(std::vector<double>& mass, std::vector<double>& damping) const {
  for (const Element& e : elements_)
    for (int n : e.node) {
      const double m = density() * e.volume / 4;
      mass[std::size_t(n)] += m;
      damping[std::size_t(n)] += rayleigh_mass() * m;
    }
}

Mat3 CorotationalFem::gradient(const Element& e, const double* x) const {
  Mat3 f = Mat3::Zero();
  for (int k = 0; k < 4; ++k) {
    const double* p = x + 3 * e.node[k];
    for (int c = 0; c < 3; ++c) {
      f(0, c) += p[0] * e.b[k][c];
      f(1, c) += p[1] * e.b[k][c];
      f(2, c) += p[2] * e.b[k][c];
    }
  }
  return f;
}

// G' = R (2 mu I - 2 (2 mu - lambda tr e) (tr(S) I - S)^-1) R^T: how the spin of the element resists.
void CorotationalFem::spin_stiffness(const Mat3& r, const Mat3& s, double mu, double lambda, bool project, Mat3& out) const {
  const double trace = s.trace();
  const double k = 2 * (2 * mu - lambda * (trace - 3));
  if (!project) {
    const Mat3 g = 2 * mu * Mat3::Identity() - k * (trace * Mat3::Identity() - s).inverse();
    out = r * g * r.transpose();
    return;
  }
  Eigen::SelfAdjointEigenSolver<Mat3> eigen;
  eigen.computeDirect(s);
  Vec3 g;
  for (int i = 0; i < 3; ++i) {
    const double gap = trace - eigen.eigenvalues()[i];
    g[i] = gap > 1e-9 ? std::max(0.0, 2 * mu - k / gap) : 0.0;
  }
  const Mat3 v = r * eigen.eigenvectors();
  out = v * g.asDiagonal() * v.transpose();
}

// No principal stretch is less than 1 - |e|: spares nearly every element the eigenvalues.
bool CorotationalFem::crushed(const Mat3& strain) const {
  const double far = 1 - least_stretch();
  return stiffening() > 0 && strain.squaredNorm() > far * far;
}

// Energy sum of f(s_i) over the principal stretches, F = U diag(s) V^T with U = R Q, V = Q, S = Q diag(s) Q^T. In that
// basis the Hessian is diagonal: stretches f'', shears (f'_i - f'_j)/(s_i - s_j), spins (f'_i + f'_j)/(s_i + s_j)
// (Smith, de Goes, Kim 2019, "Analytic eigensystems for isotropic distortion energies").
void CorotationalFem::stiffen(const Element& e, const Mat3& r, const Mat3& s, double* force, BlockMatrix* stiffness, double scale,
                              bool project) const {
  Eigen::SelfAdjointEigenSolver<Mat3> eigen;
  eigen.computeDirect(s);
  const Vec3 stretch = eigen.eigenvalues();
  if (stretch[0] >= least_stretch()) return;
  const Mat3 v = eigen.eigenvectors(), u = r * v;
  const double k = stiffening() * young();
  Vec3 slope, curve;
  for (int i = 0; i < 3; ++i) {
    slope[i] = std::min(0.0, k * (stretch[i] - least_stretch()));
    curve[i] = slope[i] < 0 ? k : 0;
  }
  Vec3 b[4];  // rest gradients in the principal frame
  for (int n = 0; n < 4; ++n) {
    b[n] = v.transpose() * Vec3(e.b[n][0], e.b[n][1], e.b[n][2]);
    Eigen::Map<Vec3> f(force + 3 * e.node[n]);
    f -= e.volume * (u * slope.cwiseProduct(b[n]));
  }
  if (!stiffness) return;
  double shear[3][3], spin[3][3];
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < i; ++j) {
      const double apart = stretch[i] - stretch[j], sum = stretch[i] + stretch[j];
      shear[i][j] = std::abs(apart) > 1e-9 ? (slope[i] - slope[j]) / apart : 0.5 * (curve[i] + curve[j]);
      spin[i][j] = std::abs(sum) > 1e-9 ? (slope[i] + slope[j]) / sum : 0;
      if (project) spin[i][j] = std::max(0.0, spin[i][j]);
      shear[j][i] = shear[i][j];
      spin[j][i] = spin[i][j];
    }
  for (int n = 0, slot = 0; n < 4; ++n)
    for (int m = 0; m <= n; ++m, ++slot) {
      if (e.slot[slot] < 0) continue;
      const Vec3& row = e.transpose[slot] ? b[m] : b[n];
      const Vec3& column = e.transpose[slot] ? b[n] : b[m];
      Mat3 h;
      for (int i = 0; i < 3; ++i) {
        h(i, i) = curve[i] * row[i] * column[i];
        for (int j = 0; j < 3; ++j) {
          if (i == j) continue;
          h(i, i) += 0.5 * (shear[i][j] + spin[i][j]) * row[j] * column[j];
          h(i, j) = 0.5 * (shear[i][j] - spin[i][j]) * row[j] * column[i];
        }
      }
      const Mat3 turned = scale * e.volume * (u * h * u.transpose());
      double* out = stiffness->block(e.slot[slot]);
      for (int c = 0; c < 9; ++c) out[c] += turned.data()[c];
    }
}

void CorotationalFem::linearise(const double* x, double* force, BlockMatrix* stiffness, double h, Tangent which) {
  const double mu = young() / (2 * (1 + poisson()));
  const double lambda = young() * poisson() / ((1 + poisson()) * (1 - 2 * poisson()));
  const double scale = 1 + (h > 0 ? rayleigh_stiffness() / h : 0);
  const bool spin = which == Tangent::exact || tangent.is("exact");
  for (std::size_t t = 0; t < elements_.size(); ++t) {
    const Element& e = elements_[t];
    const Mat3 f = gradient(e, x);
    const Mat3 r = polar_rotation(f, rotation_[t]);
    Mat3 s = r.transpose() * f;
    s = (0.5 * (s + s.transpose())).eval();
    Mat3 strain = s;
    strain.diagonal().array() -= 1;
    Mat3 stress = 2 * mu * strain;
    stress.diagonal().array() += lambda * strain.trace();
    const Mat3 p = e.volume * r * stress;
    double g[4][3];  // rest gradients turned with the element
    for (int k = 0; k < 4; ++k) {
      const double* b = e.b[k];
      double* fk = force + 3 * e.node[k];
      for (int c = 0; c < 3; ++c) {
        fk[c] -= p(c, 0) * b[0] + p(c, 1) * b[1] + p(c, 2) * b[2];
        g[k][c] = r(c, 0) * b[0] + r(c, 1) * b[1] + r(c, 2) * b[2];
      }
    }
    if (crushed(strain)) stiffen(e, r, s, force, stiffness, scale, which == Tangent::system);
    if (!stiffness) continue;
    const double wm = scale * e.volume * mu, wl = scale * e.volume * lambda;
    Mat3 spin_g;
    if (spin) {
      spin_stiffness(r, s, mu, lambda, which == Tangent::system, spin_g);
      spin_g *= 0.5 * scale * e.volume;
    }
    for (int i = 0, k = 0; i < 4; ++i)
      for (int j = 0; j <= i; ++j, ++k) {
        if (e.slot[k] < 0) continue;
        // K_ij = V (mu (g_i.g_j) I + mu g_j g_i^T + lambda g_i g_j^T); stored with the row node first.
        const double* gi = e.transpose[k] ? g[j] : g[i];
        const double* gj = e.transpose[k] ? g[i] : g[j];
        double* out = stiffness->block(e.slot[k]);
        const double d = wm * (gi[0] * gj[0] + gi[1] * gj[1] + gi[2] * gj[2]);
        for (int c = 0; c < 3; ++c)
          for (int q = 0; q < 3; ++q) out[3 * c + q] += wm * gj[q] * gi[c] + wl * gi[q] * gj[c];
        out[0] += d;
        out[4] += d;
        out[8] += d;
        if (spin) {
          const Mat3 m = skew(Vec3(gi[0], gi[1], gi[2])).transpose() * spin_g * skew(Vec3(gj[0], gj[1], gj[2]));
          for (int c = 0; c < 9; ++c) out[c] += m.data()[c];
        }
      }
  }
}

double CorotationalFem::energy(const double* x) {
  const double mu = young() / (2 * (1 + poisson()));
  const double lambda = young() * poisson() / ((1 + poisson()) * (1 - 2 * poisson()));
  double sum = 0;
  for (std::size_t t = 0; t < elements_.size(); ++t) {
    const Element& e = elements_[t];
    const Mat3 f = gradient(e, x);
    Quat q = rotation_[t];
    const Mat3 r = polar_rotation(f, q);
    Mat3 strain = r.transpose() * f;
    strain = (0.5 * (strain + strain.transpose())).eval();
    strain.diagonal().array() -= 1;
    const double trace = strain.trace();
    sum += e.volume * (mu * strain.squaredNorm() + 0.5 * lambda * trace * trace);
    if (!crushed(strain)) continue;
    Eigen::SelfAdjointEigenSolver<Mat3> eigen;
    eigen.computeDirect(strain, Eigen::EigenvaluesOnly);
    for (int i = 0; i < 3; ++i) {
      const double short_of = std::max(0.0, least_stretch() - 1 - eigen.eigenvalues()[i]);
      sum += e.volume * 0.5 * stiffening() * young() * short_of * short_of;
    }
  }
  return sum;
}

}  // namespace
}  // namespace insula

INSULA_PLUGIN(corotational_fem) {
  registry.add<insula::CorotationalFem>("corotational_fem", insula::Kind::force_model,
                                        "co-rotational linear elasticity on the body's tetrahedra");
}
