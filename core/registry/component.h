// SPDX-License-Identifier: GPL-3.0-or-later
// The base of every element of a scene file: a component with parameters, an id, owned children and its position in the
// file.
#pragma once
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/diagnostic.h"
#include "core/params/param.h"
#include "core/registry/channel.h"
#include "core/registry/command.h"
#include "core/registry/drawable.h"
#include "core/registry/event_kind.h"

namespace insula {

/// The kinds of component. The kind determines the allowed parents and the contract test.
enum class Kind {
  scene,          ///< the root element
  settings,       ///< time step, solver, view: at most one of each directly under the scene
  body,           ///< soft_body, obstacle: q, v, mass
  surface,        ///< collision and picture surface owned by a body
  force_model,    ///< force, stiffness, energy of the body that owns it
  support,        ///< fixes degrees of freedom of the body that owns it
  constraint,     ///< adds rows to the constraint problem
  instrument,     ///< a hand-held tool
  exercise,       ///< goals, faults, motions
  exercise_rule,  ///< owned by an exercise
  motion,         ///< scripted two-hand motion, owned by an exercise
  complications,  ///< random complications: at most one directly under the scene
  complication,   ///< one of these
  material,       ///< appearance by name
  metric,         ///< figures on skill, owned by an exercise
  condition,      ///< narrows the support that owns it
};
std::string_view kind_name(Kind kind);  ///< "force model", "exercise rule", ...

/// Services for `prepare`: reports of errors, and properties of the scene.
struct PrepareContext {
  Diagnostics& diagnostics;
  double time_step_s;  ///< of the scene
};

class Component : public ParamSet {
 public:
  static constexpr std::string_view kind_name = "component";
  Component() = default;

  /// Second phase of loading: parameters, references and children are available. Reads files, checks relations of
  /// several parameters, and builds the rest state. Reports errors through the context, and never throws for bad input.
  /// Called in document order, bodies first, children after their parent.
  virtual void prepare(PrepareContext&) {}

  /// Sets the present values of channels and drawables. Called at the start, at the end of each step and after a reset.
  /// Must not allocate once it has had its largest state.
  virtual void publish() {}

  /// Commands that it accepts while the scene runs.
  virtual std::vector<CommandInfo> commands() const { return {}; }
  /// Executes a command between two steps. Returns the reason for a refusal; empty when done. Bad arguments are
  /// refused, never clamped.
  virtual std::string run_command(std::string_view, std::string_view) { return "unknown command"; }

  const std::vector<ChannelBase*>& channels() const { return channels_; }      ///< in order of declaration
  const std::vector<DrawableBase*>& drawables() const { return drawables_; }   ///< in order of declaration
  const std::vector<EventKind*>& event_kinds() const { return event_kinds_; }  ///< in order of declaration

  std::string id;       ///< as written, or the element name with its number if none was given ("contact#1")
  std::string element;  ///< element name
  Kind kind = Kind::scene;
  SourcePos pos;  ///< of the start tag
  int order = 0;  ///< document position over all files, unique; everything reproducible follows this order
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
  /// Reports an error at this component's start tag, or at a parameter's value. In the second case the parameter's name
  /// is put before the text, and the full path of a file parameter is replaced by what the author wrote.
  void error(PrepareContext& context, std::string text) const;
  void error(PrepareContext& context, const ParamBase& param, std::string text) const;

 private:
  friend class ChannelBase;
  friend class DrawableBase;
  friend class EventKind;
  std::vector<ChannelBase*> channels_;
  std::vector<DrawableBase*> drawables_;
  std::vector<EventKind*> event_kinds_;
};

}  // namespace insula
