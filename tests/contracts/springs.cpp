// SPDX-License-Identifier: GPL-3.0-or-later
// A force model that draws every node back to its place, hardening with the distance; and mistakes of force models.
#include <array>
#include <limits>
#include <memory>

#include "core/mechanics/deformable_body.h"
#include "tests/contracts/mistakes.h"

namespace insula::mistakes {
namespace {

enum class Mistake {
  none,
  wrong_energy,
  wrong_stiffness,
  says_internal,
  forgets_damping,
  forgets_reset,
  state_not_in_hash,
  not_finite,
  allocates,
  softens,
  wrong_stress
};

template <Mistake M>
class Springs final : public ForceModel {
 public:
  void attach(PrepareContext&, DeformableBody& body) override { rest_ = body.rest_nodes(); }
  void couplings(std::vector<std::pair<int, int>>&, Tangent) const override {}
  void bind(const BlockMatrix& a, const std::vector<int>& free_of_node) override {
    slots_.clear();
    for (const int block : free_of_node) slots_.push_back(block < 0 ? -1 : a.diagonal(block));
  }
  void linearise(const double* x, double* force, BlockMatrix* matrix, double h, Tangent) override {
    const double damped = h > 0 && !is(Mistake::forgets_damping) ? 1 + stiffness_damping() / h : 1;
    for (std::size_t i = 0; i < rest_.size(); ++i) {
      const Vec3 d = Eigen::Map<const Vec3>(x + 3 * i) - rest_[i];
      const double k = stiffness() * (1 + hardening * d.squaredNorm());
      Eigen::Map<Vec3> f(force + 3 * i);
      f -= k * d;
      if (is(Mistake::not_finite)) f.x() = std::numeric_limits<double>::infinity();
      if (!matrix || slots_[i] < 0) continue;
      const Mat3 tangent = k * Mat3::Identity() + 2 * stiffness() * hardening * d * d.transpose();
      Eigen::Map<Mat3>(matrix->block(slots_[i])) += damped *
                                                    (is(Mistake::wrong_stiffness) ? 0.9
                                                     : is(Mistake::softens)       ? -1
                                                                                  : 1) *
                                                    tangent;
    }
    if (is(Mistake::allocates)) scratch_ = std::make_unique<std::array<double, 8>>();
  }
  double energy(const double* x) override {
    double sum = 0;
    for (std::size_t i = 0; i < rest_.size(); ++i) {
      const double d2 = (Eigen::Map<const Vec3>(x + 3 * i) - rest_[i]).squaredNorm();
      sum += (is(Mistake::wrong_energy) ? 1.01 : 1) * 0.5 * stiffness() * d2 * (1 + 0.5 * hardening * d2);
    }
    return sum;
  }
  bool add_stress(const double*, std::vector<Mat3>&) const override { return is(Mistake::wrong_stress); }
  double stiffness_damping() const override { return 0.01; }
  bool internal() const override { return is(Mistake::says_internal); }
  bool finish(const StepContext&, const double* x) override {
    double most = 0;
    for (std::size_t i = 0; i < rest_.size(); ++i)
      most = std::max(most, (Eigen::Map<const Vec3>(x + 3 * i) - rest_[i]).norm());
    if (most > 1e-7) worn_ = std::min(0.3, worn_ + 0.01);
    return true;
  }
  void reset() override {
    if (!is(Mistake::forgets_reset)) worn_ = 0;
  }
  void append_state(std::vector<double>& out) const override {
    if (!is(Mistake::state_not_in_hash)) out.push_back(worn_);
  }

 private:
  static constexpr bool is(Mistake m) { return M == m; }
  static constexpr double hardening = 1e4;               // 1/m2
  double stiffness() const { return 20 * (1 - worn_); }  // N/m
  std::vector<Vec3> rest_;
  std::vector<int> slots_;
  std::unique_ptr<std::array<double, 8>> scratch_;
  double worn_ = 0;
};

}  // namespace

void add_springs(Registry& registry) {
  const auto add = [&]<Mistake M>(const char* name) {
    registry.add<Springs<M>>(name, Kind::force_model, "springs for tests");
  };
  add.operator()<Mistake::none>("springs");
  add.operator()<Mistake::wrong_energy>("springs_wrong_energy");
  add.operator()<Mistake::wrong_stiffness>("springs_wrong_stiffness");
  add.operator()<Mistake::says_internal>("springs_say_internal");
  add.operator()<Mistake::forgets_damping>("springs_forget_damping");
  add.operator()<Mistake::forgets_reset>("springs_forget_reset");
  add.operator()<Mistake::state_not_in_hash>("springs_state_not_in_hash");
  add.operator()<Mistake::not_finite>("springs_not_finite");
  add.operator()<Mistake::allocates>("springs_allocate");
  add.operator()<Mistake::softens>("springs_soften");
  add.operator()<Mistake::wrong_stress>("springs_wrong_stress");
}

}  // namespace insula::mistakes
