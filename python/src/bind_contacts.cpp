// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts of the last step.
#include "python/src/bind.h"

namespace insula::python {

namespace {

/// numpy.dtype of a ContactRecord.
nb::object record_type() {
  nb::list fields;
  for (const char* name : {"body_a", "body_b", "surface_a", "surface_b"}) fields.append(nb::make_tuple(name, "i4"));
  for (const char* name : {"position", "normal"}) fields.append(nb::make_tuple(name, "f8", 3));
  for (const char* name : {"gap", "normal_force"}) fields.append(nb::make_tuple(name, "f8"));
  fields.append(nb::make_tuple("tangent_force", "f8", 3));
  return nb::module_::import_("numpy").attr("dtype")(fields);
}

nb::object contacts_of(Run& run) {
  const Run::Turn turn(run);
  run.contacts().fill(run.simulation());
  using Memory = std::shared_ptr<std::vector<ContactRecord>>;
  const Memory& memory = run.contacts().memory();
  nb::capsule owner(new Memory(memory), [](void* p) noexcept { delete static_cast<Memory*>(p); });
  const std::size_t bytes = run.contacts().count() * sizeof(ContactRecord);
  return nb::cast(view(reinterpret_cast<const std::uint8_t*>(memory->data()), {bytes}, owner))
      .attr("view")(record_type());
}

}  // namespace

void bind_contacts(nb::module_&, RunClass& run) {
  run.def_prop_ro(
      "contacts", &contacts_of, nb::sig("def contacts(self) -> numpy.typing.NDArray[numpy.void]"),
      "Contacts of the last step as a structured array: body_a, body_b (indices among `bodies`), surface_a, "
      "surface_b (among `surfaces`; -1: a rigid body's own pieces), position and normal (m; the normal "
      "pushes a), gap at the start of the step (m), normal_force (N) and tangent_force on a (N). It is a "
      "view of memory that the next use of `contacts` after a step writes anew.");
}

}  // namespace insula::python
