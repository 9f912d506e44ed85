// SPDX-License-Identifier: GPL-3.0-or-later
/*
# fixed

Fixes nodes of a soft body at their rest positions (a Dirichlet condition). The region is a ball, its outside, or a
half space. Several `<fixed>` elements add up. Fixed nodes are removed from the system matrix. They cost nothing and
do not move.
*/
#include "core/mechanics/force_model.h"
#include "core/registry/registry.h"

namespace insula {
namespace {

class Fixed final : public Support {
 public:
  Param<Choice> region{
      this,
      {.name = "region",
       .fallback = "all",
       .choices = {"all", "inside", "outside", "beyond"},
       .doc = "inside or outside a ball about centre; beyond the plane through centre, on the side of normal; or all"}};
  Param<Vec<Length>> centre{
      this, {.name = "centre", .fallback = "0 0 0 m", .doc = "centre of the ball, or a point of the plane"}};
  Param<Length> radius{this,
                       {.name = "radius", .fallback = "0 m", .min = "0 m", .max = "10 m", .doc = "radius of the ball"}};
  Param<Vec<Scalar>> normal{
      this, {.name = "normal", .fallback = "0 0 1", .doc = "normal of the plane, towards the held side"}};

  void fix(PrepareContext& context, const std::vector<Vec3>& rest, std::vector<char>& fixed) override {
    int count = 0;
    for (std::size_t i = 0; i < rest.size(); ++i) {
      const Vec3 d = rest[i] - centre();
      const bool in = region.is("all") || (region.is("inside") && d.norm() <= radius()) ||
                      (region.is("outside") && d.norm() >= radius()) || (region.is("beyond") && d.dot(normal()) >= 0);
      if (in) {
        fixed[i] = 1;
        ++count;
      }
    }
    if (count == 0 && !rest.empty()) error(context, "holds no node; is the region elsewhere, or its unit another one?");
  }
};

}  // namespace
}  // namespace insula

INSULA_PLUGIN(fixed) {
  registry.add<insula::Fixed>("fixed", insula::Kind::support, "holds the nodes of a region where they rest");
}
