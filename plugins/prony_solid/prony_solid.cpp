// SPDX-License-Identifier: GPL-3.0-or-later
/*
# prony_solid

A viscoelastic solid on tetrahedra: an elastic spring beside two Maxwell elements (a Prony series of two terms). The
stress relaxes from the sum of all moduli to the elastic one. With F the deformation gradient, E = (F^T F - I) / 2 the
Green strain and C(young) Hooke's law of that modulus:

    S = C(young) E + H_1 + H_2,     dH_k/dt = C(young_k) dE/dt - H_k / time_k
    force on node i = -V F S b_i,   b_i the rest gradient of its shape function

A step of length h integrates each H_k by implicit Euler, so a strain that is held relaxes by 1 / (1 + h / time_k) a
step. The part of H_k in the step depends on velocity and enters the system matrix as damping:

    H_k(t+h) = (H_k + h C(young_k) dE/dt) / (1 + h / time_k)

Source: Simo, Hughes, Computational Inelasticity, 1998, chapter 10 (finite linear viscoelasticity).
*/
#include <Eigen/Eigenvalues>
#include <array>

#include "core/mechanics/soft_body.h"
#include "core/registry/registry.h"

namespace insula {
namespace {

/// Lame's parameters, Pa.
struct Moduli {
  double mu, lambda;
  Mat3 stress(const Mat3& strain) const { return 2 * mu * strain + lambda * strain.trace() * Mat3::Identity(); }
  /// J/m3, of a stress of this law.
  double energy_of_stress(const Mat3& s) const {
    if (!(mu > 0)) return 0;
    const double trace = s.trace();
    return (s.squaredNorm() - lambda / (3 * lambda + 2 * mu) * trace * trace) / (4 * mu);
  }
};

class PronySolid final : public ForceModel {
 public:
  Param<Pressure> young{this,
                        {.name = "young",
                         .fallback = "1 kPa",
                         .min = "1 Pa",
                         .max = "1 GPa",
                         .doc = "Young's modulus that is left when all has relaxed"}};
  Param<Scalar> poisson{
      this,
      {.name = "poisson", .fallback = "0.45", .min = "0", .max = "0.495", .doc = "Poisson's ratio of all moduli"}};
  Param<Density> density{
      this, {.name = "density", .fallback = "1 g/cm3", .min = "0.001 g/cm3", .max = "25 g/cm3", .doc = "mass density"}};
  Param<Pressure> young_1{this,
                          {.name = "young_1",
                           .fallback = "2 kPa",
                           .min = "0 Pa",
                           .max = "1 GPa",
                           .doc = "Young's modulus of the first Maxwell element"}};
  Param<Duration> time_1{this,
                         {.name = "time_1",
                          .fallback = "100 ms",
                          .min = "1 ms",
                          .max = "1000 s",
                          .doc = "relaxation time of the first Maxwell element"}};
  Param<Pressure> young_2{this,
                          {.name = "young_2",
                           .fallback = "0 Pa",
                           .min = "0 Pa",
                           .max = "1 GPa",
                           .doc = "Young's modulus of the second Maxwell element; 0: there is none"}};
  Param<Duration> time_2{this,
                         {.name = "time_2",
                          .fallback = "1 s",
                          .min = "1 ms",
                          .max = "1000 s",
                          .doc = "relaxation time of the second Maxwell element"}};

  void attach(PrepareContext& context, DeformableBody& body) override;
  void couplings(std::vector<std::pair<int, int>>& pairs, Tangent) const override;
  void bind(const BlockMatrix& a, const std::vector<int>& free_of_node) override;
  void add_mass(std::vector<double>& mass, std::vector<double>&) const override;
  void linearise(const double* x, double* force, BlockMatrix* stiffness, double h, Tangent which) override;
  bool has_damping() const override { return true; }
  void linearise_damping(const double* x, const double* v, double* force, BlockMatrix* damping, double h) override;
  double energy(const double* x) override;
  bool add_stress(const double* x, std::vector<Mat3>& stress) const override;
  bool finish(const StepContext& context, const double* x) override;
  void reset() override;
  void append_state(std::vector<double>& out) const override;

 private:
  static constexpr std::size_t branches = 2;
  struct Element {
    std::array<int, 4> node;
    std::array<Vec3, 4> b;                   ///< rest gradients of the shape functions, 1/m
    double volume;                           ///< m3
    std::array<std::array<int, 4>, 4> slot;  ///< block of the matrix in its lower triangle, else -1
    Mat3 strain = Mat3::Zero();              ///< Green's, at the end of the last step
    std::array<Mat3, branches> branch{Mat3::Zero(), Mat3::Zero()};  ///< H_k then, Pa

    /// Sum of a vector at the nodes times the gradients: F of positions, dF/dt of velocities.
    Mat3 gradient(const double* x) const;
    void add_force(const Mat3& f, const Mat3& s, double* force) const;
    /// Adds the matrix of Hooke's law at F to the blocks, and the geometric stiffness of a stress.
    void add_matrix(const Mat3& f, const Moduli& law, const Mat3& stress, BlockMatrix& a) const;
  };
  Moduli moduli(double young_modulus) const {
    return {young_modulus / (2 * (1 + poisson())), young_modulus * poisson() / ((1 + poisson()) * (1 - 2 * poisson()))};
  }
  std::array<double, branches> youngs() const { return {young_1(), young_2()}; }
  std::array<double, branches> times() const { return {time_1(), time_2()}; }

  std::vector<Element> elements_;
};

Mat3 green_strain(const Mat3& f) { return 0.5 * (f.transpose() * f - Mat3::Identity()); }

Mat3 PronySolid::Element::gradient(const double* x) const {
  Mat3 f = Mat3::Zero();
  for (std::size_t k = 0; k < 4; ++k) f += Eigen::Map<const Vec3>(x + 3 * node[k]) * b[k].transpose();
  return f;
}

void PronySolid::Element::add_force(const Mat3& f, const Mat3& s, double* force) const {
  const Mat3 p = volume * f * s;
  for (std::size_t k = 0; k < 4; ++k) Eigen::Map<Vec3>(force + 3 * node[k]) -= p * b[k];
}

void PronySolid::Element::add_matrix(const Mat3& f, const Moduli& law, const Mat3& stress, BlockMatrix& a) const {
  const Mat3 left = f * f.transpose();
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t j = 0; j < 4; ++j) {
      if (slot[i][j] < 0) continue;
      const Vec3 fi = f * b[i], fj = f * b[j];
      Mat3 k = law.mu * (b[i].dot(b[j]) * left + fj * fi.transpose()) + law.lambda * fi * fj.transpose();
      k.diagonal().array() += b[i].dot(stress * b[j]);
      Eigen::Map<Mat3>(a.block(slot[i][j])) += volume * k;
    }
}

void PronySolid::attach(PrepareContext& context, DeformableBody& body) {
  const auto* solid = dynamic_cast<const SoftBody*>(&body);
  if (!solid) return error(context, "needs tetrahedra: it belongs in a <soft_body>");
  const TetMesh& mesh = solid->rest();
  elements_.assign(mesh.tets.size(), Element());
  for (std::size_t t = 0; t < elements_.size(); ++t) {
    Element& e = elements_[t];
    e.node = mesh.tets[t];
    const auto p = [&](std::size_t k) -> const Vec3& { return mesh.nodes[std::size_t(e.node[k])]; };
    Mat3 d;
    d << p(1) - p(0), p(2) - p(0), p(3) - p(0);
    const Mat3 inverse = d.inverse();
    e.volume = d.determinant() / 6;
    e.b[0].setZero();
    for (int k = 0; k < 3; ++k) {
      e.b[std::size_t(k) + 1] = inverse.row(k).transpose();
      e.b[0] -= e.b[std::size_t(k) + 1];
    }
  }
}

void PronySolid::couplings(std::vector<std::pair<int, int>>& pairs, Tangent) const {
  for (const Element& e : elements_)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < i; ++j) pairs.emplace_back(e.node[i], e.node[j]);
}

void PronySolid::bind(const BlockMatrix& a, const std::vector<int>& free_of_node) {
  for (Element& e : elements_)
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t j = 0; j < 4; ++j) {
        const int fi = free_of_node[std::size_t(e.node[i])], fj = free_of_node[std::size_t(e.node[j])];
        e.slot[i][j] = fj < 0 || fi < fj ? -1 : a.slot(fi, fj);
      }
}

void PronySolid::add_mass(std::vector<double>& mass, std::vector<double>&) const {
  for (const Element& e : elements_)
    for (const int n : e.node) mass[std::size_t(n)] += density() * e.volume / 4;
}

void PronySolid::linearise(const double* x, double* force, BlockMatrix* stiffness, double, Tangent which) {
  const Moduli law = moduli(young());
  for (const Element& e : elements_) {
    const Mat3 f = e.gradient(x);
    Mat3 s = law.stress(green_strain(f));
    e.add_force(f, s, force);
    if (!stiffness) continue;
    if (which == Tangent::system) {  // compressive stress would make the matrix indefinite
      const Eigen::SelfAdjointEigenSolver<Mat3> parts(s);
      s = parts.eigenvectors() * parts.eigenvalues().cwiseMax(0).asDiagonal() * parts.eigenvectors().transpose();
    }
    e.add_matrix(f, law, s, *stiffness);
  }
}

void PronySolid::linearise_damping(const double* x, const double* v, double* force, BlockMatrix* damping, double h) {
  double viscous = 0;  // Pa s
  std::array<double, branches> left;
  for (std::size_t k = 0; k < branches; ++k) {
    left[k] = 1 / (1 + h / times()[k]);
    viscous += h * youngs()[k] * left[k];
  }
  const Moduli law = moduli(viscous);
  for (const Element& e : elements_) {
    const Mat3 f = e.gradient(x), twice = f.transpose() * e.gradient(v);
    Mat3 s = law.stress(0.5 * (twice + twice.transpose()));
    for (std::size_t k = 0; k < branches; ++k) s += left[k] * e.branch[k];
    e.add_force(f, s, force);
    if (damping) e.add_matrix(f, law, Mat3::Zero(), *damping);
  }
}

double PronySolid::energy(const double* x) {
  const Moduli law = moduli(young());
  double sum = 0;
  for (const Element& e : elements_) {
    const Mat3 strain = green_strain(e.gradient(x));
    double density_of_energy = 0.5 * law.stress(strain).cwiseProduct(strain).sum();
    for (std::size_t k = 0; k < branches; ++k) density_of_energy += moduli(youngs()[k]).energy_of_stress(e.branch[k]);
    sum += e.volume * density_of_energy;
  }
  return sum;
}

bool PronySolid::add_stress(const double* x, std::vector<Mat3>& stress) const {
  const Moduli law = moduli(young());
  for (std::size_t t = 0; t < elements_.size(); ++t) {
    const Mat3 f = elements_[t].gradient(x);
    Mat3 s = law.stress(green_strain(f));
    for (const Mat3& h : elements_[t].branch) s += h;
    stress[t] += f * s * f.transpose() / f.determinant();
  }
  return !elements_.empty();
}

bool PronySolid::finish(const StepContext& context, const double* x) {
  for (Element& e : elements_) {
    const Mat3 strain = green_strain(e.gradient(x));
    for (std::size_t k = 0; k < branches; ++k)
      e.branch[k] = (e.branch[k] + moduli(youngs()[k]).stress(strain - e.strain)) / (1 + context.h / times()[k]);
    e.strain = strain;
  }
  return false;  // the matrix does not depend on H_k
}

void PronySolid::reset() {
  for (Element& e : elements_) {
    e.strain.setZero();
    e.branch.fill(Mat3::Zero());
  }
}

void PronySolid::append_state(std::vector<double>& out) const {
  for (const Element& e : elements_)
    for (const Mat3& s : e.branch) out.insert(out.end(), {s(0, 0), s(1, 1), s(2, 2), s(0, 1), s(0, 2), s(1, 2)});
}

}  // namespace
}  // namespace insula

INSULA_PLUGIN(prony_solid) {
  registry.add<insula::PronySolid>("prony_solid", insula::Kind::force_model,
                                   "viscoelastic solid with two relaxation times (Prony series)");
}
