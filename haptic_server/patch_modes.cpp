// SPDX-License-Identifier: GPL-3.0-or-later
// The modes' part in the vertices and contacts of patches (haptic_server/reduced_dynamics.h).
#include <array>

#include "haptic_server/patch_contacts.h"

namespace insula {
namespace {

/// The modes that a row has a part in: from the first to the one before the last. Most rows touch one body.
struct Range {
  std::size_t first, last;
};
Range range_of(const double* participation, std::size_t modes) {
  Range r{0, modes};
  while (r.last > 0 && participation[r.last - 1] == 0) --r.last;
  while (r.first < r.last && participation[r.first] == 0) ++r.first;
  return r;
}

}  // namespace

void PatchContacts::begin_dynamics(ReducedDynamics* dynamics) noexcept {
  dynamics_ = dynamics;
  if (!dynamics_) return;
  const std::size_t n = source_.size(), modes = dynamics_->modes();
  for (std::size_t i = 0; i < n; ++i) {
    const double* p = participation(i);
    const Range own = range_of(p, modes);  // those of one body
    const auto dot = [&](const double* a, const double* b) {
      double sum = 0;
      for (std::size_t s = own.first; s < own.last; ++s) sum += a[s] * b[s];
      return sum;
    };
    for (std::size_t j = 0; j < n; ++j) w_vv_[i * n + j] -= dot(p, participation(j));
    for (std::size_t r = 0; r < std::size_t(rows_->rows); ++r)
      w_vr_[i * std::size_t(max_rows_) + r] -= dot(p, rows_->reduced.row(r));
    rate_[i] -= dynamics_->rate(p);
  }
}

void PatchContacts::add_forces() noexcept {
  for (std::size_t i = 0; i < force_.size(); ++i)
    if (force_[i] != 0) dynamics_->add_force(participation(i), force_[i]);
}

// Removes the displacement of the rows that the forces on the vertices make in the modes.
void PatchContacts::subtract_known_modes(std::span<double> delta_free) const noexcept {
  std::array<double, ReducedModel::max_modes> by_vertices{};
  for (std::size_t i = 0; i < force_.size(); ++i)
    for (std::size_t s = 0; s < dynamics_->modes() && force_[i] != 0; ++s)
      by_vertices[s] += participation(i)[s] * force_[i];
  for (std::size_t r = 0; r < delta_free.size(); ++r)
    for (std::size_t s = 0; s < dynamics_->modes(); ++s)
      delta_free[r] -= rows_->reduced.row(r)[s] * dynamics_->compliance()[s] * by_vertices[s];
}

void PatchContacts::find_participations() noexcept {
  const std::size_t modes = dynamics_->modes();
  contact_participation_.assign(3 * contacts_.size() * modes, 0.0);  // within its capacity
  for (std::size_t c = 0; c < contacts_.size(); ++c) {
    const Contact& x = contacts_[c];
    for (std::size_t i = 0; i < 3; ++i)
      for (int a = 0; a < 3 && x.slot[i] >= 0; ++a) {
        const double* p = participation(std::size_t(x.slot[i] + a));
        for (int k = 0; k < 3; ++k) {
          const double weight = -x.directions(k, a) * x.bary[long(i)];
          double* out = contact_participation_.data() + (3 * c + std::size_t(k)) * modes;
          for (std::size_t s = 0; s < modes; ++s) out[s] += weight * p[s];
        }
      }
  }
}

// The modes' part in W of the contacts' rows.
void PatchContacts::add_modal_compliance(std::size_t rows) noexcept {
  find_participations();
  const std::size_t modes = dynamics_->modes(), stride = std::size_t(tick_.stride);
  std::array<double, ReducedModel::max_modes> scaled;
  for (std::size_t c = 0; c < 3 * contacts_.size(); ++c) {
    const double* own = contact_participation_.data() + c * modes;
    const Range body = range_of(own, modes);
    for (std::size_t s = body.first; s < body.last; ++s) scaled[s] = own[s] * dynamics_->compliance()[s];
    for (std::size_t r = 0; r < rows + c + 1; ++r) {
      const double* p = r < rows ? rows_->reduced.row(r) : contact_participation_.data() + (r - rows) * modes;
      double sum = 0;
      for (std::size_t s = body.first; s < body.last; ++s) sum += scaled[s] * p[s];
      tick_.w[(rows + c) * stride + r] += sum;
      if (r != rows + c) tick_.w[r * stride + rows + c] += sum;
    }
  }
}

}  // namespace insula
