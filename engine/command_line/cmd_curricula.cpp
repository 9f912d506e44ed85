// SPDX-License-Identifier: GPL-3.0-or-later
// insula curricula: what may be followed.
#include <fmt/ostream.h>

#include "engine/authoring/curriculum_list.h"
#include "engine/command_line/people.h"
#include "engine/live/notice.h"

namespace insula {

int cmd_curricula(const CommandContext& context, const PeopleOptions& o) {
  CurriculumFiles sources(context.registry);
  const auto list = list_curricula(curriculum_folders(o.data), sources);
  const std::string json =
      curriculum_list_json(list, sources).dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
  if (!o.output.empty()) {
    if (leave_notice(o.output, json)) return 0;
    fmt::print(context.err, "error: {} cannot be written\n", o.output.string());
    return 1;
  }
  if (o.json) {
    fmt::print(context.out, "{}\n", json);
    return 0;
  }
  for (const ListedCurriculum& c : list) {
    if (c.curriculum) fmt::print(context.out, "{:<18} {}\n", c.id, c.curriculum->title);
    else fmt::print(context.err, "{}", c.problem);
  }
  return 0;
}

}  // namespace insula
