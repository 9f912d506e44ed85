// SPDX-License-Identifier: GPL-3.0-or-later
// The supervisor with small shell programs as children.
#include "engine/live/supervisor.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <thread>

#include "core/testing/temp_folder.h"

namespace fs = std::filesystem;

namespace insula {
namespace {

class SupervisorTest : public ::testing::Test {
 protected:
  SupervisorTest() {
    settings_.first_wait_s = 0.02;
    settings_.longest_wait_s = 0.08;
    settings_.patience_s = 0.3;
  }

  static ChildSpec shell(const std::string& name, const std::string& script) {
    ChildSpec spec;
    spec.name = name;
    spec.command = {"/bin/sh", "-c", script};
    return spec;
  }
  Supervisor make() {
    return Supervisor(settings_, [this](std::string_view line) { lines_.emplace_back(line); });
  }
  long count(std::string_view part) const {
    return std::count_if(lines_.begin(), lines_.end(),
                         [&](const auto& l) { return l.find(part) != std::string::npos; });
  }
  std::string file(const char* name) const { return (folder_ / name).string(); }
  static std::string content(const std::string& path) {
    std::ifstream in(path);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  test_files::TempFolder temporary_;
  fs::path folder_ = temporary_.path();
  SupervisorSettings settings_;
  std::vector<std::string> lines_;
};

TEST_F(SupervisorTest, BringsBackWhatDiesWithGrowingWaits) {
  Supervisor s = make();
  // The fifth life ends the session.
  ChildSpec child = shell(
      "worker", "echo life >> " + file("lives") + "; [ $(wc -l < " + file("lives") + ") -ge 5 ] && exit 0; exit 1");
  child.ends_session = true;
  s.add(std::move(child));
  EXPECT_EQ(s.run(), 0);
  EXPECT_EQ(count("worker started"), 5);
  EXPECT_EQ(count("ended with status 1, starting it again"), 4);
  EXPECT_EQ(content(file("lives")), "life\nlife\nlife\nlife\nlife\n");
}

TEST_F(SupervisorTest, AKilledChildComesBackAndTheOthersStay) {
  Supervisor s = make();
  s.add(shell("steady", "exec sleep 1000"));
  ChildSpec child = shell("fragile", "[ -e " + file("once") + " ] && exit 0; touch " + file("once") + "; kill -9 $$");
  child.ends_session = true;
  s.add(std::move(child));
  EXPECT_EQ(s.run(), 0);
  EXPECT_EQ(count("fragile was ended by signal 9"), 1);
  EXPECT_EQ(count("fragile started"), 2);
  EXPECT_EQ(count("steady started"), 1);
}

TEST_F(SupervisorTest, BadInputEndsEverything) {
  Supervisor s = make();
  s.add(shell("other", "exec sleep 1000"));
  s.add(shell("engine", "echo 'scene.xml:1:1: error: wrong' >&2; exit 2"));
  EXPECT_EQ(s.run(), 2);
  EXPECT_EQ(count("[engine] scene.xml:1:1: error: wrong"), 1);
  EXPECT_EQ(count("engine started"), 1);
}

TEST_F(SupervisorTest, AMissingProgramEndsEverything) {
  Supervisor s = make();
  ChildSpec spec;
  spec.name = "ghost";
  spec.command = {"/no/such/program"};
  s.add(std::move(spec));
  EXPECT_EQ(s.run(), 1);
  EXPECT_EQ(count("[ghost] cannot execute"), 1);
}

TEST_F(SupervisorTest, OneThatMayStayAwayDoesNotEndTheSession) {
  Supervisor s = make();
  ChildSpec refused = shell("sender", "exit 2"), missing = shell("ghost", ""), killed = shell("fragile", "kill -9 $$");
  missing.command = {"/no/such/program"};
  for (ChildSpec* spec : {&refused, &missing, &killed}) {
    spec->may_stay_away = true;
    s.add(*spec);
  }
  ChildSpec engine = shell("engine", "sleep 0.5");
  engine.ends_session = true;
  s.add(std::move(engine));
  EXPECT_EQ(s.run(), 0);
  EXPECT_EQ(count("sender ended with status 2; the session goes on without it"), 1);
  EXPECT_EQ(count("sender started"), 1);
  EXPECT_EQ(count("ghost started"), 1);
  EXPECT_GE(count("fragile started"), 2) << "one that was killed comes back";
}

TEST_F(SupervisorTest, LinesArePassedOnWhole) {
  Supervisor s = make();
  std::vector<std::string> seen;
  ChildSpec child = shell("talker", "printf 'one\\ntw'; sleep 0.05; printf 'o\\nlast'; echo hidden >&2");
  child.ends_session = true;
  child.on_line = [&](ChildSpec&, std::string_view line) {
    seen.emplace_back(line);
    return line != "two";
  };
  s.add(std::move(child));
  EXPECT_EQ(s.run(), 0);
  EXPECT_EQ(seen, (std::vector<std::string>{"one", "two", "lasthidden"}));
  EXPECT_EQ(count("[talker] one"), 1);
  EXPECT_EQ(count("[talker] two"), 0);
}

TEST_F(SupervisorTest, OneThatIgnoresTheTermSignalIsKilled) {
  settings_.duration_s = 0.2;
  Supervisor s = make();
  s.add(shell("stubborn", "trap '' TERM; while :; do sleep 0.05; done"));
  EXPECT_EQ(s.run(), 0);
  EXPECT_EQ(lines_.back(), "insula: ended");
}

bool gone(pid_t pid) {
  for (int i = 0; i < 1000; ++i) {
    if (::kill(pid, 0) != 0) return true;
    std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
    std::string text((std::istreambuf_iterator<char>(stat)), {});
    if (text.find(") Z ") != std::string::npos) return true;  // dead, waits for whoever inherited it
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return false;
}

pid_t supervisor_process(SupervisorSettings settings, const std::string& pid_file, pid_t& child) {
  const pid_t supervisor = fork();
  if (supervisor == 0) {
    Supervisor s(settings, [](std::string_view) {});
    ChildSpec spec;
    spec.name = "sleeper";
    spec.command = {"/bin/sh", "-c",
                    "echo $$ > " + pid_file + ".new; mv " + pid_file + ".new " + pid_file + "; exec sleep 1000"};
    s.add(std::move(spec));
    _exit(s.run());
  }
  for (int i = 0; i < 1000 && !fs::exists(pid_file); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  child = 0;
  std::ifstream(pid_file) >> child;
  return supervisor;
}

TEST_F(SupervisorTest, NothingIsLeftBehindWhenItIsKilled) {
  pid_t child = 0;
  const pid_t supervisor = supervisor_process(settings_, file("pid"), child);
  ASSERT_GT(child, 0);
  ASSERT_EQ(::kill(child, 0), 0);
  ::kill(supervisor, SIGKILL);
  ::waitpid(supervisor, nullptr, 0);
  EXPECT_TRUE(gone(child));
}

TEST_F(SupervisorTest, InterruptEndsAllAndGivesStatusZero) {
  for (int signal : {SIGINT, SIGTERM, SIGHUP}) {
    fs::remove(file("pid"));
    pid_t child = 0;
    const pid_t supervisor = supervisor_process(settings_, file("pid"), child);
    ASSERT_GT(child, 0);
    ::kill(supervisor, signal);
    int status = -1;
    ::waitpid(supervisor, &status, 0);
    EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << signal;
    EXPECT_TRUE(gone(child));
  }
}

TEST_F(SupervisorTest, AnOfferTakesOverWhenItIsReady) {
  Supervisor* running = nullptr;
  bool offered = false, taken = false;
  settings_.look = [&] {
    if (offered || !std::filesystem::exists(file("up"))) return;
    offered = true;
    Supervisor::Offer offer;
    // The old one must be gone before the new one is told to go.
    offer.command = {
        "/bin/sh", "-c",
        "trap 'cat " + file("old") + " > " + file("seen") + "; exit 0' USR1; echo ready; while :; do sleep 0.01; done"};
    offer.ready_line = "ready";
    offer.taken = [&] { taken = true; };
    running->offer("worker", std::move(offer));
  };
  settings_.look_s = 0.01;
  Supervisor s = make();
  running = &s;
  ChildSpec old = shell("worker", "trap 'sleep 0.1; echo gone > " + file("old") + "; exit 0' TERM; echo > " +
                                      file("up") + "; while :; do sleep 0.01; done");
  old.ends_session = true;
  s.add(std::move(old));
  EXPECT_EQ(s.run(), 0);
  EXPECT_TRUE(taken);
  EXPECT_EQ(count("worker taken over"), 1);
  EXPECT_EQ(content(file("seen")), "gone\n");
}

TEST_F(SupervisorTest, ARefusedOfferLeavesTheOldOneRunning) {
  settings_.duration_s = 1;
  settings_.look_s = 0.01;
  Supervisor* running = nullptr;
  bool offered = false;
  std::vector<std::string> said;
  ChildExit how;
  settings_.look = [&] {
    if (offered || count("[worker] up") == 0) return;
    offered = true;
    Supervisor::Offer offer;
    offer.command = {"/bin/sh", "-c", "echo 'a.xml:1:2: error: wrong'; exit 2"};
    offer.ready_line = "ready";
    offer.refused = [&](const auto& lines, const ChildExit& exit) {
      said = lines;
      how = exit;
    };
    running->offer("worker", std::move(offer));
  };
  Supervisor s = make();
  running = &s;
  s.add(shell("worker", "echo up; exec sleep 1000"));
  EXPECT_EQ(s.run(), 0);
  EXPECT_EQ(said, std::vector<std::string>{"a.xml:1:2: error: wrong"});
  EXPECT_EQ(how.status, 2);
  EXPECT_EQ(count("worker started"), 1);
}

TEST(WhyRefused, IsItsErrorsAndWarningsElseItsEnd) {
  EXPECT_EQ(
      why_refused({"a.xml:1:2: error: wrong", "no terror: none", "error: no motion", "b.xml:3:1: warning: odd"}, {}),
      "a.xml:1:2: error: wrong\nerror: no motion\nb.xml:3:1: warning: odd\n");
  EXPECT_EQ(why_refused({"loading"}, {.status = 3}), "the engine that loaded it ended with status 3\n");
}

TEST_F(SupervisorTest, OneThatWaitsForAnOfferDoesNotEndTheSession) {
  settings_.look_s = 0.01;
  Supervisor* running = nullptr;
  bool offered = false;
  settings_.look = [&] {
    if (offered || count("it waits for the next save") == 0) return;
    offered = true;
    Supervisor::Offer offer;
    offer.command = {"/bin/sh", "-c", "trap 'exit 0' USR1; echo ready; while :; do sleep 0.01; done"};
    offer.ready_line = "ready";
    running->offer("worker", std::move(offer));
  };
  Supervisor s = make();
  running = &s;
  ChildSpec child = shell("worker", "[ -e " + file("once") + " ] && exit 2; touch " + file("once") + "; exit 1");
  child.waits_for_offer = child.ends_session = true;
  s.add(std::move(child));
  EXPECT_EQ(s.run(), 0);
  EXPECT_TRUE(offered);
  EXPECT_EQ(count("worker taken over"), 1);
}

}  // namespace
}  // namespace insula
