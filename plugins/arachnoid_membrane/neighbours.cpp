// SPDX-License-Identifier: GPL-3.0-or-later
// Gabriel's graph of strands.
#include "plugins/arachnoid_membrane/neighbours.h"

#include <algorithm>

namespace insula {
namespace {

struct Apart {
  double sum = 0;   ///< of the squared distances of both ends, m2
  double most = 0;  ///< the larger of the two, m2
  bool crossed = false;
};

Apart apart(const StrandState& p, const StrandState& q) {
  const double aa = (p.a - q.a).squaredNorm(), bb = (p.b - q.b).squaredNorm(), ab = (p.a - q.b).squaredNorm(),
               ba = (p.b - q.a).squaredNorm();
  if (aa + bb <= ab + ba) return {aa + bb, std::max(aa, bb), false};
  return {ab + ba, std::max(ab, ba), true};
}

}  // namespace

std::vector<StrandPair> neighbouring_strands(const std::vector<StrandState>& strands, double span) {
  const int n = int(strands.size());
  const auto at = [&](int i) -> const StrandState& { return strands[std::size_t(i)]; };
  std::vector<std::vector<int>> near(strands.size());
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n && at(i).integrity >= 0; ++j)
      if (j != i && at(j).integrity >= 0 && apart(at(i), at(j)).most < span * span) near[std::size_t(i)].push_back(j);
  std::vector<StrandPair> pairs;
  for (int i = 0; i < n; ++i)
    for (const int j : near[std::size_t(i)]) {
      if (j < i) continue;
      const Apart pair = apart(at(i), at(j));
      const std::vector<int>& others = near[std::size_t(i)];
      const bool between = std::any_of(others.begin(), others.end(), [&](int k) {
        return k != j && apart(at(i), at(k)).sum + apart(at(k), at(j)).sum < pair.sum;
      });
      if (!between) pairs.push_back({i, j, pair.crossed});
    }
  return pairs;
}

}  // namespace insula
