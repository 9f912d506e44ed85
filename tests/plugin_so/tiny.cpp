// SPDX-License-Identifier: GPL-3.0-or-later
// A plugin as small as can be, built as a shared library for the tests of loading.
#define INSULA_PLUGIN_SHARED
#ifdef INSULA_TEST_WRONG_ABI
#include "core/registry/abi.h"
#undef INSULA_ABI_STRING
#define INSULA_ABI_STRING "insula 0 of another compiler"
#endif
#include "core/registry/registry.h"

namespace {

class TinyConstraint final : public insula::Component {
 public:
  insula::Param<insula::Force> strength{
      this, {.name = "strength", .fallback = "1 N", .min = "0 N", .max = "2 N", .doc = "how strong it is"}};
};

}  // namespace

INSULA_PLUGIN(tiny) {
  registry.add<TinyConstraint>("tiny_constraint", insula::Kind::constraint, "a constraint that does nothing");
#ifdef INSULA_TEST_REGISTERS_TWICE
  registry.add<TinyConstraint>("tiny_constraint", insula::Kind::constraint, "the same name again");
#endif
}
