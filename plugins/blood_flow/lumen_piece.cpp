// SPDX-License-Identifier: GPL-3.0-or-later
// The lumens of a network as pieces between its stations. Stations whose wall could not be cut, as at a junction, are
// bridged.
#include "plugins/blood_flow/lumen_piece.h"

#include <cmath>
#include <numbers>

#include "plugins/blood_flow/blood_flow.h"

namespace insula {
namespace {

LumenEnd lumen_end(const Station& t, double flow, const VecX& q) {
  const double area = t.open ? t.now.area : 0;
  return {t.cuts.front().section.centre(q), std::sqrt(area / std::numbers::pi), flow};
}

}  // namespace

std::size_t BloodFlow::most_lumens() const {
  std::size_t n = 0;
  for (const Stretch& s : graph_.stretches) n += s.stations.size();
  return n;
}

void BloodFlow::append_lumens(std::vector<LumenPiece>& out) const {
  const VecX& q = blood_pressure->on->q();
  for (std::size_t i = 0; i < graph_.stretches.size(); ++i) {
    const Stretch& s = graph_.stretches[i];
    LumenPiece piece;
    piece.id = s.name;
    piece.sac = s.dead_end;
    piece.exchange = s.dead_end ? dye_.exchange[i] : 0;
    bool begun = false;
    piece.first = true;
    for (const Branch& b : graph_.branches) {
      if (b.stretch != int(i)) continue;
      // Behind the middle of a dead end nothing flows.
      const int last = s.dead_end ? int(s.stations.size()) : b.last;
      for (int k = b.first; k < last; ++k) {
        const Station& t = s.stations[std::size_t(k)];
        if (t.cuts.empty()) continue;
        piece.b = lumen_end(t, k < b.last ? b.flow : 0, q);
        if (begun) {
          out.push_back(piece);
          piece.first = false;
        }
        piece.a = piece.b;
        begun = true;
      }
    }
  }
}

}  // namespace insula
