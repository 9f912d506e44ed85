// SPDX-License-Identifier: GPL-3.0-or-later
// The force model whose attach() docs/bodies-in-plugins.md shows.
#include "core/mechanics/force_model.h"
#include "core/mechanics/shell_body.h"
#include "core/registry/registry.h"

namespace insula {

class MyWall : public ForceModel {
 public:
  void attach(PrepareContext& context, DeformableBody& body) override;
};

@SNIPPET@

}  // namespace insula
