// SPDX-License-Identifier: GPL-3.0-or-later
// What an author changes in the exercises of a case: goals, faults, clocks and complications, and the strands. A change
// names the exercise, the id of its rule and a parameter of it, as the rule declares it; or that the rule is left out.
#pragma once
#include <string>
#include <vector>

#include "tools/case_builder/case_folder.h"

namespace insula::case_builder {

struct RuleChange {
  int exercise = 0;  ///< 1 to 4
  std::string rule;  ///< its id
  std::string parameter, value;
  bool off = false;  ///< the rule is left out
  std::string text() const;
};

/// "3.clip.max_grade=1", or "3.stenosis=off". Throws InputError.
RuleChange read_rule_change(const std::string& text);
/// Of Options::rules. Throws InputError.
std::vector<RuleChange> rule_changes(const Options& options);

/// The text of exercise `number` with the changes that name it. Parts that hold such a rule are written out in place of
/// their <include>; they are found from `folder`. Throws InputError with the change: no such rule or parameter, or a
/// value that the declaration does not allow.
std::string with_rules(std::string exercise, int number, const std::vector<RuleChange>& changes,
                       const fs::path& folder);

/// Goals, faults, clocks and complications of an exercise, those of its parts too:
/// [{"id", "element", "text", "values": {parameter: text}}]. Those without an id cannot be changed and are left out.
Json rules_of(const std::string& exercise, const fs::path& file);
/// The same of its strands and of the membranes between them.
Json strands_of(const std::string& exercise, const fs::path& file);

}  // namespace insula::case_builder
