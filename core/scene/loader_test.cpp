// SPDX-License-Identifier: GPL-3.0-or-later
// Loading: places, names, ids, references, files, preparation and the messages of each.
#include "core/scene/loader.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "core/base/this_process.h"

namespace insula {
namespace {
namespace fs = std::filesystem;

using Log = std::vector<std::string>;

// The elements of these tests note in which order they are prepared.
template <int>
struct Noting : Component {
  static inline Log* log = nullptr;
  void prepare(PrepareContext&) override {
    if (log) log->push_back(id);
  }
};

struct Block : Noting<0> {
  static constexpr std::string_view kind_name = "body";
  Param<File> mesh{this, {.name = "mesh", .fallback = "", .doc = "mesh"}};
  Param<Vec<Length>> at{this, {.name = "at", .fallback = "0 0 0 m", .doc = "place"}};
  Param<bool> broken{this, {.name = "broken", .fallback = "false", .doc = "fail in prepare"}};
  void prepare(PrepareContext& context) override {
    Noting<0>::prepare(context);
    if (broken()) error(context, broken, "is broken");
  }
};
struct Goo : Noting<0> {
  Param<Pressure> young{this, {.name = "young", .min = "1 Pa", .max = "1 GPa", .doc = "Young's modulus"}};
};
struct Strand : Noting<0> {
  Ref<Block> from{this, {.name = "from", .doc = "one end"}};
  RefList<Block> to{this, {.name = "to", .fallback = "", .doc = "other ends"}};
};
struct PressureConstraint : Noting<0> {
  Ref<Block> wall{this, {.name = "wall", .fallback = "", .doc = "wall"}};
  Param<Pressure> systolic{this, {.name = "systolic", .doc = "highest pressure"}};
  Param<Pressure> diastolic{this, {.name = "diastolic", .doc = "lowest pressure"}};
};
struct Clip : Noting<0> {
  Param<Force> closing_force{
      this,
      {.name = "closing_force", .fallback = "1 N", .min = "0.1 N", .max = "5 N", .doc = "force", .formerly = "spring"}};
};
struct Thrower : Component {
  void prepare(PrepareContext&) override { throw std::runtime_error("something inside gave way"); }
};
struct Tuning : Noting<0> {};
struct Lesson : Noting<0> {};
struct Goal : Noting<0> {};

Registry elements() {
  Registry r;
  r.add<Block>("block", Kind::body, "a block");
  r.add<Goo>("goo", Kind::force_model, "elastic");
  r.add<Strand>("strand", Kind::constraint, "a thread");
  r.add<PressureConstraint>("pressure_constraint", Kind::constraint, "pressure");
  r.add<Clip>("clip", Kind::instrument, "a clip");
  r.add<Thrower>("thrower", Kind::constraint, "throws");
  r.add<Tuning>("tuning", Kind::settings, "settings");
  r.add<Lesson>("lesson", Kind::exercise, "an exercise");
  r.add<Goal>("goal", Kind::exercise_rule, "a goal");
  return r;
}

class Loader : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::path(testing::TempDir()) / (std::string("insula_") + info->name() + std::to_string(process_id()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override {
    Noting<0>::log = nullptr;
    fs::remove_all(folder_);
  }
  void write(const fs::path& name, std::string_view text) {
    fs::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name, std::ios::binary) << text;
  }
  LoadResult load(std::string_view text) { return load_scene_text(text, folder_ / "s.xml", registry_); }
  /// Messages without the folder of the test.
  std::string messages(const LoadResult& r) const {
    std::string text = r.diagnostics.format();
    const std::string prefix = folder_.generic_string() + "/";
    for (auto at = text.find(prefix); at != std::string::npos; at = text.find(prefix)) text.erase(at, prefix.size());
    return text;
  }
  std::string errors(std::string_view text) { return messages(load(text)); }

  Registry registry_ = elements();
  fs::path folder_;
};

TEST_F(Loader, BuildsTheTreeInDocumentOrder) {
  const auto r = load(R"(<scene title="t" time_step="20 ms" gravity="0 0 -9.81 m/s2">
  <strand from="a" to="a b"/>
  <block id="a"><goo young="2.1 kPa"/></block>
  <block id="b"/>
  <block/>
</scene>)");
  ASSERT_TRUE(r.ok()) << messages(r);
  const Scene& s = *r.scene;
  EXPECT_EQ(s.title(), "t");
  EXPECT_DOUBLE_EQ(s.time_step(), 0.02);
  EXPECT_DOUBLE_EQ(s.gravity().z(), -9.81);
  EXPECT_EQ(s.id, "scene#1");
  const auto blocks = s.all<Block>();
  ASSERT_EQ(blocks.size(), 3u);
  EXPECT_EQ(blocks[0]->id, "a");
  EXPECT_EQ(blocks[2]->id, "block#3");
  EXPECT_EQ(s.find("a"), blocks[0]);
  EXPECT_EQ(s.find_as<Strand>("a"), nullptr);
  EXPECT_EQ(s.find("block#3"), blocks[2]);
  EXPECT_EQ(s.find("nobody"), nullptr);
  const auto goo = s.all<Goo>();
  ASSERT_EQ(goo.size(), 1u);
  EXPECT_EQ(goo[0]->parent, blocks[0]);
  EXPECT_DOUBLE_EQ(goo[0]->young(), 2100);
  const auto strands = s.all<Strand>();
  EXPECT_EQ(strands[0]->from.get(), blocks[0]);
  EXPECT_EQ(strands[0]->to(), (std::vector<Block*>{blocks[0], blocks[1]}));
  int last = s.order;
  for (const Component* c : s.components()) {
    EXPECT_GT(c->order, last);
    last = c->order;
  }
}

TEST_F(Loader, PreparesBodiesFirstAndChildrenAfterParents) {
  Log log;
  Noting<0>::log = &log;
  const auto r = load(
      R"(<scene><strand id="s" from="b"/><block id="a"><goo id="g" young="1 Pa"/></block><clip id="c"/><block id="b"/></scene>)");
  ASSERT_TRUE(r.ok()) << messages(r);
  EXPECT_EQ(log, (Log{"a", "g", "b", "s", "c"}));
}

TEST_F(Loader, TheExampleOfTheManual) {
  EXPECT_EQ(errors("<scene>\n  <block id=\"wall\"/>\n\n"
                   "  <pressure_constraint wall=\"wall\"   sistolic=\"120 mmHg\" diastolic=\"10 N\"/>\n\n\n\n"
                   "  <clip closing_force=\"16 N\"/>\n</scene>\n"),
            "s.xml:4:38: error: <pressure_constraint> has no parameter \"sistolic\"; did you mean \"systolic\"?\n"
            "s.xml:4:69: error: diastolic: \"N\" is not a unit of pressure (use one of Pa, kPa, MPa, mmHg)\n"
            "s.xml:8:24: error: closing_force: 16 N is outside the allowed range 0.1 N to 5 N\n");
}

TEST_F(Loader, ElementsThatDoNotExistOrStandWrong) {
  EXPECT_EQ(errors("<scene><blok/></scene>"), "s.xml:1:8: error: unknown element <blok>; did you mean <block>?\n");
  EXPECT_EQ(errors("<scene><xyzzy/></scene>").substr(0, 73),
            "s.xml:1:8: error: unknown element <xyzzy> in <scene> (it may hold: tuning");
  EXPECT_EQ(errors("<scene><goo young=\"1 Pa\"/></scene>"),
            "s.xml:1:8: error: <goo> may not stand in <scene>; it belongs in a body (<block>)\n");
  EXPECT_EQ(errors("<scene><block><clip/></block></scene>"),
            "s.xml:1:15: error: <clip> may not stand in <block>; it belongs directly in <scene>\n");
  EXPECT_EQ(errors("<scene><goal/></scene>"),
            "s.xml:1:8: error: <goal> may not stand in <scene>; it belongs in an exercise (<lesson>)\n");
  EXPECT_EQ(errors("<block/>"), "s.xml:1:1: error: the root element must be <scene>, not <block>\n");
  EXPECT_EQ(errors("<part/>"),
            "s.xml:1:1: error: this is a part, which scenes include; the root of a scene is <scene>\n");
  EXPECT_EQ(errors("<scene><scene/></scene>").substr(0, 55), "s.xml:1:8: error: unknown element <scene> in <scene> (i");
  EXPECT_EQ(errors("<scene>\n<tuning/>\n<tuning/></scene>"),
            "s.xml:3:1: error: <tuning> may stand only once in a scene; the first is at line 2\n");
}

TEST_F(Loader, Parameters) {
  EXPECT_EQ(errors("<scene><block><goo/></block></scene>"),
            "s.xml:1:15: error: <goo> needs parameter \"young\" (pressure: Young's modulus)\n");
  EXPECT_EQ(errors("<scene><clip force_of_nature=\"1\"/></scene>"),
            "s.xml:1:14: error: <clip> has no parameter \"force_of_nature\" (it has: closing_force)\n");
  EXPECT_EQ(errors("<scene><clip spring=\"2 N\"/></scene>"),
            "s.xml:1:14: error: \"spring\" is now called \"closing_force\"\n");
  EXPECT_EQ(errors("<scene><tuning x=\"1\"/></scene>"),
            "s.xml:1:16: error: <tuning> has no parameter \"x\"; it has none\n");
  EXPECT_EQ(errors("<scene time_step=\"1 s\"/>"),
            "s.xml:1:19: error: time_step: 1 s is outside the allowed range 0.001 s to 0.05 s\n");
}

TEST_F(Loader, Ids) {
  EXPECT_EQ(errors("<scene>\n<block id=\"a\"/>\n<clip id=\"a\"/></scene>"),
            "s.xml:3:11: error: id \"a\" is already used at s.xml:2:1\n");
  EXPECT_NE(errors("<scene><block id=\"a b\"/></scene>").find("s.xml:1:19: error: id: \"a b\" may have only letters"),
            std::string::npos);
  EXPECT_NE(errors("<scene><block id=\"\"/></scene>").find("id: \"\""), std::string::npos);
  EXPECT_NE(errors("<scene><block id=\"block#1\"/></scene>").find("id: \"block#1\""), std::string::npos);
}

TEST_F(Loader, References) {
  EXPECT_EQ(errors("<scene><block id=\"frontal\"/><strand from=\"frontel\"/></scene>"),
            "s.xml:1:43: error: from: no component has the id \"frontel\"; did you mean \"frontal\"?\n");
  EXPECT_EQ(errors("<scene><block id=\"frontal\"/><strand from=\"xyz\"/></scene>"),
            "s.xml:1:43: error: from: no component has the id \"xyz\" (there are: frontal)\n");
  EXPECT_EQ(errors("<scene><block id=\"a\"/><strand id=\"s\" from=\"a\"/><strand from=\"s\"/></scene>"),
            "s.xml:1:62: error: from: \"s\" is a strand, not a body\n");
  EXPECT_EQ(errors("<scene><block id=\"a\"/><strand from=\"a\" to=\"a q r\"/></scene>"),
            "s.xml:1:44: error: to: no component has the id \"q\" (there are: a)\n"
            "s.xml:1:44: error: to: no component has the id \"r\" (there are: a)\n");
  // A component that could not be built is no second mistake where it is named.
  EXPECT_EQ(errors("<scene><blok id=\"a\"/><strand from=\"a\"/></scene>"),
            "s.xml:1:8: error: unknown element <blok>; did you mean <block>?\n");
}

TEST_F(Loader, BrokenComponentsAreNotPreparedNorWhatStandsOnThem) {
  Log log;
  Noting<0>::log = &log;
  EXPECT_EQ(
      errors(
          R"(<scene><block id="a" broken="true"><goo id="g" young="1 Pa"/></block><strand id="s" from="a"/><strand id="t" from="b"/><block id="b"/></scene>)"),
      "s.xml:1:30: error: broken: is broken\n");
  EXPECT_EQ(log, (Log{"a", "b", "t"}));
}

TEST_F(Loader, ExceptionsBecomeMessages) {
  EXPECT_EQ(errors("<scene><thrower/></scene>"), "s.xml:1:8: error: <thrower>: something inside gave way\n");
}

TEST_F(Loader, Files) {
  write("m/a.msh", "mesh");
  write("../insula_outside.msh", "x");
  EXPECT_EQ(errors("<scene><block mesh=\"m/a.msh\"/></scene>"), "");
  EXPECT_EQ(errors("<scene><block mesh=\"m/b.msh\"/></scene>"),
            "s.xml:1:21: error: mesh: \"m/b.msh\" does not exist; did you mean \"m/a.msh\"?\n");
  EXPECT_EQ(errors("<scene><block mesh=\"m\"/></scene>"), "s.xml:1:21: error: mesh: \"m\" is not a file\n");
  EXPECT_NE(errors("<scene><block mesh=\"/etc/passwd\"/></scene>").find("mesh: \"/etc/passwd\" is an absolute path"),
            std::string::npos);
  EXPECT_NE(errors("<scene><block mesh=\"../insula_outside.msh\"/></scene>").find("leaves the scene's root folder"),
            std::string::npos);
  fs::create_symlink("../../insula_outside.msh", folder_ / "m" / "link.msh");
  EXPECT_NE(errors("<scene><block mesh=\"m/link.msh\"/></scene>").find("leaves the scene's root folder"),
            std::string::npos);
  fs::remove(folder_.parent_path() / "insula_outside.msh");
  const auto r = load("<scene><block mesh=\"m/../m/a.msh\"/></scene>");
  ASSERT_TRUE(r.ok());
  EXPECT_EQ(r.scene->all<Block>()[0]->mesh(), fs::canonical(folder_ / "m" / "a.msh"));
}

TEST_F(Loader, TheRootFolderIsTheOneWithMeshes) {
  write("meshes/a.msh", "mesh");
  write("scenes/training/s.xml", "<scene><block mesh=\"../../meshes/a.msh\"/></scene>");
  const auto r = load_scene(folder_ / "scenes/training/s.xml", registry_);
  ASSERT_TRUE(r.ok()) << messages(r);
  EXPECT_EQ(r.scene->root_folder(), fs::canonical(folder_));
}

TEST_F(Loader, ContentHashSeesEveryFile) {
  write("a.msh", "1");
  write("p.xml", "<part/>");
  const char* scene = "<scene><include file=\"p.xml\"/><block mesh=\"a.msh\"/></scene>";
  const auto before = load(scene).scene->content_hash();
  EXPECT_EQ(load(scene).scene->content_hash(), before);
  write("a.msh", "2");
  const auto after = load(scene).scene->content_hash();
  EXPECT_NE(after, before);
  write("p.xml", "<part></part>");
  EXPECT_NE(load(scene).scene->content_hash(), after);
}

TEST_F(Loader, FilesThatAreNoScenes) {
  EXPECT_EQ(messages(load_scene(folder_ / "none.xml", registry_)), "none.xml: error: no such file\n");
  fs::create_directories(folder_ / "dir.xml");
  EXPECT_EQ(messages(load_scene(folder_ / "dir.xml", registry_)), "dir.xml: error: is not a file\n");
}

TEST_F(Loader, ManyErrorsAreCutButStayErrors) {
  std::string text = "<scene>";
  for (int i = 0; i < 1000; ++i) text += "\n<variable name=\"v" + std::to_string(i) + "\" value=\"1\"/>";
  for (int i = 0; i < 1000; ++i) text += "\n<blok/>";
  const auto r = load(text + "</scene>");
  EXPECT_FALSE(r.ok());
  EXPECT_FALSE(r.diagnostics.ok());
  EXPECT_EQ(r.diagnostics.all().size(), 101u);
  EXPECT_NE(messages(r).find("error: and 900 more errors and 1000 more warnings"), std::string::npos) << messages(r);
}

}  // namespace
}  // namespace insula
