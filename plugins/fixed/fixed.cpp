// SPDX-License-Identifier: GPL-3.0-or-later
/*
# fixed

Fixes nodes of a deformable body at their rest positions (a Dirichlet condition). Fixed nodes are removed from the
system matrix. They cost nothing and do not move. Several `<fixed>` elements add up.

`region` selects the nodes by their rest positions:

| region | nodes | reads |
|---|---|---|
| `all` | all | |
| `inside`, `outside` | within a ball, or outside of it | `centre`, `radius` |
| `beyond` | beyond a plane, on the side of `normal` | `centre`, `normal` |
| `box`, `outside_box` | within a box along the axes of the scene, or outside of it | `centre`, `size` |

The surface of the ball belongs to both of its regions, and the plane to `beyond`. The surface of the box belongs to
`box`, to a nanometre.

`nodes` keeps only the listed nodes of the region. A node's index is its place in the mesh file, from 0. Nodes that no
tetrahedron uses are not counted. `insula run --export` writes the nodes in this order.

An intersection has one `<where>` for each further condition. `<where>` has the attributes of `<fixed>`. A node is
fixed if the region of `<fixed>` and those of all its `<where>` contain it:

```xml
<fixed region="beyond" centre="0 0 -19 mm" normal="0 0 -1">
  <where region="box" size="20 20 100 mm"/>
  <where region="outside" radius="5 mm"/>
</fixed>
```

A box at an angle is the intersection of six half spaces.
*/
#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "core/base/text.h"
#include "core/mechanics/force_model.h"
#include "core/registry/registry.h"

namespace insula {
namespace {

/// The parameters of a region, declared for `<fixed>` and `<where>` alike.
struct Region {
  explicit Region(ParamSet* owner) : owner_(owner) {}

  ParamSet* owner_;
  Param<Choice> region{
      owner_,
      {.name = "region",
       .fallback = "all",
       .choices = {"all", "inside", "outside", "beyond", "box", "outside_box"},
       .doc = "inside or outside a ball about centre; beyond the plane through centre, on the side of normal; in a box "
              "about centre or outside it; or all"}};
  Param<Vec<Length>> centre{
      owner_, {.name = "centre", .fallback = "0 0 0 m", .doc = "centre of the ball or box, or a point of the plane"}};
  Param<Length> radius{owner_,
                       {.name = "radius", .fallback = "0 m", .min = "0 m", .max = "10 m", .doc = "radius of the ball"}};
  Param<Vec<Scalar>> normal{
      owner_, {.name = "normal", .fallback = "0 0 1", .doc = "normal of the plane, towards the held side"}};
  Param<Vec<Length>> size{
      owner_,
      {.name = "size", .fallback = "0 0 0 m", .min = "0 m", .max = "10 m", .doc = "edges of the box along x, y and z"}};
  Param<std::string> nodes{owner_,
                           {.name = "nodes",
                            .fallback = "",
                            .doc = "only these nodes of the region: indices from 0, separated by blanks; none: all"}};

  bool contains(const Vec3& x) const {
    const Vec3 d = x - centre();
    if (region.is("inside")) return d.norm() <= radius();
    if (region.is("outside")) return d.norm() >= radius();
    if (region.is("beyond")) return d.dot(normal()) >= 0;
    if (region.is("all")) return true;
    return region.is("box") == ((d.cwiseAbs() - 0.5 * size()).array() <= 1e-9).all();  // to a nanometre
  }
};

/// Reports a size where no box reads it, and a box without one.
void check(const Component& owner, const Region& r, PrepareContext& context) {
  const bool box = r.region.is("box") || r.region.is("outside_box");
  if (box && !r.size.given()) owner.error(context, r.region, "a box needs its size");
  if (!box && r.size.given()) owner.error(context, r.size, "only a box has a size; write region=\"box\", or remove it");
}

/// One flag a node: whether `nodes` lists it. Without a list, all are set. Reports words that are no index of a node.
std::vector<char> listed(const Component& owner, const Region& r, PrepareContext& context, std::size_t count) {
  if (!r.nodes.given()) return std::vector<char>(count, 1);
  std::vector<char> out(count, 0);
  const auto words = split_blanks(r.nodes());
  if (words.empty()) owner.error(context, r.nodes, "lists no node; remove it to mean all of the region");
  for (const std::string_view word : words) {
    std::size_t index = 0;
    const auto [end, code] = std::from_chars(word.data(), word.data() + word.size(), index);
    if (end != word.data() + word.size() || code == std::errc::invalid_argument) {
      owner.error(context, r.nodes, in_quotes(word) + " is not the index of a node (a whole number from 0)");
    } else if (code != std::errc() || index >= count) {
      owner.error(context, r.nodes,
                  fmt::format("{} is no node of the body, which has the nodes 0 to {}", shown(word), count - 1));
    } else {
      out[index] = 1;
    }
  }
  return out;
}

class Where final : public Condition {
 public:
  Region region{this};

  void prepare(PrepareContext& context) override { check(*this, region, context); }
  void restrict(PrepareContext& context, const std::vector<Vec3>& rest, std::vector<char>& chosen) override {
    const std::vector<char> own = listed(*this, region, context, rest.size());
    for (std::size_t i = 0; i < rest.size(); ++i)
      if (!own[i] || !region.contains(rest[i])) chosen[i] = 0;
  }
};

class Fixed final : public Support {
 public:
  Region region{this};

  void prepare(PrepareContext& context) override { check(*this, region, context); }
  void fix(PrepareContext& context, const std::vector<Vec3>& rest, std::vector<char>& fixed) override {
    const int errors_before = context.diagnostics.errors();
    const std::vector<char> own = listed(*this, region, context, rest.size());
    int count = 0;
    for (std::size_t i = 0; i < rest.size(); ++i) {
      if (!own[i] || !region.contains(rest[i])) continue;
      fixed[i] = 1;
      ++count;
    }
    if (count == 0 && !rest.empty() && context.diagnostics.errors() == errors_before)
      error(context, "holds no node; is the region elsewhere, or its unit another one?");
  }
};

}  // namespace
}  // namespace insula

INSULA_PLUGIN(fixed) {
  registry.add<insula::Fixed>("fixed", insula::Kind::support, "holds the nodes of a region where they rest");
  registry.add<insula::Where>("where", insula::Kind::condition,
                              "restricts the support around it to nodes of a further region");
}
