// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/curriculum/elements.h"

#include <algorithm>

namespace insula {
namespace {

template <class T>
std::unique_ptr<CurriculumElement> made() {
  auto element = std::make_unique<T>();
  for (ParamBase* p : element->params()) p->assign_fallback();
  return element;
}

}  // namespace

const std::vector<CurriculumElementInfo>& curriculum_elements() {
  static const std::vector<CurriculumElementInfo> elements{
      {"curriculum", "the root of a curriculum file: modules and warm-ups", {}, false, false, made<CurriculumRoot>},
      {"module",
       "tasks that belong together, and what must be passed before",
       {"curriculum"},
       true,
       false,
       made<ModuleElement>},
      {"task", "an exercise to be passed, with the gates that say when", {"module"}, true, false, made<TaskElement>},
      {"gate_goals", "all goals of the exercise are reached", {"task"}, false, false, made<GoalsGate>},
      {"gate_faults", "no faults are made, or few", {"task"}, false, false, made<FaultsGate>},
      {"gate_metric",
       "a metric keeps a limit, or a figure of a group of sessions",
       {"task"},
       false,
       false,
       made<MetricGate>},
      {"repetition", "spaced repetition of a task that was passed", {"task"}, false, true, made<RepetitionElement>},
      {"warm_up", "what comes before the first work of a day", {"curriculum"}, false, false, made<WarmUpElement>},
  };
  return elements;
}

const CurriculumElementInfo* find_curriculum_element(std::string_view name) {
  const auto& all = curriculum_elements();
  const auto found = std::find_if(all.begin(), all.end(), [&](const auto& info) { return info.name == name; });
  return found == all.end() ? nullptr : &*found;
}

std::vector<std::string> children_of_curriculum_element(std::string_view parent) {
  std::vector<std::string> out;
  for (const auto& info : curriculum_elements())
    if (std::find(info.parents.begin(), info.parents.end(), parent) != info.parents.end()) out.push_back(info.name);
  return out;
}

}  // namespace insula
