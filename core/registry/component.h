// SPDX-License-Identifier: GPL-3.0-or-later
// What every element of a scene file becomes: a component with parameters, an id, owned children and its place in the file.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/diagnostic.h"
#include "core/params/param.h"
#include "core/registry/command.h"

namespace insula {

/// The kinds of component. A kind says where an element may stand and which contract test applies to it.
enum class Kind {
  scene,        ///< the root element
  settings,     ///< time step, solver, view: at most one of each directly under the scene
  body,         ///< soft_body, obstacle: q, v, mass
  surface,      ///< collision and picture surface owned by a body
  force_model,  ///< force, stiffness, energy of the body that owns it
  support,      ///< holds degrees of freedom of the body that owns it
  constraint,   ///< adds rows to the constraint problem
  instrument,   ///< a hand-held tool
  exercise,     ///< goals, faults, motions
  exercise_rule,///< owned by an exercise
  motion,       ///< scripted two-hand motion, owned by an exercise
  complications,///< what may go wrong by chance: at most one directly under the scene
  complication, ///< one of them
};
std::string_view kind_name(Kind kind);  ///< "force model", "exercise rule", ...

/// What `prepare` may report to and ask for.
struct PrepareContext {
  Diagnostics& diagnostics;
  double time_step_s;  ///< of the scene
};

class Component {
 public:
  static constexpr std::string_view kind_name = "component";
  Component() = default;
  virtual ~Component() = default;
  Component(const Component&) = delete;
  Component& operator=(const Component&) = delete;

  /// Second phase of loading: parameters, references and children are in place. Read files, check what spans several
  /// parameters, build rest state. Report through the context; never throw for bad input. Called in document order,
  /// bodies first, children after their parent.
  virtual void prepare(PrepareContext&) {}

  /// What it can be asked for while the scene runs.
  virtual std::vector<CommandInfo> commands() const { return {}; }
  /// Does it, between two steps. Returns why not; empty when done. Bad arguments are refused, never clamped.
  virtual std::string run_command(std::string_view, std::string_view) { return "unknown command"; }

  const std::vector<ParamBase*>& params() const { return params_; }  ///< in order of declaration
  ParamBase* find_param(std::string_view name) const;
  /// The parameter that had this name in older scenes (ParamSpec::formerly); null when there is none.
  const ParamBase* find_renamed_param(std::string_view former_name) const;

  std::string id;        ///< as written, or the element name with its ordinal when none was given ("contact#1")
  std::string element;   ///< element name
  Kind kind = Kind::scene;
  SourcePos pos;         ///< of the start tag
  int order = 0;         ///< document position over all files, unique: the order of everything that must be reproducible
  Component* parent = nullptr;
  std::vector<std::unique_ptr<Component>> children;

  /// Children of C++ type T in document order.
  template <class T>
  std::vector<T*> children_of() const {
    std::vector<T*> out;
    for (const auto& c : children)
      if (auto* t = dynamic_cast<T*>(c.get())) out.push_back(t);
    return out;
  }
  /// Reports an error at this component's start tag, or at a parameter's value; then the parameter's name is put before
  /// the text, and the full path of a file parameter is replaced by what the author wrote.
  void error(PrepareContext& context, std::string text) const;
  void error(PrepareContext& context, const ParamBase& param, std::string text) const;

 private:
  friend class ParamBase;
  std::vector<ParamBase*> params_;
};

}  // namespace insula
