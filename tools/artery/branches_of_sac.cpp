// SPDX-License-Identifier: GPL-3.0-or-later
#include "branches_of_sac.h"

#include <algorithm>
#include <set>

namespace insula::artery {

std::vector<std::string> branches_of_sac(const Vessel& v) {
  const auto name = [&v](int vertex) -> const std::string& {
    return v.regions[std::size_t(v.region[std::size_t(vertex)])];
  };
  std::vector<char> outside(v.region.size());
  for (std::size_t i = 0; i < outside.size(); ++i) outside[i] = name(int(i)) != "sac" && name(int(i)) != "bleb";
  std::set<std::string> with_parent, all;
  for (const std::vector<int>& piece : connected_pieces(neighbours(v.wall.mesh), std::move(outside))) {
    const bool of_parent = std::any_of(piece.begin(), piece.end(), [&](int i) { return name(i) == "parent"; });
    for (const int i : piece) {
      if (!name(i).starts_with("branch")) continue;
      all.insert(name(i));
      if (of_parent) with_parent.insert(name(i));
    }
  }
  std::vector<std::string> out;
  std::set_difference(all.begin(), all.end(), with_parent.begin(), with_parent.end(), std::back_inserter(out));
  return out;
}

}  // namespace insula::artery
