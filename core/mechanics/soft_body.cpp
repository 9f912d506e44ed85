// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a soft body's mesh.
#include "core/mechanics/soft_body.h"

#include "core/base/input_error.h"

namespace insula {

void SoftBody::prepare(PrepareContext& context) {
  if (!given_) {
    try {
      rest_ = read_tet_mesh(mesh(), mesh_unit());
    } catch (const InputError& e) {
      error(context, mesh, e.what());
      return;
    }
  }
  start_at_rest();
}

}  // namespace insula
