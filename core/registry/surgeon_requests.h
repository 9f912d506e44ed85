// SPDX-License-Identifier: GPL-3.0-or-later
// What the operating surgeon asks the anaesthetist for. Other commands are the instructor's alone.
#pragma once
#include <string>
#include <vector>

namespace insula {

struct SurgeonRequest {
  std::string command;  ///< one of the component's commands()
  double usual = 0;     ///< its usual argument, in the command's unit and range; 0 if it takes no number
};

/// A component that takes requests of the surgeon derives from it.
class TakesSurgeonRequests {
 public:
  virtual std::vector<SurgeonRequest> surgeon_requests() const = 0;

 protected:
  ~TakesSurgeonRequests() = default;
};

}  // namespace insula
