// SPDX-License-Identifier: GPL-3.0-or-later
// The page of the case builder as its gateway keeps it: files that are refused, projects on the disk, undo, and work
// that ends well, badly, or with the program itself. A script stands for the case builder; the browser test uses the
// real one.
#include "viewer/gateway/studio.h"

#include <gtest/gtest.h>

#include "core/base/input_error.h"
#include "core/bus/mem_bus.h"
#include "viewer/gateway/client_for_test.h"
#include "viewer/gateway/gateway.h"
#include "viewer/gateway/scan_kind.h"
#include "viewer/gateway/studio_choices.h"
#include "viewer/gateway/studio_for_test.h"
#include "viewer/gateway/surface_kind.h"

namespace insula::gateway {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
using asio::ip::tcp;

TEST(SurfaceKind, IsToldByContentNotByName) {
  std::string stl(84 + 50, '\0');
  stl[80] = 1;
  EXPECT_EQ(surface_kind(stl).extension, ".stl");
  EXPECT_EQ(surface_kind("solid a\nfacet normal 0 0 1\n").extension, ".stl");
  EXPECT_EQ(surface_kind("ply\nformat ascii 1.0\n").extension, ".ply");
  EXPECT_EQ(surface_kind(off_file).extension, ".off");
  EXPECT_EQ(surface_kind("# made by hand\n\nv 0 0 0\n").extension, ".obj");
  EXPECT_EQ(surface_kind("<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\">").extension, ".vtp");
  EXPECT_EQ(surface_kind("<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\">").extension, ".vtu");
  EXPECT_EQ(surface_kind("\x89HDF\r\n\x1a\n and what follows").extension, ".h5");
  EXPECT_EQ(surface_kind("{\"asset\": {\"version\": \"2.0\"}}").extension, ".gltf");
}

TEST(SurfaceKind, OthersAreRefused) {
  for (const std::string& bytes :
       {std::string("\x89PNG\r\n\x1a\n"), std::string("#!/bin/sh\nrm -r x\n"), std::string("<html>"),
        std::string(84, '\0'), std::string("{\"a\": 1}"), std::string("glTF")})
    EXPECT_EQ(surface_kind(bytes).extension, "") << bytes;
  EXPECT_EQ(surface_kind("").refused, "this file is empty");
  EXPECT_NE(surface_kind("<VTKFile type=\"ImageData\">").refused.find("PolyData"), std::string::npos);
  const char* outside = R"({"asset": {}, "buffers": [{"uri": "../../etc/passwd"}]})";
  EXPECT_NE(surface_kind(outside).refused.find("other files"), std::string::npos);
}

TEST(StudioChoices, AreOptionsOfTheCommand) {
  using Words = std::vector<std::string>;
  json c = first_choices();
  EXPECT_EQ(case_words(c), Words{});
  c = changed_choices(c, {{"unit", "cm"}, {"neck", {{"points", {1, 2, 3, 4, 5, 6}}}}, {"rehearse", false}});
  EXPECT_EQ(case_words(c),
            (Words{"--unit", "cm", "--neck-points", "1.000 2.000 3.000 mm 4.000 5.000 6.000 mm", "--no-rehearse"}));
  EXPECT_EQ(intake_words(c), (Words{"--unit", "cm"}));
  c = changed_choices(c, {{"neck", {{"plane", {1, 2, 3, 0, 0, 1}}}}});
  EXPECT_EQ(case_words(c)[3], "1.000 2.000 3.000 mm 0.0000 0.0000 1.0000");
}

TEST(StudioChoices, ChangesOfWallsAndRulesBecomeOptions) {
  const json c = changed_choices(first_choices(),
                                 {{"rules", {"3.clip.max_grade=1", "4.chance=off"}}, {"walls", {"neck.young=7 MPa"}}});
  EXPECT_EQ(case_words(c), (std::vector<std::string>{"--wall", "neck.young=7 MPa", "--rule", "3.clip.max_grade=1",
                                                     "--rule", "4.chance=off"}));
  for (const char* wrong : {"neck", "neck.young", ".young=7 MPa", "neck.young=7\nMPa"})
    EXPECT_THROW(changed_choices(first_choices(), {{"walls", {wrong}}}), InputError) << wrong;
}

TEST(StudioChoices, PaintedPartsAndThePlaceBecomeOptions) {
  const json part = {{"points", {{1, 2, 3}, {4, 5, 6}}}, {"radius_mm", 1.2}, {"thickness", ""}, {"young", "7 MPa"}};
  json c = changed_choices(first_choices(), {{"wall_patches", {part}}, {"pose", {1, 2, 3, 0, 0, 90}}});
  EXPECT_EQ(case_words(c), (std::vector<std::string>{
                               "--wall-patch", "1.000 2.000 3.000 mm, 4.000 5.000 6.000 mm, radius=1.2 mm, young=7 MPa",
                               "--pose", "1.000 2.000 3.000 mm 0.000 0.000 90.000 deg"}));
  EXPECT_EQ(intake_words(c), std::vector<std::string>()) << "the file is not read again";
  json wrong = part;
  wrong["young"] = "7 MPa, radius=9 mm";
  EXPECT_THROW(changed_choices(c, {{"wall_patches", {wrong}}}), InputError);
  wrong = part, wrong["points"] = json::array();
  EXPECT_THROW(changed_choices(c, {{"wall_patches", {wrong}}}), InputError);
  wrong = part, wrong["radius_mm"] = 0;
  EXPECT_THROW(changed_choices(c, {{"wall_patches", {wrong}}}), InputError);
  EXPECT_THROW(changed_choices(c, {{"wall_patches", json::array_t(21, part)}}), InputError);
  EXPECT_THROW(changed_choices(c, {{"pose", {1, 2, 3}}}), InputError);
}

TEST(StudioChoices, RetractorsBecomeOptions) {
  using Words = std::vector<std::string>;
  const json one = {{"lobe", "frontal"},
                    {"tip_mm", {53.5, 15, 0}},
                    {"shaft", {0.8, 0.2, 0.5}},
                    {"flat", {0, 0, 1}},
                    {"pull_mm", 5.5}};
  const auto words = [](const json& retractors) {
    return case_words(changed_choices(first_choices(), {{"retractors", retractors}}));
  };
  const std::string option =
      "frontal, 53.500 15.000 0.000 mm, shaft=0.8000 0.2000 0.5000, flat=0.0000 0.0000 1.0000, pull=5.5 mm";
  EXPECT_EQ(words(json::array({one, one})), (Words{"--retractor", option, "--retractor", option}));
  EXPECT_EQ(words(json::array()), Words{"--no-retractors"});
  EXPECT_EQ(words(nullptr), Words()) << "those of the approach";
  EXPECT_THROW(words(json::array_t(5, one)), InputError);
  const std::pair<const char*, json> wrong[] = {{"lobe", ""},       {"lobe", "frontal, pull=9 mm"},
                                                {"tip_mm", {1, 2}}, {"shaft", {0, 0, 0}},
                                                {"flat", "up"},     {"pull_mm", 16},
                                                {"pull_mm", -1},    {"width_mm", 3}};
  for (const auto& [name, value] : wrong) {
    json bad = one;
    bad[name] = value;
    EXPECT_THROW(words(json::array({bad})), InputError) << name << " " << value;
  }
  json bad = one;
  bad.erase("flat");
  EXPECT_THROW(words(json::array({bad})), InputError);
}

TEST_F(StudioTest, APlaceOfABuiltCaseIsLookedAt) {
  const std::string name = ready();
  EXPECT_EQ(studio_->get("pose", "name=" + name).status, 409) << "it is not built";
  ask("build", name);
  wait(name, "build");
  EXPECT_EQ(studio_->get("pose", "name=" + name + "&pose=1,2,3").status, 400);
  EXPECT_EQ(studio_->get("pose", "name=" + name + "&pose=1,2,3,4,5,nan").status, 400);
  const auto asked = [&](const std::string& query) {
    return json::parse(studio_->get("pose", "name=" + name + query).json);
  };
  const auto told = [&] {
    for (int k = 0; k < 500; ++k) {
      studio_->look();
      const json now = asked("");
      if (now["state"] != "starting" && now["busy"] == false) return now;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return json();
  };
  json now = asked("&pose=1,2,3,0,0,90");
  EXPECT_EQ(now["state"], "starting");
  EXPECT_EQ(now["busy"], true);
  now = told();
  EXPECT_EQ(now["state"], "ready") << now;
  EXPECT_EQ(now["facts"]["surfaces"], json::array({"vessel"}));
  EXPECT_EQ(now["answer"]["told"], "1.000 2.000 3.000 mm 0.000 0.000 90.000 deg");
  EXPECT_TRUE(studio_->file("pose_surface", "name=" + name + "&part=vessel"));
  EXPECT_FALSE(studio_->file("pose_surface", "name=" + name + "&part=../vessel"));
  asked("&pose=0,0,0,0,0,0&parted=1");
  EXPECT_EQ(told()["answer"]["told"], "part 0.000 0.000 0.000 mm 0.000 0.000 0.000 deg");
}

TEST(StudioPoses, AProgramThatNobodyAsksEndsAndAFailureIsTold) {
  test_files::TempFolder folder;
  const fs::path program = folder.write("insula_case", "#!/bin/sh\necho '{}'\nexec cat\n");
  fs::permissions(program, fs::perms::owner_all);
  StudioPoses poses(program, std::chrono::milliseconds(50));
  EXPECT_NE(poses.ask("built", "surfaces", std::nullopt)["state"], "failed");
  EXPECT_GT(poses.pid(), 0);
  std::this_thread::sleep_for(std::chrono::milliseconds(80));
  poses.look();
  EXPECT_LE(poses.pid(), 0);
  StudioPoses wrong(folder.path() / "none");
  json last;
  for (int k = 0; k < 500 && (last.is_null() || last["state"] == "starting"); ++k) {
    last = wrong.ask("built", "surfaces", std::nullopt);
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_EQ(last["state"], "failed");
  EXPECT_NE(last["error"].get<std::string>().find("127"), std::string::npos) << last;
}

TEST_F(StudioTest, AClipIsTriedOverTheNeckOfABuiltCase) {
  const std::string name = ready();
  EXPECT_EQ(ask("try", name).status, 409) << "it is not built";
  ask("build", name);
  wait(name, "build");
  ask("choose", name, {{"choices", {{"clip", "angled_30_10"}, {"lift_mm", -0.5}}}});
  EXPECT_EQ(ask("try", name).status, 200);
  const json tried = wait(name, "trial")["trial"];
  EXPECT_EQ(tried["state"], "done") << tried;
  EXPECT_EQ(tried["found"]["grade"], 1);
  EXPECT_EQ(tried["current"], true);
  std::ifstream asked(folder_.path() / "bin/asked");
  const std::string all(std::istreambuf_iterator<char>(asked), {});
  EXPECT_NE(all.find("--clip angled_30_10 --lift -0.5 mm"), std::string::npos) << all;
  ask("choose", name, {{"choices", {{"turn_deg", 15}}}});
  EXPECT_EQ(project(name)["trial"]["current"], false);
  EXPECT_EQ(ask("choose", name, {{"choices", {{"clip", "../x"}}}}).status, 400);
}

TEST(StudioChoices, WrongOnesAreRefused) {
  const json wrong[] = {{{"unit", "--brain"}},
                        {{"neck", {{"plane", {0, 0, 0, 0, 0, 0}}}}},
                        {{"neck", "top"}},
                        {{"vertices", 1e9}},
                        {{"out", "/tmp"}},
                        {{"mirror", 1}},
                        {{"inlet", {1, 2}}},
                        {{"cuts", {{1, 2, 3}}}},
                        {{"rules", "3.clip=off"}},
                        {{"rules", json::array({"--out=/tmp"})}},
                        {{"rules", json::array({"3.clip=off\n--out"})}},
                        json(3)};
  for (const json& changes : wrong)
    EXPECT_THROW(changed_choices(first_choices(), changes), InputError) << changes.dump();
}

TEST_F(StudioTest, AFileKeepsItsBytesAndGetsASafeName) {
  EXPECT_EQ(upload("..%2F..%2Fetc%2Fp%20q.sh")["name"], "p_q");
  EXPECT_EQ(upload("%2E%2E")["name"], "case");
  EXPECT_EQ(upload("vessel.off")["name"], "vessel");
  EXPECT_EQ(upload("vessel.exe")["name"], "vessel_2");
  std::ifstream in(folder_.path() / "data/studio/vessel_2/input.off");
  EXPECT_EQ(std::string(std::istreambuf_iterator<char>(in), {}), off_file);
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_.path()), fs::directory_iterator()), 2) << "bin and data";
}

TEST_F(StudioTest, AWrongFileMakesNoProject) {
  EXPECT_EQ(sent("a.stl", "\x89PNG").status, 415);
  EXPECT_EQ(json::parse(studio_->get("projects", "").json)["projects"], json::array());
}

TEST_F(StudioTest, ACancelledUploadLeavesNoProjectWhetherItArrivesBeforeOrAfter) {
  const auto projects = [&] { return json::parse(studio_->get("projects", "").json)["projects"].size(); };
  const auto discard = [&](const std::string& upload) {
    return studio_->post("discard", json{{"upload", upload}}.dump()).status;
  };
  upload("first.off&upload=a1");
  upload("second.off&upload=b2");
  ASSERT_EQ(projects(), 2u);
  EXPECT_EQ(discard("a1"), 200);
  ASSERT_EQ(projects(), 1u) << "its bytes had all arrived";
  EXPECT_EQ(project("second")["name"], "second");
  EXPECT_FALSE(fs::exists(folder_.path() / "data/studio/first"));
  EXPECT_EQ(discard("c3"), 200);
  EXPECT_EQ(sent("third.off&upload=c3", off_file).status, 409) << "its bytes arrive later";
  EXPECT_EQ(sent("fourth.off&upload=d4", off_file).status, 200);
  EXPECT_EQ(projects(), 2u);
  EXPECT_EQ(discard("../second"), 400);
  EXPECT_EQ(wait("second", "inspect")["inspect"]["state"], "done");
}

TEST_F(StudioTest, UnknownProjectsAndPathsAreRefused) {
  upload();
  for (const std::string name : {"other", "", "..", "../studio/vessel", "vessel/../vessel"}) {
    EXPECT_EQ(studio_->get("project", "name=" + name).status, 404) << name;
    EXPECT_EQ(ask("build", name).status, 404) << name;
    EXPECT_FALSE(studio_->file("surface", "name=" + name)) << name;
  }
  EXPECT_EQ(studio_->post("build", "[]").status, 400);
  EXPECT_EQ(ask("format", "vessel").status, 404);
  EXPECT_EQ(ask("play", "vessel", {{"exercise", "../../x.xml"}}).status, 404);
}

TEST_F(StudioTest, ChoicesAreKeptAndTakenBack) {
  const std::string name = ready();
  EXPECT_EQ(ask("choose", name, {{"choices", {{"difficulty", 3}}}}).status, 200);
  EXPECT_EQ(ask("choose", name, {{"choices", {{"difficulty", 9}}}}).status, 400);
  ask("choose", name, {{"choices", {{"difficulty", 4}}}});
  ask("undo", name);
  restart();
  json now = project(name);
  EXPECT_EQ(now["choices"]["difficulty"], 3);
  EXPECT_TRUE(now["undo"] && now["redo"]);
  ask("redo", name);
  EXPECT_EQ(project(name)["choices"]["difficulty"], 4);
  ask("undo", name), ask("undo", name), ask("undo", name);
  EXPECT_EQ(project(name)["choices"]["difficulty"], 0);
  ask("choose", name, {{"choices", {{"site", "basilar tip"}}}});
  EXPECT_FALSE(project(name)["redo"]) << "another way was taken";
}

TEST_F(StudioTest, AChangeOfWhatAnotherWindowHasChangedIsRefused) {
  const std::string name = ready();
  const json one = project(name), other = project(name);
  const auto change = [&](const json& seen, const char* what, int value) {
    return ask("choose", name, {{"revision", seen["revision"]}, {"choices", {{what, value}}}});
  };
  EXPECT_EQ(change(one, "difficulty", 3).status, 200);
  const json after = project(name);
  for (const char* act : {"undo", "redo", "build", "try"})
    EXPECT_EQ(ask(act, name, {{"revision", other["revision"]}}).status, 412) << act;
  const ApiAnswer refused = change(other, "difficulty", 5);
  EXPECT_EQ(refused.status, 412);
  EXPECT_NE(refused.json.find("changed in another window"), std::string::npos) << refused.json;
  EXPECT_EQ(change(other, "plays", 5).status, 412) << "another choice is refused too";
  EXPECT_EQ(project(name), after) << "nothing has changed";
  EXPECT_EQ(change(after, "plays", 5).status, 200);
  EXPECT_EQ(project(name)["choices"]["difficulty"], 3);
  EXPECT_EQ(project(name)["choices"]["plays"], 5);
  EXPECT_EQ(studio_->post("undo", json{{"name", name}}.dump()).status, 428) << "of whoever does not say what he saw";
}

TEST_F(StudioTest, EachChangeOfChoicesIsARevisionAndNothingElseIs) {
  const std::string name = ready();
  const std::int64_t first = revision(name);
  ask("choose", name, {{"choices", {{"difficulty", 3}}}});
  EXPECT_EQ(revision(name), first + 1);
  ask("choose", name, {{"choices", {{"difficulty", 3}}}});
  EXPECT_EQ(revision(name), first + 1) << "the same again is no change";
  ask("undo", name);
  EXPECT_EQ(revision(name), first + 2) << "a page that has not seen the undo is refused";
  ask("undo", name);
  EXPECT_EQ(revision(name), first + 2) << "there was nothing to undo";
  ask("redo", name);
  restart();
  EXPECT_EQ(project(name)["revision"], first + 3);
  ask("build", name);
  wait(name, "build");
  EXPECT_EQ(revision(name), first + 3);
  ask("remove", name);
  EXPECT_NE(revision(ready()), first) << "a new project of the same name is another one";
}

TEST_F(StudioTest, AnotherUnitReadsTheFileAgain) {
  const std::string name = ready();
  const json now = json::parse(ask("choose", name, {{"choices", {{"unit", "cm"}}}}).json);
  EXPECT_EQ(now["inspect"]["state"], "running");
  EXPECT_EQ(wait(name, "inspect")["inspect"]["number"], 2);
  std::ifstream asked(folder_.path() / "bin/asked");
  const std::string all(std::istreambuf_iterator<char>(asked), {});
  EXPECT_NE(all.find("--unit cm"), std::string::npos) << all;
}

TEST_F(StudioTest, ACaseIsBuilt) {
  const std::string name = ready();
  EXPECT_EQ(ask("build", name).status, 200);
  json now = wait(name, "build");
  EXPECT_EQ(now["build"]["state"], "done") << now;
  EXPECT_EQ(now["built"]["exercises"], json{"3_clipping.xml"});
  EXPECT_EQ(now["built"]["current"], true);
  ask("choose", name, {{"choices", {{"difficulty", 2}}}});
  EXPECT_EQ(project(name)["built"]["current"], false);
}

TEST_F(StudioTest, OnlyABuiltCaseHasScenesToBeEdited) {
  const std::string name = ready();
  EXPECT_EQ(ask("edit", name).status, 409);
  ask("build", name);
  wait(name, "build");
  const json copy = json::parse(ask("edit", name).json);
  EXPECT_EQ(copy["name"], name);
  EXPECT_EQ(ask("scene_write", name, {{"file", "3_clipping.xml"}, {"text", ""}}).status, 404) << "it is no copy yet";
}

TEST_F(StudioTest, OnlyOneCaseIsBuiltAtATime) {
  const std::string one = ready("one.off"), two = ready("two.off");
  behave("hang");
  EXPECT_EQ(ask("build", one).status, 200);
  EXPECT_EQ(ask("build", one).status, 409);
  const ApiAnswer other = ask("build", two);
  EXPECT_EQ(other.status, 409);
  EXPECT_NE(other.json.find("one"), std::string::npos) << "it says which";
  EXPECT_EQ(ask("remove", one).status, 409);
  EXPECT_EQ(ask("choose", one, {{"choices", {{"unit", "cm"}}}}).status, 409);
  ask("cancel", one);
  EXPECT_EQ(wait(one, "build")["build"]["state"], "cancelled");
  behave("");
  ask("build", two);
  EXPECT_EQ(wait(two, "build")["build"]["state"], "done");
}

TEST_F(StudioTest, ARefusalAndACrashOfTheBuilderLoseNothing) {
  const std::string name = ready();
  ask("build", name);
  ASSERT_EQ(wait(name, "build")["build"]["state"], "done");
  behave("refuse");
  ask("build", name);
  json now = wait(name, "build");
  EXPECT_EQ(now["build"]["state"], "failed");
  EXPECT_EQ(now["build"]["error"], "no sac was found");
  behave("crash");
  ask("build", name);
  now = wait(name, "build");
  EXPECT_EQ(now["build"]["state"], "failed");
  EXPECT_NE(now["build"]["error"].get<std::string>().find("signal 11"), std::string::npos) << now["build"];
  EXPECT_EQ(now["built"]["exercises"], json{"3_clipping.xml"}) << "the case that was built before";
  behave("");
  ask("build", name);
  EXPECT_EQ(wait(name, "build")["build"]["state"], "done");
}

TEST_F(StudioTest, ACrashOfTheGatewayLosesNothing) {
  const std::string name = ready();
  ask("choose", name, {{"choices", {{"difficulty", 5}}}});
  behave("hang");
  ask("build", name);
  restart();
  json now = project(name);
  EXPECT_EQ(now["build"]["state"], "interrupted");
  EXPECT_EQ(now["choices"]["difficulty"], 5);
  EXPECT_EQ(now["inspect"]["state"], "done");
  behave("");
  ask("build", name);
  EXPECT_EQ(wait(name, "build")["build"]["state"], "done");
}

/// Over HTTP.
class StudioPages : public StudioTest {
 protected:
  StudioPages() {
    Options options;
    options.port = 0;
    options.listen = "0.0.0.0";
    options.discovery = false;
    options.studio = {folder_.path() / "data", folder_.path() / "bin"};
    options.is_here = [](const auto& remote, const auto&) { return remote.to_string() == "127.0.0.1"; };
    gateway_.emplace(bus_, options);
    EXPECT_EQ(gateway_->start(), "");
  }
  pages::Response put(const std::string& from, std::string body, pages::Fields fields = {}) {
    return pages::ask(from, gateway_->port(),
                      {http::verb::put, "/api/studio/upload?file=a.off", std::move(fields), std::move(body)});
  }
  MemBus bus_;
  std::optional<Gateway> gateway_;
};

TEST_F(StudioPages, AreOnlyForThisMachine) {
  const auto get = [&](const std::string& from) {
    return pages::ask(from, gateway_->port(), {http::verb::get, "/api/studio/projects"}).result_int();
  };
  EXPECT_EQ(get("127.0.0.1"), 200u);
  EXPECT_EQ(get("127.0.0.2"), 403u);
  EXPECT_EQ(put("127.0.0.2", off_file).result_int(), 403u);
  EXPECT_EQ(put("127.0.0.1", off_file, {{"Origin", "http://example.org"}}).result_int(), 403u);
  EXPECT_EQ(put("127.0.0.1", off_file).result_int(), 200u);
}

TEST_F(StudioPages, TakeLargeFilesUpToALimit) {
  std::string large = off_file;
  large.append(3'000'000, '\n');  // far more than any other request may have
  EXPECT_EQ(put("127.0.0.1", large).result_int(), 200u);
  // The head alone is enough to be refused.
  asio::io_context io;
  tcp::socket socket(io);
  pages::connect(socket, "127.0.0.1", gateway_->port());
  const std::string head = "PUT /api/studio/upload?file=a.off HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Length: " +
                           std::to_string(most_scan_bytes + 1) + "\r\n\r\n";
  asio::write(socket, asio::buffer(head));
  beast::flat_buffer buffer;
  pages::Response answer;
  http::read(socket, buffer, answer);
  EXPECT_EQ(answer.result_int(), 413u);
}

}  // namespace
}  // namespace insula::gateway
