// SPDX-License-Identifier: GPL-3.0-or-later
// The contacts of the last step as plain records, in memory that Python reads as a structured array. The names and
// types of the fields are those of insula.CONTACT.
#pragma once
#include <cstdint>
#include <memory>
#include <vector>

#include "core/sim/simulation.h"

namespace insula::python {

struct ContactRecord {
  std::int32_t body_a, body_b;        ///< index among the bodies
  std::int32_t surface_a, surface_b;  ///< index among the surfaces, -1: a rigid body's own pieces
  double position[3], normal[3];      ///< m; the normal pushes a
  double gap;                         ///< at the start of the step, m
  double normal_force;                ///< N
  double tangent_force[3];            ///< on a, N
};
static_assert(sizeof(ContactRecord) == 104);

/// The memory stays the same as long as all contacts fit. A reader keeps the memory that it reads alive.
class ContactRecords {
 public:
  void fill(const Simulation& simulation);
  std::size_t count() const { return count_; }
  const std::shared_ptr<std::vector<ContactRecord>>& memory() const { return memory_; }

 private:
  std::shared_ptr<std::vector<ContactRecord>> memory_ = std::make_shared<std::vector<ContactRecord>>(1024);
  std::size_t count_ = 0;
};

}  // namespace insula::python
