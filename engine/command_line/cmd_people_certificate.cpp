// SPDX-License-Identifier: GPL-3.0-or-later
// insula people certificate: what a person who has passed a curriculum can show.
#include <fmt/chrono.h>
#include <fmt/ostream.h>

#include "core/base/text.h"
#include "engine/command_line/people.h"
#include "engine/live/project_folder.h"
#include "engine/session/session_format.h"
#include "training/progress/attempts.h"
#include "training/progress/certificate.h"
#include "training/progress/local_time.h"

namespace insula {
namespace {

std::string day(std::int64_t ms) { return fmt::format("{:%Y-%m-%d}", fmt::localtime(std::time_t(ms / 1000))); }

void print(std::ostream& out, const training::Certificate& c) {
  fmt::print(out, "{} has passed the curriculum {}\n", c.person, in_quotes(c.curriculum));
  fmt::print(out, "from {} to {}\n", day(c.began_ms), day(c.passed_ms));
  for (const training::CertifiedTask& t : c.tasks) {
    fmt::print(out, "\n{}: {}, passed on {} after {} attempt{}\n", t.module, t.title, day(t.passed_ms),
               t.attempts_to_level, t.attempts_to_level == 1 ? "" : "s");
    for (const Gate& gate : t.gates)
      fmt::print(out, "  {}{}\n", gate.text,
                 gate.in_a_row > 1 ? fmt::format(", {} times in a row", gate.in_a_row) : "");
    for (const training::Run& r : t.runs) fmt::print(out, "  run {} of {}\n", r.uuid, day(r.began_ms));
  }
  fmt::print(out, "\ncurriculum {}, {}, digest {}\n", c.content, session::library(), c.digest);
  fmt::print(out, "A record of training on this machine, and no licence to operate.\n");
}

}  // namespace

int cmd_people_certificate(const CommandContext& context, const PeopleOptions& o) {
  const auto standing = standing_in(context, o);
  if (!standing) return 2;
  const auto certificate =
      training::certificate(standing->store, o.pseudonym, standing->curriculum, standing->progress);
  if (!certificate) {
    fmt::print(context.err, "error: {} has not passed {} yet: insula people progress says what is missing\n",
               in_quotes(o.pseudonym), in_quotes(standing->curriculum.title));
    return 2;
  }
  if (o.json) fmt::print(context.out, "{}\n", training::certificate_json(*certificate, session::library()).dump(2));
  else print(context.out, *certificate);
  return 0;
}

}  // namespace insula
