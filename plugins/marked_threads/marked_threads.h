// SPDX-License-Identifier: GPL-3.0-or-later
// Threads that are strung side by side between two bodies; some are marked.
#pragma once
#include <vector>

#include "core/params/list.h"
#include "plugins/strand_springs/strand_springs.h"

namespace insula {

class MarkedThreads final : public StrandSprings {
 public:
  Ref<Surface> near{this, {.name = "near", .doc = "surface where the threads begin"}};
  Ref<Surface> far{this, {.name = "far", .doc = "surface where they end"}};
  Param<Vec<Length>> first{this, {.name = "first", .doc = "middle of the first thread"}};
  Param<Vec<Length>> last{this, {.name = "last", .doc = "middle of the last thread"}};
  Param<int> threads{
      this, {.name = "threads", .fallback = "5", .min = "1", .max = "200", .doc = "their number, evenly apart"}};
  Param<List<int>> marked{this,
                          {.name = "marked",
                           .fallback = "",
                           .min = "1",
                           .max = "200",
                           .doc = "those that are marked, counted from 1: \"2 5\"; none: no thread is"}};

  Channel<Scalar> marked_standing{this,
                                  {.name = "marked_standing",
                                   .doc = "marked threads that are not parted",
                                   .min = "0",
                                   .shown = Shown::vital,
                                   .digits = 0}};
  Polylines sleeves{this,
                    {.name = "sleeves",
                     .doc = "the middle of each marked thread",
                     .material = "thread_mark",
                     .value = "1 whole, 0 about to be severed, negative: parted",
                     .radius = "0.45 mm",
                     .points_per_line = 3}};
  EventKind wrong{this,
                  {.name = "unmarked_thread_cut",
                   .doc = "a blade parted a thread that is not marked",
                   .value = "force of the blade or tension, N",
                   .bad = true}};

  void connect(PrepareContext& context, Simulation& simulation) override;
  void publish() override;
  bool is_marked(int i) const { return marked_[std::size_t(i)] != 0; }

 private:
  bool read_marks(PrepareContext& context);
  void part(const StepContext& context, Strand& s, const EventKind& what, double value) override;

  std::vector<char> marked_;  ///< by thread
};

}  // namespace insula
