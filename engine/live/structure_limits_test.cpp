// SPDX-License-Identifier: GPL-3.0-or-later
// What a structure bears is the same in all training exercises.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <set>

#include "core/base/text.h"
#include "core/registry/registry.h"
#include "core/scene/loader.h"

namespace insula {
namespace {

std::string value_of(const Component& component, std::string_view name) {
  for (const ParamBase* p : component.params())
    if (p->name() == name) return p->text();
  return {};
}

TEST(StructureLimits, AreTheSameInAllExercises) {
  Registry registry;
  register_builtin(registry);
  std::map<std::string, std::set<std::string>> limits;  ///< of each structure
  int exercises = 0;
  for (const auto& entry : std::filesystem::directory_iterator(INSULA_SOURCE_DIR "/scenes/training")) {
    if (entry.path().extension() != ".xml") continue;
    const LoadResult loaded = load_scene(entry.path(), registry);
    ASSERT_TRUE(loaded.scene) << loaded.diagnostics.format();
    std::set<std::string> spared;
    for (const Component* c : loaded.scene->components()) {
      if (c->element == "bleeding") limits["bleb"].insert(value_of(*c, "force") + ", " + value_of(*c, "sharp_force"));
      if (c->element != "fault_force") continue;
      const std::string on = value_of(*c, "on");
      for (std::string_view structure : split_blanks(on)) {
        limits[std::string(structure)].insert(value_of(*c, "limit") + " for " + value_of(*c, "grace"));
        spared.emplace(structure);
      }
    }
    for (const char* structure : {"frontal", "temporal", "insula", "window"})
      EXPECT_TRUE(spared.contains(structure)) << entry.path() << " does not watch " << structure;
    ++exercises;
  }
  EXPECT_EQ(exercises, 4);
  EXPECT_GE(limits.size(), 6u);
  for (const auto& [structure, all] : limits) EXPECT_EQ(all.size(), 1u) << structure << " bears " << *all.begin();
}

}  // namespace
}  // namespace insula
