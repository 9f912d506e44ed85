// SPDX-License-Identifier: GPL-3.0-or-later
// A hint before a tool strikes something: the tip moves towards it so fast that it would be there within a time that a
// person needs to react. A force on something hard jumps over its limit at once and foretells nothing; the way of the
// tip does.
#include <algorithm>
#include <array>

#include "core/collision/search/aabb_tree.h"
#include "core/collision/shapes/closest.h"
#include "core/mechanics/surface.h"
#include "plugins/hints/hint.h"
#include "plugins/hints/register.h"

namespace insula {
namespace {

/// Whether the way from p to q comes within `reach` of the surface, m. Looks at every triangle, so it suits surfaces of
/// some thousand.
bool comes_near(const Surface& surface, const Vec3& p, const Vec3& q, double reach) {
  Aabb way;
  way.add(p);
  way.add(q);
  way.inflate(reach);
  const std::vector<Vec3>& x = surface.positions();
  return std::any_of(surface.triangles().begin(), surface.triangles().end(), [&](const std::array<int, 3>& t) {
    const Vec3 &a = x[std::size_t(t[0])], &b = x[std::size_t(t[1])], &c = x[std::size_t(t[2])];
    Aabb box;
    box.add(a);
    box.add(b);
    box.add(c);
    return box.overlaps(way) && segment_triangle(p, q, a, b, c).distance2 <= reach * reach;
  });
}

class HintApproach final : public Hint {
 public:
  RefList<Body> on{this, {.name = "on", .doc = "what a tip is not to strike; surfaces of a few thousand triangles"}};
  Param<Speed> speed{this,
                     {.name = "speed",
                      .fallback = "15 mm/s",
                      .min = "0.1 mm/s",
                      .max = "1 m/s",
                      .doc = "largest speed at which a tip may come near"}};
  Param<Duration> within{this,
                         {.name = "within",
                          .fallback = "0.25 s",
                          .min = "0.05 s",
                          .max = "2 s",
                          .doc = "a tip comes near if it would be there after this time, at its present velocity"}};
  Param<Length> reach{this,
                      {.name = "reach",
                       .fallback = "0.3 mm",
                       .min = "0 mm",
                       .max = "10 mm",
                       .doc = "distance from the surface that counts as there, such as the radius of the tool"}};

  ChannelGroup<Speed> approach{this,
                               {.name = "approach",
                                .doc = "speed of the tip of a hand that comes near, else 0",
                                .min = "0 mm/s",
                                .shown = Shown::none,
                                .display = "mm/s",
                                .digits = 0}};

  void prepare(PrepareContext&) override { approach.declare({"left", "right"}); }
  void reset() override {
    Hint::reset();
    approach.reset();
    tip_ = {};
  }
  std::string watched() const override { return id + "." + approach.name(std::size_t(std::max(0, now().hand))); }
  std::string worded(double value) const override { return approach.text(value); }

 protected:
  void find(PrepareContext& context, const Simulation&) override {
    surfaces_.clear();
    for (Body* body : on())
      for (const Surface* s : body->children_of<Surface>())
        if (s->contact()) surfaces_.push_back(s);
    if (surfaces_.empty()) error(context, on, "has no surface that could be touched");
  }
  HintReading read(const StepReport& report) override {
    HintReading worst;
    for (int hand = 0; hand < 2; ++hand) {
      const Vec3 way = nearing(report.hands[std::size_t(hand)], tip_[std::size_t(hand)], report.h);
      const double v = way.norm();
      approach.set(std::size_t(hand), v);
      const double share = v / speed();
      if (!(share <= worst.share)) worst = {share, v, speed(), hand, 0, -way};
    }
    return worst;
  }

 private:
  struct Tip {
    const Instrument* tool = nullptr;
    Vec3 p = Vec3::Zero();
  };
  /// Velocity of a tip that would be at a surface in time, m/s; zero: it would not, or the tool has just come.
  Vec3 nearing(const HandReport& hand, Tip& last, double h) const {
    const bool same = hand.tool && hand.tool == last.tool;
    const Vec3 v = same && h > 0 ? Vec3((hand.tip.p - last.p) / h) : Vec3(Vec3::Zero());
    last = {hand.tool, hand.tip.p};
    if (!(v.squaredNorm() > 0)) return Vec3::Zero();
    const Vec3 there = hand.tip.p + within() * v;
    const bool near = std::any_of(surfaces_.begin(), surfaces_.end(),
                                  [&](const Surface* s) { return comes_near(*s, hand.tip.p, there, reach()); });
    return near ? v : Vec3(Vec3::Zero());
  }

  std::vector<const Surface*> surfaces_;
  std::array<Tip, 2> tip_;
};

}  // namespace

void register_hint_approach(Registry& registry) {
  registry.add<HintApproach>("hint_approach", Kind::exercise_rule, "a hint before the tip of a tool strikes something");
}

}  // namespace insula
