// SPDX-License-Identifier: GPL-3.0-or-later
// Scripted hands as CSV: where the applier goes, when buttons are pressed, what is asked for.
#pragma once
#include <string>
#include <vector>

#include "tools/case_builder/clip_plan.h"

namespace insula::case_builder {

class MotionScript {
 public:
  /// A key of a hand so many seconds after its last one; mm.
  void key(bool right, double seconds, const ApplierPose& pose, bool button1 = false, bool button2 = false);
  void command(double time, const std::string& text);
  double time(bool right) const { return time_[right]; }

  /// From outside the field: in, blades opened `open_at` mm before the place, closed there by their spring, let go, out
  /// again.
  void place_clip(const ApplierPose& pose, double open_at, double approach);
  /// Back onto a clip in the field: gripped, opened, drawn out.
  void take_clip(const ApplierPose& pose);
  std::string csv() const;

 private:
  struct Row {
    double time;
    std::string text;
  };
  std::vector<Row> rows_;
  double time_[2] = {0, 0};
};

/// mm along the shaft at which the applier is out of the field.
inline constexpr double out_of_field = 32;
ApplierPose drawn_back(ApplierPose pose, double mm);

}  // namespace insula::case_builder
