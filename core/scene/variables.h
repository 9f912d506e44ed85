// SPDX-License-Identifier: GPL-3.0-or-later
// Variables of scene files: definitions, visibility across includes, replacement.
#pragma once
#include <list>
#include <map>
#include <string>
#include <string_view>

#include "core/base/diagnostic.h"
#include "core/scene/suggestions.h"

namespace insula {

class Variables {
 public:
  struct Definition;
  /// The variables that are visible in one file.
  using Scope = std::map<std::string, Definition*, std::less<>>;

  struct Definition {
    std::string name, value;
    SourcePos pos, value_pos;
    const Scope* scope = nullptr;  ///< where the variables in its value are looked up
    enum class State { fresh, expanding, done } state = State::fresh;
    bool used = false;
  };

  Variables(Diagnostics& diagnostics, Suggestions& suggestions)
      : diagnostics_(diagnostics), suggestions_(suggestions) {}

  /// A new scope with the variables of `outer`. Scopes live as long as this object.
  Scope& new_scope(const Scope* outer);
  /// Reports invalid names and names that are already defined in this file (`local`). With `replace`, the new variable
  /// takes the place of an outer one. Otherwise an outer one of the same name takes precedence.
  void define(Scope& scope, Scope& local, const std::string& name, const std::string& value, const SourcePos& pos,
              const SourcePos& value_pos, bool replace);
  /// Replaces $x, ${x} and $$. Returns false, with a report, when that fails.
  bool replace(std::string& text, const Scope& scope, const SourcePos& pos);
  void warn_unused();
  /// Reports those of `given` that nothing uses as errors, with the nearest name.
  void refuse_unused(const Scope& given);

  static bool is_name(std::string_view text);

 private:
  bool expand(Definition& definition, const SourcePos& pos);

  Diagnostics& diagnostics_;
  Suggestions& suggestions_;
  std::list<Definition> definitions_;
  std::list<Scope> scopes_;
  int depth_ = 0;
  std::size_t budget_ = 32u << 20;  ///< limit of all replacements together, bytes
};

}  // namespace insula
