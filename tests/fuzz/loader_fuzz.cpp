// SPDX-License-Identifier: GPL-3.0-or-later
// libFuzzer target: whatever bytes a scene file holds, the loader returns, says the same thing twice, and gives either
// a scene or an error. One element of each kind, with a parameter of each type, stands for all.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "core/base/text.h"
#include "core/scene/loader.h"

namespace {
using namespace insula;

struct Thing : Component {
  static constexpr std::string_view kind_name = "body";
  Param<Force> force{this, {.name = "force", .fallback = "1 N", .min = "0.1 N", .max = "5 N", .doc = "force"}};
  Param<Torque> torque{this, {.name = "torque", .fallback = "0 N m", .doc = "torque"}};
  Param<Scalar> ratio{this, {.name = "ratio", .fallback = "0.45", .min = "0", .max = "0.499", .doc = "ratio"}};
  Param<bool> on{this, {.name = "on", .fallback = "true", .doc = "switch"}};
  Param<int> count{this, {.name = "count", .fallback = "3", .min = "1", .max = "100", .doc = "count"}};
  Param<std::string> words{this, {.name = "words", .fallback = "", .doc = "text"}};
  Param<Choice> side{this, {.name = "side", .fallback = "left", .choices = {"left", "right"}, .doc = "side"}};
  Param<Vec<Length>> at{this, {.name = "at", .fallback = "0 0 0 m", .min = "-1 m", .max = "1 m", .doc = "place"}};
  Param<LengthUnit> unit{this, {.name = "unit", .fallback = "mm", .doc = "unit"}};
  Param<File> file{this, {.name = "file", .fallback = "", .doc = "file"}};
};
struct Join : Component {
  Ref<Thing> one{this, {.name = "one", .doc = "one"}};
  RefList<Thing> many{this, {.name = "many", .fallback = "", .doc = "many"}};
  void prepare(PrepareContext& context) override {
    if (!one) std::abort();  // a required reference is there, or prepare is not called
    for (const Thing* t : many())
      if (!t) std::abort();
    if (one->count() == 7) error(context, one, "is seven");
  }
};
struct Inner : Component {
  Param<Pressure> young{this, {.name = "young", .doc = "stiffness"}};
};
struct Setting : Component {};
struct Lesson : Component {};

Registry elements() {
  Registry r;
  r.add<Thing>("thing", Kind::body, "thing");
  r.add<Join>("join", Kind::constraint, "join");
  r.add<Inner>("inner", Kind::force_model, "inner");
  r.add<Setting>("setting", Kind::settings, "setting");
  r.add<Lesson>("lesson", Kind::exercise, "lesson");
  r.add<Inner>("goal", Kind::exercise_rule, "goal");
  return r;
}

void require(bool condition, const char* what) {
  if (condition) return;
  std::fprintf(stderr, "violated: %s\n", what);
  std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  static const Registry registry = elements();
  static const char* folder = std::getenv("INSULA_FUZZ_FOLDER");
  static const std::string path = std::string(folder ? folder : ".") + "/fuzz.xml";
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const auto first = load_scene_text(text, path, registry);
  const auto second = load_scene_text(text, path, registry);
  require(first.ok() == first.diagnostics.ok(), "a scene or an error");
  require(first.diagnostics.format() == second.diagnostics.format(), "the same messages twice");
  require(find_invalid_utf8(first.diagnostics.format()) == std::string_view::npos, "messages are UTF-8");
  for (const auto& d : first.diagnostics.all())
    require(!d.pos.file.empty() && !d.text.empty(), "every message has a place and a text");
  if (first.ok()) {
    require(first.scene->content_hash() == second.scene->content_hash(), "the same hash twice");
    for (const Component* c : first.scene->components())
      require(first.scene->find(c->id) == c, "every component is found by its id");
  }
  return 0;
}
