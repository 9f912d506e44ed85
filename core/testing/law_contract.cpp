// SPDX-License-Identifier: GPL-3.0-or-later
// Checks the stated law on sampled states.
#include "core/testing/law_contract.h"

#include <fmt/format.h>

#include <cmath>
#include <optional>

#include "core/constraint/stated_law.h"
#include "core/mechanics/deformable_body.h"

namespace insula::test {

bool is_unilateral(const Component& c, const RowData& row) {
  if (row.block.law != LawKind::box) return true;
  const auto* stated = dynamic_cast<const StatesLaw*>(&c);
  if (stated && stated->law().kind == StatedLaw::Kind::potential) return false;
  return row.block.lower == 0;
}

namespace {

/// Directions along which a row's violation grows as fast as the scale of move().
std::vector<VecX> along(const RowData& row) {
  double square = 0;
  for (const VecX& h : row.h) square += h.squaredNorm();
  std::vector<VecX> dq;
  for (const VecX& h : row.h) dq.push_back(h / square);
  return dq;
}

struct Energies {
  double rows = 0, stated = 0;
};

class Probe {
 public:
  Probe(Findings& f, Simulation& s, Component& c)
      : findings_(f), s_(s), bench_(s, c), stated_(dynamic_cast<const StatesLaw&>(c)), restore_(s) {}

  void row(const RowKey& key, const RowData& row) {
    const std::vector<VecX> dq = along(row);
    for (const double target : {-2e-3, -5e-4, -1e-4, 1e-4, 5e-4, 2e-3}) {
      const double by = target - row.violation, e = 1e-6;  // m
      const Energies before = at(dq, by - e), here = at(dq, by), after = at(dq, by + e);
      const std::string place = fmt::format("where row {} of key {} has a violation of {:.3g} mm", key.second,
                                            key.first & ((std::uint64_t(1) << 44) - 1), 1e3 * target);
      if (std::isfinite(here.rows) != std::isfinite(here.stated)) {
        findings_.expect(false,
                         std::isfinite(here.rows) ? "its rows allow what its stated law forbids"
                                                  : "its rows forbid what its stated law allows",
                         place);
        continue;
      }
      if (!std::isfinite(before.rows + before.stated + here.rows + after.rows + after.stated)) continue;
      compare(-(after.rows - before.rows) / (2 * e), -(after.stated - before.stated) / (2 * e), row.block.compliance,
              place);
    }
    bench_.rows();
  }

 private:
  Energies at(const std::vector<VecX>& dq, double by) {
    move(s_, dq, by);
    Energies out;
    for (const auto& [key, r] : bench_.rows()) out.rows += r.potential();
    out.stated = stated_.law().energy;
    restore_();
    return out;
  }
  // Positive forces increase the violation.
  void compare(double rows, double stated, double compliance, const std::string& place) {
    const double allowed = 1e-5 * std::max(std::abs(rows), std::abs(stated)) + 1e-8;
    if (std::abs(rows - stated) <= allowed) return;
    const auto verb = [](double f) { return f > 0 ? "push" : "pull"; };
    std::string law;
    if (std::abs(stated) <= allowed) law = fmt::format("its rows {} where its stated law has no force", verb(rows));
    else if (std::abs(rows) <= allowed)
      law = fmt::format("its rows have no force where its stated law {}es", verb(stated));
    else if (rows * stated < 0) law = fmt::format("its rows {} where its stated law {}es", verb(rows), verb(stated));
    else law = "its rows' force is not that of its stated law";
    std::string found = fmt::format("{:.4g} N, expected {:.4g} N, {}", rows, stated, place);
    if (compliance > 0)
      found += fmt::format("; as if the violation were off by {:.3g} mm", 1e3 * (stated - rows) * compliance);
    const std::size_t at = law.find("pulles");
    if (at != std::string::npos) law.replace(at, 6, "pulls");
    findings_.expect(false, law, found);
  }

  Findings& findings_;
  Simulation& s_;
  RowBench bench_;
  const StatesLaw& stated_;
  Restore restore_;
};

void check_potential(Findings& findings, Simulation& s, Component& c, const RowMap& base, std::uint64_t seed) {
  std::vector<RowMap::const_iterator> with_law;
  for (auto it = base.begin(); it != base.end(); ++it)
    if (it->second.has_law() && std::abs(it->second.violation) > 1e-12) with_law.push_back(it);
  Probe probe(findings, s, c);
  const std::size_t n = with_law.size(), most = 3;
  for (std::size_t i = 0; i < std::min(n, most); ++i) {
    const auto& [key, row] = *with_law[(seed * most + i) % n];
    probe.row(key, row);
  }
}

/// Translation of one whole body by this vector; nothing if the body cannot be moved.
std::optional<std::vector<VecX>> shifted(const Simulation& s, std::size_t body, const Vec3& by) {
  std::vector<VecX> dq = no_motion(s);
  if (dynamic_cast<const DeformableBody*>(s.bodies()[body])) {
    for (int i = 0; i < dq[body].size() / 3; ++i) dq[body].segment<3>(3 * i) = by;
    return dq;
  }
  if (!dynamic_cast<const RigidBody*>(s.bodies()[body])) return {};
  dq[body].head<3>() = by;
  return dq;
}

void check_far(Findings& findings, Simulation& s, Component& c, const RowMap& base) {
  constexpr double far = 10;  // m
  RowBench bench(s, c);
  const Restore restore(s);
  int tried = 0;
  for (const auto& [key, row] : base) {
    if (!row.has_law() || ++tried > 2) continue;
    for (std::size_t b = 0; b < s.bodies().size(); ++b) {
      Vec3 net = Vec3::Zero();
      if (dynamic_cast<RigidBody*>(s.bodies()[b])) net = row.h[b].head<3>();
      else
        for (int i = 0; i < row.h[b].size() / 3; ++i) net += row.h[b].segment<3>(3 * i);
      if (net.norm() < 0.1) continue;
      const auto dq = shifted(s, b, far * net.normalized());
      if (!dq) continue;
      move(s, *dq, 1);
      for (const auto& [far_key, far_row] : bench.rows())
        if (far_row.has_law() && !far_row.h[b].isZero(0))
          findings.expect(far_row.violation >= 0, "its rows push things apart that are 10 m apart already",
                          name_of(far_key, far_row));
      restore();
    }
  }
  bench.rows();
}

}  // namespace

void check_stated_law(Findings& findings, Simulation& s, Component& c, std::uint64_t seed) {
  RowBench bench(s, c);
  const RowMap base = bench.rows();
  bool own = false;
  for (const auto& [key, row] : base)
    own = own || (row.has_law() && row.block.law == LawKind::box);  // a weld needs no statement
  const auto* stated = dynamic_cast<const StatesLaw*>(&c);
  if (own &&
      !findings.expect(
          stated,
          "adds rows with bounds or compliance and states no law; implement StatesLaw (core/constraint/stated_law.h)"))
    return;
  if (stated && stated->law().kind == StatedLaw::Kind::potential) return check_potential(findings, s, c, base, seed);
  for (const auto& [key, row] : base)
    if (row.positional() && (stated || row.has_law()))
      findings.expect(row.lower() == 0 && row.upper() > 0,
                      "its stated law only pushes, so a row's lower bound is 0 and its upper one above",
                      name_of(key, row));
  check_far(findings, s, c, base);
}

}  // namespace insula::test
