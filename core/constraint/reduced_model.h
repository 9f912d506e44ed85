// SPDX-License-Identifier: GPL-3.0-or-later
// Reduced dynamic model of the tissue under the rows, for the time between two steps
// (haptic_server/reduced_dynamics.h).
//
// A body's displacement since the end of the step is V z, with a few modes V. They are orthogonal in the step's system
// matrix A = M/h^2 + C/h + K and in the mass: V^T A V = 1, V^T M V = diag(m), V^T C V = diag(c). So each mode is a
// damped oscillator of its own about the end of the step,
//   m z'' + c z' + k z = f + V^T H^T (lambda - lambda of the problem),    k = 1 - m/h^2 - c/h
// where f is the force that the end of the step leaves: inertia and damping there. The unit of z is J^(1/2), so m is in
// s^2, c in s, and k has no unit. A row moves by g z with its participation g = H V. The part of W that the modes do
// not have, W - g g^T, has no inertia (haptic_server/substep_correction.h).
//
// Modes of different bodies stand side by side. `groups` says which belong to one body; a row that does not touch it
// has the participation 0 there.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

namespace insula {

struct ReducedModel {
  struct Mode {
    double mass_s2 = 0, damping_s = 0;
    double velocity = 0;  ///< z' at the end of the step, J^(1/2)/s
    double force = 0;     ///< f, J^(1/2)
    bool operator==(const Mode&) const = default;
    double stiffness(double step_s) const { return 1 - mass_s2 / (step_s * step_s) - damping_s / step_s; }
  };
  struct Group {
    int first = 0, modes = 0;
    bool operator==(const Group&) const = default;
  };
  std::vector<Mode> modes;
  std::vector<Group> groups;          ///< in order, covering every mode once
  std::vector<double> participation;  ///< rows x modes, row-major, m/J^(1/2)

  static constexpr double negligible = 1e-3;  ///< share of a row's compliance
  static constexpr std::size_t max_modes_of_body = 24, max_groups = 4, max_modes = 72;

  bool empty() const { return modes.empty(); }
  int size() const { return int(modes.size()); }
  void clear() {
    modes.clear();
    groups.clear();
    participation.clear();
  }
  /// So that a later copy does not allocate.
  void reserve(std::size_t rows) {
    modes.reserve(max_modes);
    groups.reserve(max_groups);
    participation.reserve(rows * max_modes);
  }
  double* row(std::size_t i) { return participation.data() + i * modes.size(); }
  const double* row(std::size_t i) const { return participation.data() + i * modes.size(); }
  /// Takes the modes of another model, for `rows` rows without a part in them.
  void take_modes(const ReducedModel& from, std::size_t rows) {
    modes.assign(from.modes.begin(), from.modes.end());
    groups.assign(from.groups.begin(), from.groups.end());
    participation.assign(rows * modes.size(), 0.0);
  }
  /// Adds a body, for `rows` rows without a part in it. False, and nothing changes, if there is no room.
  bool add_group(const std::vector<Mode>& added, std::size_t rows) {
    const std::size_t before = modes.size(), now = before + added.size();
    if (groups.size() == max_groups || now > max_modes) return false;
    groups.push_back({int(before), int(added.size())});
    modes.insert(modes.end(), added.begin(), added.end());
    std::vector<double> wider(rows * now, 0.0);
    for (std::size_t i = 0; i < rows && before > 0; ++i)
      std::copy_n(participation.data() + i * before, before, wider.data() + i * now);
    participation.swap(wider);
    return true;
  }
  /// Scales the modes from `first` on so that they move no row more than w(row), its whole compliance by their bodies.
  /// Modes of an older factor may do so. Rows that hardly move with them are taken out.
  template <class Compliance>
  void limit(std::size_t first, std::size_t rows, Compliance&& w) {
    const auto own = [&](std::size_t i) {
      double sum = 0;
      for (std::size_t s = first; s < modes.size(); ++s) sum += row(i)[s] * row(i)[s];
      return sum;
    };
    double most = 1;
    for (std::size_t i = 0; i < rows; ++i)
      if (own(i) > most * w(i)) most = own(i) / w(i);  // infinite for a row that cannot move
    const double scale = std::sqrt(1 / most);
    for (std::size_t i = 0; i < rows; ++i) {
      const double by = own(i) > negligible * w(i) ? scale : 0;
      for (std::size_t s = first; s < modes.size(); ++s) row(i)[s] *= by;
    }
  }
  bool touches(std::size_t row_number, const Group& g) const {
    const double* p = row(row_number) + g.first;
    return std::any_of(p, p + g.modes, [](double x) { return x != 0; });
  }
  bool operator==(const ReducedModel&) const = default;
};

}  // namespace insula
