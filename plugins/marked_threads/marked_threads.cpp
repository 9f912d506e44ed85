// SPDX-License-Identifier: GPL-3.0-or-later
/*
# marked_threads

Threads for practice. They are strung side by side between two bodies, and some carry a coloured sleeve. Each thread
runs between the vertices of both surfaces that are nearest to its middle. The middles lie evenly apart between `first`
and `last`. A thread behaves as a strand of <strand_springs>: tension only, cut by blades, torn by too much tension.

    delta = |qi - qj| - l0,   delta + lambda / k = 0,   lambda <= 0
*/
#include "plugins/marked_threads/marked_threads.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/registry/registry.h"

namespace insula {
namespace {

MaterialPoint nearest_vertex(const Surface& surface, const Vec3& place) {
  const auto& vertices = surface.rest().vertices;
  std::size_t best = 0;
  for (std::size_t i = 1; i < vertices.size(); ++i)
    if ((vertices[i] - place).squaredNorm() < (vertices[best] - place).squaredNorm()) best = i;
  return surface.points()[best];
}

}  // namespace

bool MarkedThreads::read_marks(PrepareContext& context) {
  marked_.assign(std::size_t(threads()), 0);
  for (const int k : marked()) {
    if (k > threads()) {
      error(context, marked, fmt::format("{} is no thread; there are the threads 1 to {}", k, threads()));
      return false;
    }
    marked_[std::size_t(k - 1)] = 1;
  }
  return true;
}

void MarkedThreads::connect(PrepareContext& context, Simulation& simulation) {
  StrandSprings::connect(context, simulation);
  if (from) error(context, from, "threads are strung between near and far; remove it");
  if (!read_marks(context)) return;
  for (int k = 0; k < threads(); ++k) {
    const Vec3 middle = threads() > 1 ? Vec3(first() + double(k) / (threads() - 1) * (last() - first())) : first();
    add_strand(nearest_vertex(*near, middle), nearest_vertex(*far, middle));
  }
}

void MarkedThreads::part(const StepContext& context, Strand& s, const EventKind& what, double value) {
  StrandSprings::part(context, s, what, value);
  const int i = int(&s - strands().data());
  if (&what == &cut && !is_marked(i) && context.events)
    context.events->emit({wrong.name(), id, "", value, context.time + context.h, s.blade ? s.blade->hand_index() : -1});
}

void MarkedThreads::publish() {
  StrandSprings::publish();
  int standing_marked = 0;
  std::size_t line = 0;
  sleeves.resize(std::size_t(std::count(marked_.begin(), marked_.end(), 1)));
  for (int i = 0; i < count() && i < int(marked_.size()); ++i) {
    if (!is_marked(i)) continue;
    const StrandState s = strand(i);
    standing_marked += s.integrity >= 0;
    for (int k = 0; k < 3; ++k) {
      const double along = 0.3 + 0.2 * k;
      sleeves.set(line, std::size_t(k), (1 - along) * s.a + along * s.b, s.integrity);
    }
    ++line;
  }
  marked_standing.set(standing_marked);
}

}  // namespace insula

INSULA_PLUGIN(marked_threads) {
  registry.add_material({"thread_mark", "place", {0.10, 0.62, 0.86, 1}, 0.5, 0, 0});
  registry.add<insula::MarkedThreads>("marked_threads", insula::Kind::constraint,
                                      "threads for practice between two bodies, of which some are marked");
}
