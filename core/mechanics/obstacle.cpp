// SPDX-License-Identifier: GPL-3.0-or-later
// An obstacle has surfaces and no degrees of freedom.
#include "core/mechanics/obstacle.h"

#include "core/mechanics/force_model.h"

namespace insula {

void Obstacle::prepare(PrepareContext& context) {
  for (const ForceModel* f : children_of<ForceModel>())
    f->error(context, "has no effect on an obstacle, which never moves");
  for (const Support* s : children_of<Support>()) s->error(context, "has no effect on an obstacle, which never moves");
}

}  // namespace insula
