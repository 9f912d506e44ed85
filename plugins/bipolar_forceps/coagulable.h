// SPDX-License-Identifier: GPL-3.0-or-later
// What heat can close: the stumps of a vein, a tear. Components implement it; instruments that heat tissue read it.
#pragma once
#include <optional>

#include "core/mechanics/step_context.h"

namespace insula {

/// A place that heat can close.
struct CoagulationSite {
  Vec3 position;       ///< scene frame, m
  double washing = 0;  ///< blood that flows past it even between closed tips and carries heat away, m3/s
};

/// A component with such places. Their number stays the same while the scene runs.
class Coagulable {
 public:
  virtual ~Coagulable() = default;
  virtual int site_count() const = 0;
  /// The place as it is now, or nothing while heat does nothing there: closed already, or not open yet.
  virtual std::optional<CoagulationSite> site(int i) const = 0;
  /// Adds to the Arrhenius integral of a place, which closes at 1. Called between the solve and the report of a step.
  /// Returns whether it closed just now.
  virtual bool add_dose(const StepContext& context, int i, double dose) = 0;
  virtual double dose(int i) const = 0;  ///< Arrhenius integral so far; 1: closed
  /// Whether blood in the field covers this point of the scene.
  virtual bool covers(const Vec3& point) const = 0;
};

}  // namespace insula
