// SPDX-License-Identifier: GPL-3.0-or-later
// A learning record store (LRS) as a sender sees it. Source: xAPI 1.0.3, part three (Data Processing), 2.1.
#pragma once
#include <cstdint>
#include <string>

namespace insula::xapi {

struct Answer {
  int status = 0;                  ///< of HTTP; 0: none came
  std::string text;                ///< of the body; of the failure if there is no status
  std::int64_t retry_after_s = 0;  ///< what the store asks for; 0: nothing
};

class RecordStore {
 public:
  virtual ~RecordStore() = default;
  /// Posts a JSON list of statements. Never throws for what the network or the store does.
  virtual Answer post(const std::string& statements) = 0;
  /// Asks for one statement by its id.
  virtual Answer get(const std::string& id) = 0;
};

}  // namespace insula::xapi
