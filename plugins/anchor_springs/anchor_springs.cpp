// SPDX-License-Identifier: GPL-3.0-or-later
/*
# anchor_springs

An elastic foundation that holds a wall from outside. It stands for arachnoid, fluid and the tissue around a vessel. A
spring pulls each node to its position at rest. Its stiffness is proportional to the node's share of the wall
(Winkler's foundation, in all directions):

    f = -k A_i (x - X),   A_i a third of the triangles about the node,   k the foundation modulus

with damping k A_i T v. The foundation is linear. It does not follow a wall that moves as a whole, but pulls it back.
*/
#include <algorithm>

#include "core/base/text.h"
#include "core/mechanics/shell_body.h"
#include "core/registry/registry.h"

namespace insula {
namespace {

class AnchorSprings final : public ForceModel {
 public:
  Param<std::string> regions{this,
                             {.name = "regions",
                              .fallback = "",
                              .doc = "regions of the wall that are held, separated by blanks; none: all of them"}};
  Param<FoundationModulus> stiffness{this,
                                     {.name = "stiffness",
                                      .fallback = "1 kPa/mm",
                                      .min = "0 N/m3",
                                      .max = "10 N/mm3",
                                      .doc = "pressure that moves the wall by a length, over that length"}};
  Param<Duration> damping{this,
                          {.name = "damping",
                           .fallback = "20 ms",
                           .min = "0 s",
                           .max = "10 s",
                           .doc = "viscous over elastic modulus: the time in which it creeps back"}};

  void attach(PrepareContext& context, DeformableBody& body) override;
  void couplings(std::vector<std::pair<int, int>>&, Tangent) const override {}
  void bind(const BlockMatrix& a, const std::vector<int>& free_of_node) override {
    for (Spring& s : springs_) {
      const int block = free_of_node[std::size_t(s.node)];
      s.slot = block < 0 ? -1 : a.diagonal(block);
    }
  }
  void linearise(const double* x, double* force, BlockMatrix* matrix, double h, Tangent) override {
    const double scale = stiffness() * (1 + (h > 0 ? damping() / h : 0));
    for (const Spring& s : springs_) {
      for (int c = 0; c < 3; ++c) force[3 * s.node + c] -= stiffness() * s.area * (x[3 * s.node + c] - s.rest[c]);
      if (!matrix || s.slot < 0) continue;
      double* d = matrix->block(s.slot);
      for (int c = 0; c < 3; ++c) d[4 * c] += scale * s.area;
    }
  }
  double energy(const double* x) override {
    double sum = 0;
    for (const Spring& s : springs_)
      for (int c = 0; c < 3; ++c)
        sum += 0.5 * stiffness() * s.area * (x[3 * s.node + c] - s.rest[c]) * (x[3 * s.node + c] - s.rest[c]);
    return sum;
  }
  double stiffness_damping() const override { return damping(); }
  bool internal() const override { return false; }

 private:
  struct Spring {
    int node, slot;
    double area;  // m2
    Vec3 rest;
  };
  std::vector<Spring> springs_;
};

void AnchorSprings::attach(PrepareContext& context, DeformableBody& body) {
  const auto* shell = dynamic_cast<const ShellBody*>(&body);
  if (!shell) return error(context, "needs a wall of triangles: it belongs in a <shell_body>");
  const std::vector<std::string>& names = shell->model().regions;
  const auto words = split_blanks(regions());
  std::vector<char> wanted(names.size(), words.empty());
  for (const std::string_view word : words) {
    const int r = shell->region(word);
    if (r >= 0) {
      wanted[std::size_t(r)] = 1;
      continue;
    }
    const std::string near = nearest_name(word, names);
    error(context, regions,
          in_quotes(word) + " is no region of the wall" + did_you_mean(near) + " (it has " + joined(names) + ")");
  }
  const std::vector<Vec3>& rest = shell->rest_nodes();
  std::vector<double> area(rest.size(), 0.0);
  for (const auto& t : shell->wall_triangles()) {
    if (!wanted[std::size_t(shell->region_of_triangle(t))]) continue;
    const Vec3 &a = rest[std::size_t(t[0])], &b = rest[std::size_t(t[1])], &c = rest[std::size_t(t[2])];
    for (int n : t) area[std::size_t(n)] += (b - a).cross(c - a).norm() / 6;
  }
  springs_.clear();
  for (std::size_t i = 0; i < rest.size(); ++i)
    if (area[i] > 0) springs_.push_back({int(i), -1, area[i], rest[i]});
}

}  // namespace
}  // namespace insula

INSULA_PLUGIN(anchor_springs) {
  registry.add<insula::AnchorSprings>("anchor_springs", insula::Kind::force_model,
                                      "soft support that draws a wall back to its place");
}
