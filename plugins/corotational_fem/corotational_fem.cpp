// SPDX-License-Identifier: GPL-3.0-or-later
/*
# corotational_fem

Co-rotational linear finite elements on tetrahedra: small strain in a frame that turns with each element, isotropic
Hooke's law. With F the deformation gradient, F = R S (polar), e = S - I:

    energy density   mu |e|^2 + lambda/2 tr(e)^2
    P = R (2 mu e + lambda tr(e) I),   force on node i = -V P b_i,   b_i the rest gradient of its shape function

which is the exact gradient of the energy. R is the rotation nearest to F: the rotation of its polar decomposition. If
F is inverted, the reflection goes into the smallest stretch. R is not taken from the edges of the element, as SOFA's
polar method does; the page on validation compares the two. Under Hooke's law a stress of a few times E compresses an
element flat and inverts it. Soft tissue stiffens long before that. A principal stretch s below `barrier_stretch` s0
therefore costs in addition

    energy density   stiffening E / 2 (s0 - s)^2           (s < s0; nothing above)

Tissue may swell or shrink (<brain_relaxation>): with the natural stretch a, e becomes S - a I in Hooke's law, so

    energy density   mu |S - I|^2 + lambda/2 tr(S - I)^2 - (2 mu + 3 lambda)(a - 1) tr(S - I)     (less a constant)

The compression barrier keeps elements under a tool's tip from inverting, and leaves the law elsewhere unchanged. The
exact derivative of Hooke's law adds a term on the spin of the element to the rotated stiffness. `tangent="exact"`
includes this term with its negative eigenvalues set to zero. Otherwise it is left out.

Elements are computed eight at a time (kernels_impl.cpp). The few that need singular values or eigenvalues are
computed one by one.

Sources: Felippa, Haugen 2005 (co-rotational formulation); Mueller, Gross 2004; Dequidt et al. 2015, section 3.1;
Smith, de Goes, Kim 2019 (Hessian of energies of the principal stretches).
*/
#include <algorithm>
#include <cstring>
#include <limits>

#include "core/mechanics/soft_body.h"
#include "core/registry/registry.h"
#include "plugins/corotational_fem/compression_barrier.h"
#include "plugins/corotational_fem/element_batch.h"
#include "plugins/corotational_fem/polar.h"

namespace insula {
namespace {

class CorotationalFem final : public ForceModel {
 public:
  Param<Pressure> young{
      this, {.name = "young", .fallback = "2100 Pa", .min = "1 Pa", .max = "1 GPa", .doc = "Young's modulus"}};
  Param<Scalar> poisson{this,
                        {.name = "poisson", .fallback = "0.45", .min = "0", .max = "0.495", .doc = "Poisson's ratio"}};
  Param<Density> density{
      this, {.name = "density", .fallback = "1 g/cm3", .min = "0.01 g/cm3", .max = "25 g/cm3", .doc = "mass density"}};
  Param<Rate> rayleigh_mass{this,
                            {.name = "rayleigh_mass",
                             .fallback = "1 1/s",
                             .min = "0 1/s",
                             .max = "1000 1/s",
                             .doc = "Rayleigh damping in proportion to mass"}};
  Param<Duration> rayleigh_stiffness{this,
                                     {.name = "rayleigh_stiffness",
                                      .fallback = "20 ms",
                                      .min = "0 s",
                                      .max = "1 s",
                                      .doc = "Rayleigh damping in proportion to stiffness"}};
  Param<Choice> tangent{this,
                        {.name = "tangent",
                         .fallback = "rotated",
                         .choices = {"rotated", "exact"},
                         .doc = "stiffness used in a step: rotated Hooke, or with the element's spin as well"}};

  Param<Scalar> barrier_stretch{
      this,
      {.name = "barrier_stretch",
       .fallback = "0.4",
       .min = "0",
       .max = "0.9",
       .doc = "principal stretch below which an element stiffens; 0: only once it is inverted",
       .formerly = "least_stretch"}};
  Param<Scalar> stiffening{this,
                           {.name = "stiffening",
                            .fallback = "30",
                            .min = "0",
                            .max = "1000",
                            .doc = "stiffness below that stretch, in Young's moduli; 0: none"}};

  void attach(PrepareContext& context, DeformableBody& body) override;
  void couplings(std::vector<std::pair<int, int>>& pairs, Tangent) const override;
  void bind(const BlockMatrix& a, const std::vector<int>& free_of_node) override;
  void add_mass(std::vector<double>& mass, std::vector<double>& damping) const override;
  void linearise(const double* x, double* force, BlockMatrix* stiffness, double h, Tangent which) override;
  double energy(const double* x) override;
  bool add_stress(const double* x, std::vector<Mat3>& stress) const override;
  bool set_natural_stretch(double a) override {
    natural_stretch_ = a;
    return true;
  }
  double stiffness_damping() const override { return rayleigh_stiffness(); }
  void reset() override;

 private:
  void rotate(const ElementBatch& e, const double* x, ElementWork& work) const;
  ElementMaterial material() const;
  BarrierLaw barrier_law() const { return {stiffening() * young(), barrier_stretch()}; }

  std::vector<ElementBatch> batches_;
  double natural_stretch_ = 1;
};

void CorotationalFem::attach(PrepareContext& context, DeformableBody& body) {
  const auto* solid = dynamic_cast<const SoftBody*>(&body);
  if (!solid) return error(context, "needs tetrahedra: it belongs in a <soft_body>");
  const TetMesh& mesh = solid->rest();
  const std::size_t count = mesh.tets.size();
  batches_.assign((count + batch_lanes - 1) / batch_lanes, ElementBatch());
  for (std::size_t t = 0; t < batch_lanes * batches_.size(); ++t) {
    ElementBatch& e = batches_[t / batch_lanes];
    const std::size_t l = t % batch_lanes;
    const auto& tet = mesh.tets[std::min(t, count - 1)];
    const auto p = [&](int k) -> const Vec3& { return mesh.nodes[std::size_t(tet[std::size_t(k)])]; };
    Mat3 d;
    d << p(1) - p(0), p(2) - p(0), p(3) - p(0);
    const Mat3 inverse = d.inverse();
    e.count = int(std::min<std::size_t>(batch_lanes, count - t / batch_lanes * batch_lanes));
    e.volume[l] = d.determinant() / 6;
    for (int k = 0; k < 4; ++k) e.node[k][l] = tet[std::size_t(k)];
    for (int k = 0; k < 3; ++k)
      for (int c = 0; c < 3; ++c) e.b[k][c][l] = inverse(k, c);
    for (auto& slot : e.slot) slot[l] = -1;
  }
  reset();
}

void CorotationalFem::reset() {
  for (ElementBatch& e : batches_)
    for (int k = 0; k < 4; ++k) std::fill_n(e.q[k], batch_lanes, k == 0 ? 1.0 : 0.0);
}

void CorotationalFem::couplings(std::vector<std::pair<int, int>>& pairs, Tangent) const {
  for (const ElementBatch& e : batches_)
    for (int l = 0; l < e.count; ++l)
      for (int i = 0; i < 4; ++i)
        for (int j = 0; j < i; ++j) pairs.emplace_back(e.node[i][l], e.node[j][l]);
}

void CorotationalFem::bind(const BlockMatrix& a, const std::vector<int>& free_of_node) {
  for (ElementBatch& e : batches_)
    for (int l = 0; l < batch_lanes; ++l) {
      struct Corner {
        int free, node;
        Vec3 b;
      } corner[4];
      for (int k = 0; k < 4; ++k) {
        const int n = e.node[k][l];
        corner[k] = {free_of_node[std::size_t(n)], n, rest_gradient(e, l, k)};
      }
      std::sort(corner, corner + 4,
                [](const Corner& p, const Corner& q) { return p.free != q.free ? p.free < q.free : p.node < q.node; });
      for (int i = 0, k = 0; i < 4; ++i) {
        e.node[i][l] = corner[i].node;
        if (i > 0)
          for (int c = 0; c < 3; ++c) e.b[i - 1][c][l] = corner[i].b[c];
        for (int j = 0; j <= i; ++j, ++k)
          e.slot[k][l] = corner[j].free < 0 || l >= e.count ? -1 : a.slot(corner[i].free, corner[j].free);
      }
    }
}

void CorotationalFem::add_mass(std::vector<double>& mass, std::vector<double>& damping) const {
  for (const ElementBatch& e : batches_)
    for (int l = 0; l < e.count; ++l)
      for (int k = 0; k < 4; ++k) {
        const double m = density() * e.volume[l] / 4;
        mass[std::size_t(e.node[k][l])] += m;
        damping[std::size_t(e.node[k][l])] += rayleigh_mass() * m;
      }
}

ElementMaterial CorotationalFem::material() const {
  // No principal stretch is below 1 - |e|. So nearly all elements need no eigenvalues.
  const double far = stiffening() > 0 ? 1 - barrier_stretch() : std::numeric_limits<double>::infinity();
  const double mu = young() / (2 * (1 + poisson())),
               lambda = young() * poisson() / ((1 + poisson()) * (1 - 2 * poisson()));
  return {mu, lambda, far * far, (2 * mu + 3 * lambda) * (natural_stretch_ - 1)};
}

void CorotationalFem::rotate(const ElementBatch& e, const double* x, ElementWork& work) const {
  const unsigned failed = element_kernels().rotate(e, x, work);
  for (int l = 0; failed && l < batch_lanes; ++l) {
    if (!(failed >> l & 1)) continue;
    const Mat3 r = rotation_by_svd(matrix_of_lane(work.f, l));
    const Quat q = Quat(r).normalized();
    for (int i = 0; i < 9; ++i) work.r[i][l] = r(i / 3, i % 3);
    work.q[0][l] = q.w(), work.q[1][l] = q.x(), work.q[2][l] = q.y(), work.q[3][l] = q.z();
  }
}

void CorotationalFem::linearise(const double* x, double* force, BlockMatrix* stiffness, double h, Tangent which) {
  const ElementKernels& kernel = element_kernels();
  const ElementMaterial m = material();
  const double scale = 1 + (h > 0 ? rayleigh_stiffness() / h : 0);
  const bool system = which == Tangent::system;
  const SpinTerm spin = !system ? SpinTerm::exact : tangent.is("exact") ? SpinTerm::positive : SpinTerm::none;
  ElementWork work;
  for (ElementBatch& e : batches_) {
    rotate(e, x, work);
    std::memcpy(e.q, work.q, sizeof e.q);
    const unsigned compressed = kernel.force(e, m, work, force);
    if (stiffness) kernel.stiffness(e, m, work, scale, spin, stiffness->block(0));
    for (int l = 0; compressed && l < e.count; ++l)
      if (compressed >> l & 1) stiffen(e, work, l, barrier_law(), force, stiffness, scale, system);
  }
}

double CorotationalFem::energy(const double* x) {
  const ElementKernels& kernel = element_kernels();
  const ElementMaterial m = material();
  ElementWork work;
  double sum = 0;
  for (const ElementBatch& e : batches_) {
    rotate(e, x, work);
    const unsigned compressed = kernel.energy(e, m, work);
    for (int l = 0; l < e.count; ++l) {
      sum += work.out[0][l];
      if (compressed >> l & 1) sum += barrier_energy(e, work, l, barrier_law());
    }
  }
  return sum;
}

// With P the first Piola-Kirchhoff stress, the sum of x_i f_i over the nodes of an element is -V P F^T = -V det(F)
// sigma.
bool CorotationalFem::add_stress(const double* x, std::vector<Mat3>& stress) const {
  const ElementKernels& kernel = element_kernels();
  const ElementMaterial m = material();
  ElementWork work;
  std::vector<double> force(12 * batch_lanes);
  std::size_t t = 0;
  for (const ElementBatch& batch : batches_) {
    rotate(batch, x, work);
    ElementBatch e = batch;
    for (int l = 0; l < batch_lanes; ++l)
      for (int k = 0; k < 4; ++k) e.node[k][l] = 4 * l + k;  // each element has nodes of its own here
    std::fill(force.begin(), force.end(), 0.0);
    const unsigned compressed = kernel.force(e, m, work, force.data());
    for (int l = 0; l < e.count; ++l, ++t) {
      if (compressed >> l & 1) stiffen(e, work, l, barrier_law(), force.data(), nullptr, 1, false);
      const Mat3 f = matrix_of_lane(work.f, l);
      Mat3 virial = Mat3::Zero();
      const auto at = [&](int k) { return Eigen::Map<const Vec3>(x + 3 * batch.node[k][l]); };
      for (int k = 1; k < 4; ++k)  // seen from node 0, since the forces add up to nothing
        virial -= Eigen::Map<const Vec3>(&force[std::size_t(3 * (4 * l + k))]) * (at(k) - at(0)).transpose();
      stress[t] += virial / (e.volume[l] * f.determinant());
    }
  }
  return !batches_.empty();
}

}  // namespace
}  // namespace insula

INSULA_PLUGIN(corotational_fem) {
  registry.add<insula::CorotationalFem>("corotational_fem", insula::Kind::force_model,
                                        "co-rotational linear elasticity on the body's tetrahedra");
}
