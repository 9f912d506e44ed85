// SPDX-License-Identifier: GPL-3.0-or-later
// The scene editor as its gateway keeps it: copies, texts with their versions, names that lead elsewhere, and checks.
// A script stands for insula; the browser test uses the real one.
#include "viewer/gateway/studio_scenes.h"

#include <gtest/gtest.h>

#include <fstream>
#include <optional>
#include <thread>

#include "core/testing/temp_folder.h"

namespace insula::gateway {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;

constexpr const char* shipped = "<scene>\n  <!-- kept -->\n  <include file=\"part.xml\"/>\n</scene>\n";

/// Copies as `insula cases copy` does. Its check finds one problem in each line with "wrong".
constexpr const char* scene_program = R"sh(#!/bin/sh
here=$(dirname "$0")
case "$1 $2" in
"list --scenes") echo "[{\"scene\": \"$here/shipped/first.xml\", \"title\": \"First\"}]";;
"list --json") echo '{"elements": [{"name": "scene"}]}';;
"cases copy")
  [ -e "$here/full" ] && echo "error: the disk is full" && exit 2
  [ -d "$3" ] && from="$3" || from=$(dirname "$3")
  mkdir -p "$4/scenes" && cp "$from"/*.xml "$4/scenes" && ln -s /etc/passwd "$4/scenes/link.xml"
  echo '{"scenes": ["scenes/first.xml"]}' > "$4/insula_case.json";;
"cases new")
  mkdir -p "$3/meshes" && echo mesh > "$3/meshes/block.msh" && echo '<scene/>' > "$3/$(basename "$3").xml"
  echo "{\"scenes\": [\"$(basename "$3").xml\"]}" > "$3/insula_case.json";;
"check --json")
  [ -e "$here/slow" ] && touch "$here/sleeps" && exec sleep 100
  file=$(grep -l wrong "$(dirname "$3")"/*.xml)
  [ -z "$file" ] && echo '{"ok": true, "problems": []}' && exit 0
  echo "{\"ok\": false, \"problems\": [{\"file\": \"$file\", \"line\": 2, \"text\": \"see $file:2\"}]}"
  exit 2;;
"view "*)
  echo "insula: viewer at http://127.0.0.1:8090/"; echo "$2" > "$here/viewed"
  [ -e "$here/unsettled" ] && echo "insula: the scene was saved; loading it" &&
    echo "insula: the saved scene has errors; the one before goes on" && echo "$2:3:1: error: it does not settle"
  while [ ! -e "$here/mended" ]; do sleep 0.02; done
  echo "insula: the scene was saved; loading it"; exec sleep 100;;
esac
)sh";

class StudioScenesTest : public ::testing::Test {
 protected:
  StudioScenesTest() {
    fs::permissions(folder_.write("bin/insula", scene_program), fs::perms::owner_all);
    folder_.write("bin/shipped/first.xml", shipped);
    folder_.write("bin/shipped/part.xml", "<part/>\n");
  }
  json get(const std::string& path, const std::string& query = {}) {
    return json::parse(scenes_.get(path, query).json);
  }
  ApiAnswer post(const std::string& path, json body) { return scenes_.post(path, body); }
  /// scene_write or scene_check of a page that shows the present text, unless `body` has another revision.
  ApiAnswer edit(const std::string& path, json body) {
    if (!body.contains("revision"))
      body["revision"] =
          get("scene_file", "name=" + body["name"].get<std::string>() + "&file=" + body["file"].get<std::string>())
              .value("revision", "none");
    return post(path, body);
  }
  /// The answer once `over` says so.
  template <class Over>
  json wait(const std::string& path, const std::string& query, Over over) {
    for (int k = 0; k < 1000; ++k) {
      scenes_.look();
      player_.look();
      if (json now = get(path, query); over(now)) return now;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    ADD_FAILURE() << path << " stays " << get(path, query);
    return get(path, query);
  }
  std::string source() {
    const json done = wait("scene_sources", "", [](const json& j) { return j["state"] == "done"; });
    return done["sources"][0]["scene"];
  }
  /// The name of a copy of the shipped scene.
  std::string opened() {
    const json begun = json::parse(post("scene_open", {{"source", source()}}).json);
    EXPECT_EQ(begun["state"], "copying");
    wait("scene", "name=" + begun["name"].get<std::string>(), [](const json& j) { return j["state"] == "ready"; });
    return begun["name"];
  }
  json checked(const std::string& name, const std::string& file, const std::string& text) {
    const json asked = json::parse(
        edit("scene_check", {{"name", name}, {"scene", "scenes/first.xml"}, {"file", file}, {"text", text}}).json);
    return wait("scene_checked", "name=" + name + "&file=" + file,
                [&](const json& j) { return j["state"] != "running" && j["number"] == asked["number"]; });
  }
  std::string on_disk(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  test_files::TempFolder folder_;
  fs::path data_ = folder_.path() / "data", program_ = folder_.path() / "bin/insula";
  StudioPlayer player_{program_, data_};
  StudioScenes scenes_{data_, program_, player_};
};

TEST_F(StudioScenesTest, AShippedSceneIsOpenedAsACopy) {
  const std::string name = opened();
  EXPECT_EQ(name, "first");
  EXPECT_EQ(opened(), "first_2");
  const json scene = get("scene", "name=first");
  EXPECT_EQ(scene["scenes"], json{"scenes/first.xml"});
  EXPECT_EQ(scene["files"], (json{"scenes/first.xml", "scenes/part.xml"})) << "no link that leads elsewhere";
  EXPECT_EQ(get("scene_file", "name=first&file=scenes/first.xml")["text"], shipped);
  EXPECT_EQ(get("scenes")["scenes"].size(), 2u);
}

TEST_F(StudioScenesTest, TheScenesOfABuiltCaseAreOpenedAsACopy) {
  EXPECT_EQ(json::parse(scenes_.open(folder_.path() / "bin/shipped", "tip").json)["name"], "tip");
  const json scene = wait("scene", "name=tip", [](const json& j) { return j["state"] == "ready"; });
  EXPECT_EQ(scene["files"].size(), 2u);
}

TEST_F(StudioScenesTest, OnlyScenesOfTheListAreCopied) {
  source();
  for (const fs::path& path : {program_, fs::path("/etc/passwd"), folder_.path() / "bin/shipped"})
    EXPECT_EQ(post("scene_open", {{"source", path.string()}}).status, 404) << path;
  folder_.write("bin/full", "");
  const json begun = json::parse(post("scene_open", {{"source", source()}}).json);
  const json failed = wait("scene", "name=first", [](const json& j) { return j["state"] != "copying"; });
  EXPECT_EQ(failed["state"], "failed");
  EXPECT_EQ(failed["error"], "error: the disk is full\n");
  EXPECT_EQ(post("scene_remove", {{"name", "first"}}).status, 200);
  EXPECT_EQ(scenes_.get("scene", "name=first").status, 404);
}

TEST_F(StudioScenesTest, WritingKeepsWhatWasThereAndLeavesTheShippedFile) {
  const std::string name = opened(), file = "scenes/first.xml";
  for (const char* text : {"<scene/>", "<scene a=\"ä\"/>\n", "<scene a=\"ä\"/>\n"})
    EXPECT_EQ(edit("scene_write", {{"name", name}, {"file", file}, {"text", text}}).status, 200);
  EXPECT_EQ(on_disk(data_ / "scenes/first/scenes/first.xml"), "<scene a=\"ä\"/>\n");
  EXPECT_EQ(on_disk(folder_.path() / "bin/shipped/first.xml"), shipped);
  const json now = get("scene_file", "name=first&file=scenes/first.xml");
  ASSERT_EQ(now["versions"].size(), 2u) << "the same text again is no version";
  EXPECT_EQ(now["versions"][0]["number"], 2);
  EXPECT_EQ(get("scene_version", "name=first&file=scenes/first.xml&number=1")["text"], shipped);
  EXPECT_EQ(get("scene_version", "name=first&file=scenes/first.xml&number=2")["text"], "<scene/>");
  EXPECT_EQ(scenes_.get("scene_version", "name=first&file=scenes/first.xml&number=3").status, 404);
  EXPECT_EQ(get("scene", "name=first")["files"].size(), 2u) << "versions are no files of the scene";
}

TEST_F(StudioScenesTest, OnlyTheXmlFilesOfACopyAreReadAndWritten) {
  const std::string name = opened();
  folder_.write("data/scenes/first/scenes/tool.urdf", "<robot/>");
  folder_.write("data/outside.xml", "<scene/>");
  for (const std::string file : {"../../outside.xml", "/etc/passwd", "scenes/link.xml", "scenes/tool.urdf", "",
                                 "scenes", "insula_case.json", "scenes/new.xml", "scenes/../scenes/first.xml"}) {
    EXPECT_EQ(scenes_.get("scene_file", "name=first&file=" + file).status, 404) << file;
    EXPECT_EQ(edit("scene_write", {{"name", name}, {"file", file}, {"text", "x"}}).status, 404) << file;
    EXPECT_EQ(
        edit("scene_check", {{"name", name}, {"scene", "scenes/first.xml"}, {"file", file}, {"text", "x"}}).status, 404)
        << file;
    EXPECT_EQ(post("scene_look", {{"name", name}, {"scene", file}}).status, 404) << file;
  }
  EXPECT_EQ(on_disk(data_ / "outside.xml"), "<scene/>");
}

TEST_F(StudioScenesTest, UnknownNamesAndLargeTextsAreRefused) {
  const std::string name = opened();
  for (const std::string other : {"", "..", "other", ".check", "../scenes/first"}) {
    EXPECT_EQ(scenes_.get("scene", "name=" + other).status, 404) << other;
    EXPECT_EQ(scenes_.get("scene_file", "file=scenes/first.xml&name=" + other).status, 404) << other;
    EXPECT_EQ(post("scene_remove", {{"name", other}}).status, 404) << other;
  }
  const std::string large(StudioScenes::most_text_bytes + 1, ' ');
  for (const char* what : {"scene_write", "scene_check"})
    EXPECT_EQ(edit(what, {{"name", name}, {"scene", "scenes/first.xml"}, {"file", "scenes/first.xml"}, {"text", large}})
                  .status,
              413);
  EXPECT_EQ(post("scene_format", {{"name", name}}).status, 404);
  EXPECT_EQ(scenes_.get("scene_format", "name=first").status, 404);
}

TEST_F(StudioScenesTest, ACheckTellsProblemsAndChangesNoFile) {
  const std::string name = opened();
  json done = checked(name, "scenes/part.xml", "<part>\nwrong</part>");
  EXPECT_EQ(done["ok"], false);
  EXPECT_EQ(done["problems"][0]["file"], "scenes/part.xml") << done;
  EXPECT_EQ(done["problems"][0]["text"], "see scenes/part.xml:2") << done;
  EXPECT_EQ(on_disk(data_ / "scenes/first/scenes/part.xml"), "<part/>\n");
  EXPECT_EQ(get("scene_file", "name=first&file=scenes/part.xml")["draft"], "<part>\nwrong</part>");
  done = checked(name, "scenes/part.xml", "<part>\n</part>");
  EXPECT_EQ(done["ok"], true);
  edit("scene_write", {{"name", name}, {"file", "scenes/part.xml"}, {"text", "<part>\n</part>"}});
  EXPECT_EQ(get("scene_file", "name=first&file=scenes/part.xml")["draft"], nullptr);
}

TEST_F(StudioScenesTest, ANewerCheckEndsTheOneBefore) {
  const std::string name = opened();
  folder_.write("bin/slow", "");
  edit("scene_check", {{"name", name}, {"scene", "scenes/first.xml"}, {"file", "scenes/first.xml"}, {"text", "wrong"}});
  const std::string query = "name=first&file=scenes/first.xml";
  EXPECT_EQ(get("scene_checked", query)["state"], "running");
  wait("scene_checked", query, [&](const json&) { return fs::exists(folder_.path() / "bin/sleeps"); });
  fs::remove(folder_.path() / "bin/slow");
  EXPECT_EQ(checked(name, "scenes/part.xml", "<part a=\"\"/>")["ok"], true);
  EXPECT_EQ(get("scene_checked", query)["state"], "running") << "a check of another file ends none";
  EXPECT_EQ(checked(name, "scenes/first.xml", "<scene/>")["ok"], true);
}

TEST_F(StudioScenesTest, WhatAnotherWindowChangedIsNotWrittenOver) {
  const std::string name = opened(), file = "scenes/first.xml", query = "name=first&file=" + file;
  const json seen = get("scene_file", query)["revision"];
  const auto by_another = [&](const char* path, const char* text) {
    return edit(path, {{"name", name}, {"scene", file}, {"file", file}, {"text", text}, {"revision", seen}}).status;
  };
  EXPECT_EQ(post("scene_write", {{"name", name}, {"file", file}, {"text", "<scene/>"}}).status, 428);
  json answer = json::parse(edit("scene_write", {{"name", name}, {"file", file}, {"text", "<scene/>"}}).json);
  EXPECT_EQ(answer["revision"], get("scene_file", query)["revision"]);
  for (const char* path : {"scene_write", "scene_check"}) EXPECT_EQ(by_another(path, "<scene b=\"\"/>"), 412);
  EXPECT_EQ(get("scene_file", query)["text"], "<scene/>");
  // A draft is a change too.
  answer = json::parse(edit("scene_check", {{"name", name}, {"scene", file}, {"file", file}, {"text", "wrong"}}).json);
  EXPECT_EQ(answer["revision"], get("scene_file", query)["revision"]);
  EXPECT_EQ(by_another("scene_check", "<scene b=\"\"/>"), 412);
  EXPECT_EQ(get("scene_file", query)["draft"], "wrong");
}

TEST_F(StudioScenesTest, ASceneIsLookedAtAndLeft) {
  const std::string name = opened();
  EXPECT_EQ(get("scene", "name=first")["look"], nullptr);
  EXPECT_EQ(post("scene_look", {{"name", name}, {"scene", "scenes/first.xml"}}).status, 200);
  const json now = wait("scene", "name=first", [](const json& j) { return j["look"]["state"] == "running"; });
  EXPECT_EQ(now["look"]["url"], "http://127.0.0.1:8090/");
  EXPECT_EQ(on_disk(folder_.path() / "bin/viewed"), (data_ / "scenes/first/scenes/first.xml").string() + "\n");
  post("scene_leave", {{"name", name}});
  EXPECT_EQ(get("scene", "name=first")["look"], nullptr);
}

TEST_F(StudioScenesTest, ASavedSceneThatCannotBeShownIsTold) {
  const std::string name = opened();
  folder_.write("bin/unsettled", "");
  post("scene_look", {{"name", name}, {"scene", "scenes/first.xml"}});
  const auto look = [](const json& j, const std::string& error) {
    return j["look"].is_object() && j["look"]["state"] == "running" && j["look"]["error"] == error;
  };
  wait("scene", "name=first",
       [&](const json& j) { return look(j, "scenes/first.xml:3:1: error: it does not settle\n"); });
  folder_.write("bin/mended", "");
  wait("scene", "name=first", [&](const json& j) { return look(j, ""); });
}

TEST_F(StudioScenesTest, ElementsAreAskedOnce) {
  const json done = wait("scene_elements", "", [](const json& j) { return j["state"] == "done"; });
  EXPECT_EQ(done["elements"][0]["name"], "scene");
}

TEST_F(StudioScenesTest, ASceneIsBegunFromNothing) {
  EXPECT_EQ(post("scene_new", {{"name", "../mine"}}).status, 400);
  EXPECT_EQ(post("scene_new", {{"name", ""}}).status, 400);
  EXPECT_EQ(post("scene_new", {{"name", "mine"}}).status, 200);
  const json made = wait("scene", "name=mine", [](const json& j) { return j["state"] == "ready"; });
  EXPECT_EQ(made["scenes"], json::array({"mine.xml"}));
  EXPECT_EQ(made["files"], json::array({"mine.xml"}));
  EXPECT_EQ(made["meshes"], json::array({"meshes/block.msh"}));
  EXPECT_EQ(get("scene_file", "name=mine&file=mine.xml")["text"], "<scene/>\n");
  EXPECT_EQ(post("scene_new", {{"name", "mine"}}).status, 409) << "it is there already";
}

}  // namespace
}  // namespace insula::gateway
