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
  /// What is visible in one file.
  using Scope = std::map<std::string, Definition*, std::less<>>;

  struct Definition {
    std::string name, value;
    SourcePos pos, value_pos;
    const Scope* scope = nullptr;  ///< where its value's own variables are looked up
    enum class State { fresh, expanding, done } state = State::fresh;
    bool used = false;
  };

  Variables(Diagnostics& diagnostics, Suggestions& suggestions)
      : diagnostics_(diagnostics), suggestions_(suggestions) {}

  /// A new scope with what `outer` has; scopes live as long as this.
  Scope& new_scope(const Scope* outer);
  /// Reports names that are no names or already defined in this file (`local`); with `replace`, takes the place of an
  /// outer variable, else an outer one of the same name wins.
  void define(Scope& scope, Scope& local, const std::string& name, const std::string& value, const SourcePos& pos,
              const SourcePos& value_pos, bool replace);
  /// Replaces $x, ${x} and $$; false, and reported, when that fails.
  bool replace(std::string& text, const Scope& scope, const SourcePos& pos);
  void warn_unused();

  static bool is_name(std::string_view text);

 private:
  bool expand(Definition& definition, const SourcePos& pos);

  Diagnostics& diagnostics_;
  Suggestions& suggestions_;
  std::list<Definition> definitions_;
  std::list<Scope> scopes_;
  int depth_ = 0;
  std::size_t budget_ = 32u << 20;  ///< bytes all replacements together may produce
};

}  // namespace insula
