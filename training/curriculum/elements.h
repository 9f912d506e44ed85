// SPDX-License-Identifier: GPL-3.0-or-later
// The elements of curriculum files, each declared once with its parameters. Reading, the schema and the reference pages
// come from these declarations.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/diagnostic.h"
#include "core/params/list.h"
#include "core/params/param.h"
#include "training/curriculum/limit_param.h"
#include "training/curriculum/period.h"

namespace insula {

struct ScenePart;

/// Base of every element.
struct CurriculumElement : ParamSet {
  static constexpr std::string_view kind_name = "element";
  std::string element;              ///< its name
  std::string id;                   ///< as written, with the prefix of an include; empty if none was given
  SourcePos pos;                    ///< of the start tag
  const ScenePart* part = nullptr;  ///< the file it is in
  std::vector<std::unique_ptr<CurriculumElement>> children;

  template <class T>
  std::vector<T*> children_of() const {
    std::vector<T*> out;
    for (const auto& c : children)
      if (auto* t = dynamic_cast<T*>(c.get())) out.push_back(t);
    return out;
  }
};

struct CurriculumRoot final : CurriculumElement {
  Param<std::string> title{this, {.name = "title", .doc = "name of the curriculum"}};
  Param<std::string> text{this, {.name = "text", .fallback = "", .doc = "what it is for, and for whom"}};
};

struct ModuleElement final : CurriculumElement {
  static constexpr std::string_view kind_name = "module";
  Param<std::string> title{this, {.name = "title", .doc = "name of the module"}};
  Param<std::string> text{this, {.name = "text", .fallback = "", .doc = "what is learnt in it"}};
  RefList<ModuleElement> needs{
      this, {.name = "requires", .fallback = "", .doc = "modules that must be passed before this one opens"}};
  Param<bool> in_order{
      this,
      {.name = "in_order", .fallback = "true", .doc = "whether a task opens only when those before it are passed"}};
};

struct TaskElement final : CurriculumElement {
  static constexpr std::string_view kind_name = "task";
  Param<std::string> title{this, {.name = "title", .doc = "name of the task"}};
  Param<std::string> text{this, {.name = "text", .fallback = "", .doc = "what the trainee should look out for"}};
  Param<File> scene{this, {.name = "scene", .doc = "scene file with the exercise"}};
  Param<Choice> mode{this,
                     {.name = "mode",
                      .fallback = "practice",
                      .choices = {"practice", "test"},
                      .doc = "attempts that count: in practice and in a test, or in a test alone, without help"}};
  Param<bool> guide{this,
                    {.name = "guide",
                     .fallback = "true",
                     .doc = "whether practice may show targets of a guide; a test never shows them"}};
  Param<List<int>> seeds{
      this,
      {.name = "seeds",
       .fallback = "",
       .min = "1",
       .max = "2147483647",
       .doc = "seeds of the complications, one attempt after the other; without them any seed counts"}};
};

/// What all gates share.
struct GateElement : CurriculumElement {
  Param<int> in_a_row{this,
                      {.name = "in_a_row",
                       .fallback = "1",
                       .min = "1",
                       .max = "100",
                       .doc = "attempts that must satisfy the gate one after the other"}};
  Param<Period> within{this,
                       {.name = "within",
                        .fallback = "",
                        .min = "1 h",
                        .max = "3650 day",
                        .doc = "longest time from the first of these attempts to the last; without it any time"}};
};

struct GoalsGate final : GateElement {};

struct FaultsGate final : GateElement {
  Param<std::string> faults{
      this, {.name = "faults", .fallback = "", .doc = "ids of the faults that count, with blanks between; none: all"}};
  Param<int> at_most{
      this,
      {.name = "at_most", .fallback = "0", .min = "0", .max = "1000", .doc = "largest number of them in an attempt"}};
};

struct MetricGate final : GateElement {
  Param<std::string> metric{this, {.name = "metric", .doc = "id of a metric of the scene's exercise"}};
  Param<Choice> hand{this,
                     {.name = "hand",
                      .fallback = "",
                      .choices = {"left", "right", "both"},
                      .doc = "hand, for a metric of each hand; otherwise both"}};
  Param<MetricLimit> at_most{this, {.name = "at_most", .fallback = "", .doc = "largest value that satisfies the gate"}};
  Param<MetricLimit> at_least{this,
                              {.name = "at_least", .fallback = "", .doc = "smallest value that satisfies the gate"}};
  Param<std::string> group{this,
                           {.name = "group",
                            .fallback = "",
                            .doc = "in place of limits: a group of the bands, whose figures are the limit"}};
  Param<Choice> level{this,
                      {.name = "level",
                       .fallback = "middle_half",
                       .choices = {"middle_half", "median", "pass_mark"},
                       .doc = "with a group: its worse quartile, its median, or the pass mark of the bands"}};
  Param<File> bands{this,
                    {.name = "bands",
                     .fallback = "",
                     .doc = "with a group: file of bands; without it NAME_bands.json beside the scene"}};
};

struct RepetitionElement final : CurriculumElement {
  Param<List<Period>> after{this,
                            {.name = "after",
                             .min = "1 h",
                             .max = "3650 day",
                             .doc = "times from one success to the next repetition, such as 1 3 7 30 day"}};
  Param<Period> grace{this,
                      {.name = "grace",
                       .fallback = "7 day",
                       .min = "1 h",
                       .max = "365 day",
                       .doc = "time after which a repetition that is due counts as missed"}};
  Param<bool> keep_on{
      this, {.name = "keep_on", .fallback = "false", .doc = "whether the last of these times comes again and again"}};
};

struct WarmUpElement final : CurriculumElement {
  Ref<TaskElement> task{this, {.name = "task", .fallback = "", .doc = "task to warm up with, once it has been passed"}};
  Param<File> scene{this, {.name = "scene", .fallback = "", .doc = "in place of a task: scene file to warm up with"}};
  Param<std::string> text{this, {.name = "text", .fallback = "", .doc = "what the trainee should look out for"}};
  Param<int> times{
      this, {.name = "times", .fallback = "1", .min = "1", .max = "20", .doc = "attempts before the day's work"}};
};

struct CurriculumElementInfo {
  std::string name;
  std::string doc;                                 ///< one line
  std::vector<std::string> parents;                ///< names of elements that may hold it; none: the root of a file
  bool needs_id;                                   ///< others name it, and so does the progress of a person
  bool once;                                       ///< at most one in its parent
  std::unique_ptr<CurriculumElement> (*create)();  ///< with defaults in place
};

/// All elements, the root first.
const std::vector<CurriculumElementInfo>& curriculum_elements();
/// Null if there is no element of that name.
const CurriculumElementInfo* find_curriculum_element(std::string_view name);
/// Names of the elements that may stand in that one.
std::vector<std::string> children_of_curriculum_element(std::string_view parent);

}  // namespace insula
