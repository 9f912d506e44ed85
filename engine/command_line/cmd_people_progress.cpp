// SPDX-License-Identifier: GPL-3.0-or-later
// insula people progress: a person's standing in a curriculum.
#include <fmt/ostream.h>

#include "core/base/text.h"
#include "engine/authoring/curriculum_sources.h"
#include "engine/command_line/people.h"
#include "engine/live/project_folder.h"
#include "training/curriculum/evaluate.h"
#include "training/curriculum/loader.h"
#include "training/progress/attempts.h"
#include "training/progress/curriculum_json.h"
#include "training/progress/local_time.h"
#include "training/store/data_folder.h"

namespace insula {
namespace {

void print(std::ostream& out, const Curriculum& curriculum, const Progress& p) {
  fmt::print(out, "{}\n", curriculum.title);
  for (std::size_t i = 0; i < p.modules.size(); ++i) {
    fmt::print(out, "\n{:<8} {}\n", standing_name(p.modules[i].standing), curriculum.modules[i].title);
    for (std::size_t k = 0; k < p.modules[i].tasks.size(); ++k) {
      const TaskProgress& t = p.modules[i].tasks[k];
      fmt::print(out, "  {:<8} {} ({} attempt{})\n", standing_name(t.standing), curriculum.modules[i].tasks[k].title,
                 t.attempts, t.attempts == 1 ? "" : "s");
      for (const GateProgress& g : t.gates)
        fmt::print(out, "           {} {} of {}: {}\n", g.met ? "x" : "-", g.in_a_row, g.needed, g.text);
    }
  }
  fmt::print(out, "\nnext: {}\n", p.next.why.text);
  if (!p.next.scene.empty()) fmt::print(out, "      insula play {}\n", p.next.scene);
}

}  // namespace

std::optional<StandingInCurriculum> standing_in(const CommandContext& context, const PeopleOptions& o) {
  CurriculumFiles sources(context.registry);
  CurriculumResult loaded = load_curriculum(o.curriculum, sources);
  fmt::print(context.err, "{}", loaded.diagnostics.format());
  if (!loaded.curriculum) return std::nullopt;
  training::Store store(training::data_folder(o.data).store());
  if (!store.find(o.pseudonym)) {
    fmt::print(context.err, "error: nobody has the pseudonym {}\n", in_quotes(o.pseudonym));
    return std::nullopt;
  }
  const training::LocalTime at = training::local_time();
  Progress progress =
      evaluate(*loaded.curriculum, training::attempts_of(store, o.pseudonym, project_folder()), at.ms, at.offset);
  return StandingInCurriculum{std::move(*loaded.curriculum), std::move(progress), std::move(store)};
}

int cmd_people_progress(const CommandContext& context, const PeopleOptions& o) {
  const auto standing = standing_in(context, o);
  if (!standing) return 2;
  if (o.json)
    fmt::print(context.out, "{}\n", training::progress_json(standing->curriculum, standing->progress).dump(2));
  else print(context.out, standing->curriculum, standing->progress);
  return 0;
}

}  // namespace insula
