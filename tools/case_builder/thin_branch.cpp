// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/thin_branch.h"

#include <algorithm>

#include "core/base/input_error.h"
#include "tools/case_builder/level_lines.h"
#include "tools/case_builder/openings.h"

namespace insula::case_builder {
namespace {

constexpr double much_longer = 1.8;        // a line that runs around the parent, over those around the branch
constexpr std::size_t direction_span = 3;  // lines

/// The first line that runs around the parent; the end where there is none.
std::size_t root_line(const std::vector<Loop>& lines) {
  std::vector<double> lengths;  // in order
  for (std::size_t k = 0; k < lines.size(); ++k) {
    if (lengths.size() > direction_span && lines[k].length > much_longer * lengths[lengths.size() / 2]) return k;
    lengths.insert(std::upper_bound(lengths.begin(), lengths.end(), lines[k].length), lines[k].length);
  }
  return lines.size();
}

/// Cuts at a line, without a new cap. False where that is no cut through this branch alone.
bool cut_at(artery::Surface& s, const Loop& line, const Vec3& outward) {
  artery::Surface shorter = s;
  try {
    cut_off(shorter, line.middle, outward, "stump");
  } catch (const InputError&) {
    return false;
  }
  if (shorter.caps.size() != s.caps.size()) return false;  // one has gone, and the stump has come
  const int stump = int(shorter.caps.size()) - 1;
  std::replace(shorter.patch.begin(), shorter.patch.end(), stump, -1);
  shorter.caps.pop_back();
  s = std::move(shorter);
  return true;
}

}  // namespace

bool remove_branch(artery::Surface& s, std::size_t cap) {
  const int tip = nearest_vertex(s.mesh, s.caps[cap].centre);
  const std::vector<Loop> lines = lines_of_distance(s.mesh, Geodesics(s.mesh).from(tip));
  for (std::size_t k = root_line(lines); k-- > direction_span;) {
    const Vec3 outward = lines[k - direction_span].middle - lines[k].middle;
    if (outward.norm() > 0 && cut_at(s, lines[k], outward.normalized())) return true;
  }
  return false;
}

}  // namespace insula::case_builder
