// SPDX-License-Identifier: GPL-3.0-or-later
// A body's part of the message has its modes, then the rows that touch it with their participations.
#include "core/haptics/reduced_wire.h"

#include <array>

#include "core/haptics/haptic_layout.h"
#include "core/haptics/haptic_update.h"

namespace insula::wire {
namespace {

constexpr double max_time_s = 1e3, max_rate = 1e4, max_participation = 1e3;
constexpr double rounding = 1e-4;  // of float32, in sums of a mode or a row

/// A body's part of the message. Null for empty arrays is never read.
struct BodyLayout {
  int modes = 0, rows = 0;
  std::array<const std::uint8_t*, 4> value{};  ///< mass, damping, velocity, force
  const std::uint8_t *row = nullptr, *participation = nullptr;

  ReducedModel::Mode mode(int s) const {
    const auto at = [&](std::size_t k) { return double(load_float(value[k] + 4 * s)); };
    return {at(0), at(1), at(2), at(3)};
  }
  int row_at(int i) const { return load<std::int16_t>(row + 2 * i); }
  double participation_at(int i, int s) const { return double(load_float(participation + 4 * (i * modes + s))); }
};

bool find_body(ByteReader& in, int rows, BodyLayout& body) {
  const auto i16 = [&] {
    const std::uint8_t* at = in.take(2);
    return at ? int(load<std::int16_t>(at)) : -1;
  };
  body.modes = i16();
  if (body.modes < 1 || std::size_t(body.modes) > ReducedModel::max_modes) return false;
  for (auto& v : body.value) v = in.take_array(body.modes, 4);
  body.rows = i16();
  if (body.rows < 1 || body.rows > rows) return false;
  body.row = in.take_array(body.rows, 2);
  body.participation = in.take_array(body.rows * body.modes, 4);
  return in.ok();
}

bool mode_ok(const ReducedModel::Mode& m, double step_s) {
  return m.mass_s2 >= 0 && m.mass_s2 <= max_time_s && m.damping_s >= 0 && m.damping_s <= max_time_s &&
         m.stiffness(step_s) >= -rounding && std::abs(m.velocity) < max_rate && std::abs(m.force) < max_rate;
}

}  // namespace

bool reduced_model_fits(const ReducedModel& m, int rows) {
  if (m.modes.size() > ReducedModel::max_modes || m.groups.size() > ReducedModel::max_groups ||
      m.participation.size() < m.modes.size() * std::size_t(rows))
    return false;
  int next = 0;
  for (const ReducedModel::Group& g : m.groups) {
    if (g.first != next || g.modes < 1) return false;
    next += g.modes;
  }
  return next == m.size();
}

void write_reduced_model(ByteWriter& out, const ReducedModel& m, int rows) {
  // A body without a row in the message has no part in it.
  const auto count = [&](const ReducedModel::Group& g) {
    int n = 0;
    for (int i = 0; i < rows; ++i) n += m.touches(std::size_t(i), g);
    return n;
  };
  out.i8(std::int8_t(
      std::count_if(m.groups.begin(), m.groups.end(), [&](const ReducedModel::Group& g) { return count(g) > 0; })));
  for (const ReducedModel::Group& g : m.groups) {
    const int n = count(g);
    if (n == 0) continue;
    out.i16(std::int16_t(g.modes));
    using Mode = ReducedModel::Mode;
    for (double Mode::*value : {&Mode::mass_s2, &Mode::damping_s, &Mode::velocity, &Mode::force})
      for (int s = g.first; s < g.first + g.modes; ++s) out.f32(float(m.modes[std::size_t(s)].*value));
    out.i16(std::int16_t(n));
    for (int i = 0; i < rows; ++i)
      if (m.touches(std::size_t(i), g)) out.i16(std::int16_t(i));
    for (int i = 0; i < rows; ++i)
      if (m.touches(std::size_t(i), g))
        for (int s = g.first; s < g.first + g.modes; ++s) out.f32(float(m.row(std::size_t(i))[s]));
  }
}

bool skip_reduced_model(ByteReader& in, int rows) {
  const int bodies = in.i8();
  if (!in.ok() || bodies < 0 || std::size_t(bodies) > ReducedModel::max_groups) return false;
  BodyLayout body;
  std::size_t modes = 0;
  for (int b = 0; b < bodies; ++b) {
    if (!find_body(in, rows, body)) return false;
    modes += std::size_t(body.modes);
  }
  return modes <= ReducedModel::max_modes;
}

bool plausible_reduced_model(const ProblemLayout& l, const char*& why) {
  ByteReader in(l.reduced);
  std::array<double, max_problem_rows> moved{};  // W of the modes, by row
  BodyLayout body;
  for (int b = 0, bodies = in.i8(); b < bodies; ++b) {
    find_body(in, l.rows, body);
    why = "a mode is not finite, out of range or not passive";
    for (int s = 0; s < body.modes; ++s)
      if (!mode_ok(body.mode(s), l.step_s)) return false;
    int last = -1;
    for (int i = 0; i < body.rows; ++i) {
      why = "rows of a reduced model are not in order";
      const int row = body.row_at(i);
      if (row <= last || row >= l.rows) return false;
      last = row;
      why = "a row's part in a mode is not finite or larger than its compliance";
      for (int s = 0; s < body.modes; ++s) {
        const double p = body.participation_at(i, s);
        if (!(std::abs(p) < max_participation)) return false;
        moved[std::size_t(row)] += p * p;
      }
    }
  }
  for (int i = 0; i < l.rows; ++i)
    if (moved[std::size_t(i)] > (1 + rounding) * l.w_at(std::size_t(i) * std::size_t(i + 3) / 2)) return false;
  return true;
}

void read_reduced_model(const ProblemLayout& l, ReducedModel& into) {
  into.clear();
  BodyLayout body;
  ByteReader sizes(l.reduced);
  for (int b = 0, bodies = sizes.i8(); b < bodies; ++b) {
    find_body(sizes, l.rows, body);
    into.groups.push_back({into.size(), body.modes});
    for (int s = 0; s < body.modes; ++s) into.modes.push_back(body.mode(s));
  }
  into.participation.assign(std::size_t(l.rows) * into.modes.size(), 0.0);
  ByteReader in(l.reduced);
  in.i8();
  for (const ReducedModel::Group& g : into.groups) {
    find_body(in, l.rows, body);
    for (int i = 0; i < body.rows; ++i)
      for (int s = 0; s < g.modes; ++s)
        into.row(std::size_t(body.row_at(i)))[g.first + s] = body.participation_at(i, s);
  }
}

}  // namespace insula::wire
