// SPDX-License-Identifier: GPL-3.0-or-later
// Rows of contacts on surface patches, tick by tick.
#include "haptic_server/patch_contacts.h"

#include <algorithm>
#include <cmath>

#include "core/constraint/problem_fields.h"
#include "haptic_server/tick_share.h"

namespace insula {
namespace {

constexpr std::size_t most_values = 240;                   // three for each moving vertex
constexpr std::uint64_t key_bit = std::uint64_t(1) << 63;  // ids of the engine do not have it

}  // namespace

PatchContacts::PatchContacts(int max_rows)
    : max_rows_(max_rows), colliders_(max_rows > 0 ? SurfacePatches::max_patches : 0) {
  const auto rows = std::size_t(max_rows);
  for (ConstraintProblem* p : {&rest_, &tick_}) {
    p->resize(max_rows);
    p->reduced.reserve(rows);
    p->blocks.reserve(rows);
    p->tools.resize(2);
    for (ToolTerms& t : p->tools) t.jacobian.setZero(max_rows, 6);
  }
  kept_.reserve(rows);
  dropped_.reserve(rows);
  slots_.reserve(SurfacePatches::max_vertices);
  source_.reserve(most_values);
  w_vv_.assign(most_values * most_values, 0.0);
  w_vr_.assign(most_values * rows, 0.0);
  for (auto* v : {&beta_, &share_, &rate_, &force_, &free_, &back_, &change_, &modal_}) v->reserve(most_values);
  contact_participation_.reserve(most_contacts * 3 * ReducedModel::max_modes);
  position_.reserve(SurfacePatches::max_vertices);
  ahead_.reserve(SurfacePatches::max_vertices);
  axes_.assign(most_contacts * 3 * most_values, 0.0);
  found_.reserve(PatchCollider::most_found);
  contacts_.reserve(most_contacts);
  remembered_.reserve(most_contacts);
}

void PatchContacts::reset() noexcept {
  problem_ = rows_ = nullptr;
  dynamics_ = nullptr;
  patches_ = nullptr;
  vertex_rows_ = 0;
  contacts_.clear();
  remembered_.clear();
  push_ = {Vec6::Zero(), Vec6::Zero()};
}

/// Of the same patch as before, or else the one that was unused for longest.
PatchCollider& PatchContacts::collider_of(std::uint64_t id) noexcept {
  for (PatchCollider& c : colliders_)
    if (c.id() == id) return c;
  const auto needed = [&](const PatchCollider& c) {
    return std::any_of(patches_->patches.begin(), patches_->patches.end(),
                       [&](const SurfacePatch& p) { return p.id == c.id(); });
  };
  for (std::size_t k = 0; k < colliders_.size(); ++k) {
    PatchCollider& c = colliders_[next_collider_];
    next_collider_ = (next_collider_ + 1) % colliders_.size();
    if (!needed(c)) return c;
  }
  return colliders_.front();
}

const ConstraintProblem& PatchContacts::begin(const ConstraintProblem& p) noexcept {
  push_ = {Vec6::Zero(), Vec6::Zero()};
  contacts_.clear();
  vertex_rows_ = 0;
  patches_ = p.patches.empty() ? nullptr : &p.patches;
  problem_ = &p;
  if (!patches_) return p;
  take_vertices(p);
  dropped_.assign(std::size_t(p.rows), 0);
  for (const Block& b : p.blocks)
    if (b.role == BlockRole::surface) dropped_[std::size_t(b.row)] = 1;
  for (const SurfacePatch& patch : patches_->patches) {
    collider_of(patch.id).set(*patches_, patch);
    for (int k = patch.first_replaced; k < patch.first_replaced + patch.replaced; ++k)
      std::fill_n(dropped_.begin() + patches_->replaced[std::size_t(k)].row, 3, char(1));
  }
  take_replaced(p);

  kept_.clear();
  for (int i = 0; i < p.rows; ++i)
    if (!dropped_[std::size_t(i)]) kept_.push_back(i);
  rest_.resize(int(kept_.size()));  // within its capacity
  copy_scalars(p, rest_);
  rest_.reduced.take_modes(p.reduced, kept_.size());
  rest_.blocks.clear();
  int row = 0;
  for (Block b : p.blocks) {
    if (dropped_[std::size_t(b.row)]) continue;
    b.row = row;
    row += b.rows();
    rest_.blocks.push_back(b);
  }
  const std::size_t had = rest_.tools.size(), now = std::min<std::size_t>(p.tools.size(), 2);
  for (std::size_t t = had; t-- > now;) rest_.tools[t].jacobian.swap(spare_);
  rest_.tools.resize(now);
  for (std::size_t t = had; t < now; ++t) rest_.tools[t].jacobian.swap(spare_);
  for (std::size_t t = 0; t < now; ++t) {
    rest_.tools[t].coupling() = p.tools[t];
    for (std::size_t i = 0; i < kept_.size(); ++i)
      rest_.tools[t].jacobian.row(long(i)) = p.tools[t].jacobian.row(kept_[i]);
  }
  for (std::size_t i = 0; i < kept_.size(); ++i) {
    const auto s = std::size_t(kept_[i]);
    copy_row(p, s, rest_, i);
    for (std::size_t j = 0; j < kept_.size(); ++j)
      rest_.w[i * std::size_t(rest_.stride) + j] = p.w_at(int(s), kept_[j]);
    for (int j = 0; j < p.rows; ++j)
      if (dropped_[std::size_t(j)]) rest_.delta_free[i] += p.w_at(int(s), j) * p.lambda[std::size_t(j)];
  }
  return rest_;
}

void PatchContacts::take_vertices(const ConstraintProblem& p) noexcept {
  slots_.clear();
  source_.clear();
  position_.clear();
  for (const PatchVertex& v : patches_->vertices) {
    position_.push_back(v.position);
    const bool moves = v.row >= 0 && source_.size() + 3 <= most_values;
    slots_.push_back(moves ? int(source_.size()) : -1);
    for (int k = 0; moves && k < 3; ++k) source_.push_back(v.row + k);
  }
  ahead_.assign(position_.begin(), position_.end());
  vertex_rows_ = int(source_.size());
  const auto n = source_.size();
  for (auto* v : {&share_, &force_, &free_, &back_, &change_, &modal_}) v->assign(n, 0.0);
  rate_.resize(n);
  beta_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    rate_[i] = p.rate[std::size_t(source_[i])];
    beta_[i] = p.retardation_time[std::size_t(source_[i])];
    for (std::size_t j = 0; j < n; ++j) w_vv_[i * n + j] = p.w_at(source_[i], source_[j]);
  }
}

// The forces of the step's contacts become forces on the vertices. The choice of contacts continues that of the step.
void PatchContacts::take_replaced(const ConstraintProblem& p) noexcept {
  for (const SurfacePatch& patch : patches_->patches) {
    found_.clear();
    for (int k = patch.first_replaced; k < patch.first_replaced + patch.replaced; ++k) {
      const ReplacedContact& r = patches_->replaced[std::size_t(k)];
      const ToolTerms& tool = p.tools[std::size_t(patch.tool)];
      Vec6 f = Vec6::Zero();
      Vec3 arm = Vec3::Zero();
      for (int row = r.row; row < r.row + 3; ++row) {
        const Vec3 direction = tool.jacobian.block<1, 3>(row, 0).transpose(),
                   moment = tool.jacobian.block<1, 3>(row, 3).transpose();
        f.head<3>() += p.lambda[std::size_t(row)] * direction;
        f.tail<3>() += p.lambda[std::size_t(row)] * moment;
        arm += 0.5 * direction.cross(moment);  // the three directions are orthonormal
      }
      push_[std::size_t(patch.tool)] += f;
      const auto& corner = patches_->triangles[std::size_t(r.triangle)].corner;
      for (std::size_t i = 0; i < 3; ++i)
        if (const int slot = slots_[std::size_t(corner[i])]; slot >= 0)
          for (int a = 0; a < 3; ++a) force_[std::size_t(slot + a)] -= r.bary[long(i)] * f[a];
      if (found_.size() == PatchCollider::most_contacts) continue;
      Proximity& x = found_.emplace_back();
      x.piece = r.piece;
      x.local = tool.free.q.conjugate() * arm;
      x.normal = tool.jacobian.block<1, 3>(r.row, 0).transpose();
      x.tangent = tool.jacobian.block<1, 3>(r.row + 1, 0).transpose();
    }
    collider_of(patch.id).follow(found_, next_key_);
  }
}

void PatchContacts::couple(const ConstraintProblem& p) noexcept {
  rows_ = &p;
  dynamics_ = nullptr;
  if (!patches_) return;
  std::size_t from = 0;
  for (const Block& b : p.blocks) {
    while (from < rest_.blocks.size() && rest_.blocks[from].id != b.id) ++from;
    if (from == rest_.blocks.size()) break;
    for (int k = 0; k < b.rows(); ++k) {
      const int row = kept_[std::size_t(rest_.blocks[from].row + k)];
      for (std::size_t i = 0; i < source_.size(); ++i)
        w_vr_[i * std::size_t(max_rows_) + std::size_t(b.row + k)] = problem_->w_at(source_[i], row);
    }
  }
}

void PatchContacts::scale(double dt, double h, bool substep_compliance) noexcept {
  for (std::size_t i = 0; i < share_.size(); ++i)
    share_[i] = substep_compliance && h > 0 ? tick_share(dt, h, beta_[i]) : 1.0;
}

void PatchContacts::subtract_known(std::span<const double> share, std::span<double> delta_free) const noexcept {
  for (std::size_t i = 0; i < force_.size(); ++i) {
    const double f = share_[i] * force_[i];
    if (f == 0) continue;
    for (std::size_t r = 0; r < delta_free.size(); ++r) delta_free[r] -= share[r] * vr(i, r) * f;
  }
  if (dynamics_) subtract_known_modes(delta_free);
}

Vec3 PatchContacts::at(const Contact& c, const std::vector<double>& values) const noexcept {
  Vec3 sum = Vec3::Zero();
  for (std::size_t i = 0; i < 3; ++i)
    if (c.slot[i] >= 0)
      for (int a = 0; a < 3; ++a) sum[a] += c.bary[long(i)] * values[std::size_t(c.slot[i] + a)];
  return sum;
}

void PatchContacts::add_contact(const SurfacePatch& patch, const Proximity& x, const Tool& tool) noexcept {
  Contact& c = contacts_.emplace_back();
  c.tool = std::size_t(patch.tool);
  c.friction = patch.friction;
  c.compliance = patch.compliance_m_per_N;
  c.key = key_bit | x.key;
  const auto& corner = patches_->triangles[std::size_t(x.triangle)].corner;
  for (std::size_t i = 0; i < 3; ++i) c.slot[i] = slots_[std::size_t(corner[i])];
  c.bary = x.bary;
  c.arm = x.point - tool.pose.p;
  c.directions << x.normal.transpose(), x.tangent.transpose(), x.normal.cross(x.tangent).transpose();
  c.gap = x.start_gap;
}

void PatchContacts::find_contacts(std::span<const Tool> tools, int room) noexcept {
  contacts_.clear();
  for (const SurfacePatch& patch : patches_->patches) {
    const Tool& tool = tools[std::size_t(patch.tool)];
    collider_of(patch.id).detect(tool.pose, ahead_, found_, next_key_);
    for (const Proximity& x : found_)
      if (contacts_.size() < most_contacts && 3 * (int(contacts_.size()) + 1) <= room) add_contact(patch, x, tool);
  }
}

// W of the contacts' rows, with the tools' part.
void PatchContacts::write_compliance(const ConstraintProblem& rows, std::span<const double> share,
                                     std::span<const Tool> tools) noexcept {
  const auto n = std::size_t(vertex_rows_), nr = std::size_t(rows.rows), stride = std::size_t(tick_.stride);
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const Contact& x = contacts_[c];
    double* axes = axes_.data() + c * 3 * most_values;
    std::fill_n(axes, 3 * most_values, 0.0);
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t a = 0; a < 3 && x.slot[i] >= 0; ++a) {
        const std::size_t v = std::size_t(x.slot[i]) + a;
        const double weight = x.bary[long(i)] * share_[v];
        for (std::size_t j = 0; j < n; ++j) axes[a * most_values + j] += weight * vv(v, j) * share_[j];
      }
    std::array<Vec6, 3> by_tool;
    for (int k = 0; k < 3; ++k) by_tool[std::size_t(k)] = *tools[x.tool].give * x.jacobian(k);
    const std::size_t first = nr + 3 * c;
    for (std::size_t r = 0; r < nr; ++r) {
      Vec3 along = Vec3::Zero();
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t a = 0; a < 3 && x.slot[i] >= 0; ++a) {
          const std::size_t v = std::size_t(x.slot[i]) + a;
          along[long(a)] += x.bary[long(i)] * share_[v] * vr(v, r) * share[r];
        }
      for (int k = 0; k < 3; ++k) {
        double w = -(x.directions.row(k) * along).value();
        for (int q = 0; q < 6; ++q) w += (*tools[x.tool].jacobian)(long(r), q) * by_tool[std::size_t(k)][q];
        tick_.w[(first + std::size_t(k)) * stride + r] = tick_.w[r * stride + first + std::size_t(k)] = w;
      }
    }
    for (std::size_t d = 0; d <= c; ++d) {
      const Contact& y = contacts_[d];
      Mat3 between = Mat3::Zero();
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t a = 0; a < 3; ++a)
          for (std::size_t b = 0; b < 3 && y.slot[i] >= 0; ++b)
            between(long(a), long(b)) += y.bary[long(i)] * axes[a * most_values + std::size_t(y.slot[i]) + b];
      const Mat3 w = x.directions * between * y.directions.transpose();
      for (int k = 0; k < 3; ++k)
        for (int l = 0; l < 3; ++l) {
          double value = w(k, l);
          if (x.tool == y.tool) value += by_tool[std::size_t(k)].dot(y.jacobian(l));
          const std::size_t i = first + std::size_t(k), j = nr + 3 * d + std::size_t(l);
          tick_.w[i * stride + j] = tick_.w[j * stride + i] = value;
        }
    }
  }
}

void PatchContacts::write_free(int first, std::span<const Tool> tools) noexcept {
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const Contact& x = contacts_[c];
    const Tool& tool = tools[x.tool];
    const Vec6 tool_back = -(*tool.give * tool.push);
    const Vec3 back = at(x, back_), slip = at(x, free_);
    const bool soft = std::any_of(x.slot.begin(), x.slot.end(), [](int slot) { return slot >= 0; });
    for (int k = 0; k < 3; ++k) {
      const Vec6 j = x.jacobian(k);
      const Vec3 d = x.directions.row(k).transpose();
      const double approach = j.dot(tool.went) - d.dot(slip);
      // Tissue is hard to move within a tick. So an overlap with it that was there before is undone within a step, as
      // the engine does.
      const double start = k > 0 ? approach : x.gap + (soft ? later_ * std::max(0.0, approach - x.gap) : 0);
      tick_.delta_free[std::size_t(first) + 3 * c + std::size_t(k)] = start + j.dot(tool_back) - d.dot(back);
    }
  }
}

const ConstraintProblem& PatchContacts::next(const ConstraintProblem& rows, std::span<const double> share,
                                             std::span<const double> known, std::span<const Tool> tools, double dt,
                                             bool extrapolate) noexcept {
  const auto n = std::size_t(vertex_rows_), nr = std::size_t(rows.rows);
  for (std::size_t i = 0; i < n; ++i) {
    free_[i] = extrapolate ? beta_[i] / (beta_[i] + dt) * dt * rate_[i] : 0;
    double sum = 0;
    for (std::size_t j = 0; j < n; ++j) sum += vv(i, j) * share_[j] * force_[j];
    for (std::size_t r = 0; r < nr; ++r) sum += vr(i, r) * share[r] * known[r];
    back_[i] = -share_[i] * sum;
    if (!dynamics_) continue;
    modal_[i] = dynamics_->displacement(participation(i));
    free_[i] += modal_[i];
    back_[i] -= dynamics_->response(participation(i));
  }
  for (std::size_t v = 0; v < position_.size(); ++v) {
    ahead_[v] = position_[v];
    if (slots_[v] >= 0)
      for (int a = 0; a < 3; ++a) ahead_[v][a] += free_[std::size_t(slots_[v] + a)];
  }
  find_contacts(tools, max_rows_ - rows.rows);
  later_ = problem_->step_s > 0 ? std::max(0.0, 1 - dt / problem_->step_s) : 0;
  exchanged_ = std::any_of(remembered_.begin(), remembered_.end(), [&](const Remembered& r) {
    return r.lambda[0] > 0 &&
           std::none_of(contacts_.begin(), contacts_.end(), [&](const Contact& c) { return c.key == r.key; });
  });
  tick_.resize(rows.rows + 3 * int(contacts_.size()));  // within its capacity
  copy_scalars(rows, tick_);
  for (std::size_t i = 0; i < nr; ++i) {
    std::copy_n(rows.w.begin() + std::ptrdiff_t(i) * rows.stride, nr,
                tick_.w.begin() + std::ptrdiff_t(i) * tick_.stride);
    tick_.delta_free[i] = rows.delta_free[i];
  }
  tick_.blocks.assign(rows.blocks.begin(), rows.blocks.end());
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const Contact& x = contacts_[c];
    Block& b = tick_.blocks.emplace_back();
    b.id = x.key;
    b.role = BlockRole::contact;
    b.row = rows.rows + 3 * int(c);
    b.law = LawKind::friction;
    b.compliance = x.compliance;
    b.friction = x.friction;
    for (const Remembered& r : remembered_)
      if (r.key == x.key)
        for (int k = 0; k < 3; ++k) tick_.lambda[std::size_t(b.row + k)] = r.lambda[k];
  }
  write_compliance(rows, share, tools);
  if (dynamics_) add_modal_compliance(nr);
  write_free(rows.rows, tools);
  return tick_;
}

void PatchContacts::take_forces(std::span<const double> lambda, std::size_t nr) noexcept {
  const auto n = std::size_t(vertex_rows_);
  for (std::size_t i = 0; i < n; ++i) change_[i] = -force_[i];
  std::fill(force_.begin(), force_.end(), 0.0);
  push_ = {Vec6::Zero(), Vec6::Zero()};
  remembered_.clear();
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const Contact& x = contacts_[c];
    Vec3 l;
    for (int k = 0; k < 3; ++k) {
      const double value = lambda[nr + 3 * c + std::size_t(k)];
      l[k] = std::isfinite(value) ? value : 0;
    }
    remembered_.push_back({x.key, l});
    const Vec3 f = x.directions.transpose() * l;
    push_[x.tool].head<3>() += f;
    push_[x.tool].tail<3>() += x.arm.cross(f);
    for (std::size_t i = 0; i < 3; ++i)
      if (x.slot[i] >= 0)
        for (int a = 0; a < 3; ++a) force_[std::size_t(x.slot[i] + a)] -= x.bary[long(i)] * f[a];
  }
  for (std::size_t i = 0; i < n; ++i) change_[i] = share_[i] * (change_[i] + force_[i]);
}

void PatchContacts::move(std::span<const double> lambda, std::span<const double> share, std::span<const double> known,
                         double dt, bool substep_compliance) noexcept {
  const auto n = std::size_t(vertex_rows_), nr = known.size();
  for (std::size_t v = 0; v < position_.size(); ++v) {
    if (slots_[v] < 0) continue;
    for (int a = 0; a < 3; ++a) {
      const auto i = std::size_t(slots_[v] + a);
      double sum = 0;
      for (std::size_t j = 0; j < n; ++j) sum += vv(i, j) * change_[j];
      for (std::size_t r = 0; r < nr; ++r) sum += vr(i, r) * share[r] * (lambda[r] - known[r]);
      const double moved = free_[i] - modal_[i] + share_[i] * sum;
      if (substep_compliance) rate_[i] = moved / dt;
      position_[v][a] += moved + (dynamics_ ? dynamics_->displacement(participation(i)) : 0);
    }
  }
}

}  // namespace insula
