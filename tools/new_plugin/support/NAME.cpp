// SPDX-License-Identifier: GPL-3.0-or-later
/*
# @name@

Holds the nodes of a body that lie within a ball where they rest.
*/
#include "core/mechanics/force_model.h"
#include "core/registry/registry.h"

namespace insula {
namespace {

class @Name@ final : public Support {
 public:
  Param<Vec<Length>> centre{this, {.name = "centre", .doc = "centre of the ball"}};
  Param<Length> radius{this,
                       {.name = "radius", .fallback = "5 mm", .min = "0.1 mm", .max = "1 m", .doc = "of the ball"}};

  // Once, when the body's nodes are known: mark the nodes that are fixed.
  void fix(PrepareContext& context, const std::vector<Vec3>& rest, std::vector<char>& held) override {
    int count = 0;
    for (std::size_t i = 0; i < rest.size(); ++i) {
      if ((rest[i] - centre()).norm() > radius()) continue;
      held[i] = 1;
      ++count;
    }
    if (count == 0 && !rest.empty()) error(context, centre, "no node lies within the ball");
  }
};

}  // namespace
}  // namespace insula

INSULA_PLUGIN(@name@) { registry.add<insula::@Name@>("@name@", insula::Kind::support, "@doc@"); }
