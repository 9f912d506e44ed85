// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/store/store.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <csignal>
#include <fstream>
#include <set>
#include <thread>

#include "training/store/records_for_test.h"
#include "training/store/schema.h"

namespace insula::training {
namespace {

namespace fs = std::filesystem;

class TrainingStore : public testing::Test {
 protected:
  fs::path file() const { return folder_.path() / "data/training.sqlite"; }

  test_files::TempFolder folder_;
};

using Record = training::Run;  // a test has a member of that name

constexpr auto run = run_for_test;

TEST_F(TrainingStore, KeepsPersonsAndRefusesWrongOnes) {
  Store store(file());
  const Person added = store.add(Person{0, "P07", "resident", "left", 3, 0});
  EXPECT_GT(added.id, 0);
  EXPECT_GT(added.created_ms, 1'600'000'000'000);
  store.add(Person{0, "Ünal", "fellow", "right", 0, 0});
  EXPECT_EQ(message_of([&] {
              store.add(Person{0, "p07", "other", "right", 0, 0});
            }),
            "the pseudonym \"p07\" is in use");
  EXPECT_NE(message_of([&] { store.add(Person{0, " P08", "other", "right", 0, 0}); }).find("blank"), std::string::npos);
  EXPECT_NE(message_of([&] {
              store.add(Person{0, "P\n8", "other", "right", 0, 0});
            }).find("control"),
            std::string::npos);
  EXPECT_NE(message_of([&] { store.add(Person{0, "\xff", "other", "right", 0, 0}); }).find("UTF-8"), std::string::npos);
  EXPECT_NE(message_of([&] {
              store.add(Person{0, std::string(41, 'x'), "other", "right", 0, 0});
            }).find("40"),
            std::string::npos);
  EXPECT_NE(message_of([&] {
              store.add(Person{0, "P08", "boss", "right", 0, 0});
            }).find("resident"),
            std::string::npos);
  EXPECT_NE(message_of([&] { store.add(Person{0, "P08", "other", "right", 99, 0}); }).find("99"), std::string::npos);
  Store again(file());
  ASSERT_EQ(again.persons().size(), 2u);
  EXPECT_EQ(again.find("P07")->year, 3);
  EXPECT_EQ(again.find("P07")->handedness, "left");
  EXPECT_EQ(again.persons()[1].pseudonym, "Ünal");
}

TEST_F(TrainingStore, GivesARunBackAsItWas) {
  Store store(file());
  Record r = run("P07", "scenes/training/3_clipping.xml", 1'700'000'000'123);
  r.fault_counts = {{"stenosis", "The clip narrows a branch", 2}};
  r.seed = 11, r.guided = true, r.version = "0.9";
  r.faults = 2, r.state = "failed", r.goals_done = 1, r.step_rate_hz = 120, r.report = "/r.html", r.recording = "/s";
  r.metrics.push_back({"unknown", "left", NAN, "", "", "none", 0});
  EXPECT_TRUE(store.add(r));
  EXPECT_FALSE(store.add(r)) << "the same run twice";
  const auto back = store.run(r.uuid);
  ASSERT_TRUE(back);
  EXPECT_EQ(back->person, "P07");  // who was not known is added
  EXPECT_EQ(back->began_ms, r.began_ms);
  EXPECT_EQ(back->state, "failed");
  EXPECT_EQ(back->goals_done, 1);
  EXPECT_EQ(back->step_rate_hz, 120);
  EXPECT_EQ(back->recording, "/s");
  EXPECT_EQ(back->seed, 11);
  EXPECT_TRUE(back->guided);
  EXPECT_EQ(back->version, "0.9");
  ASSERT_EQ(back->metrics.size(), 2u) << "a value that is not known is no value";
  EXPECT_EQ(back->metrics[0].id, "path_length");
  EXPECT_EQ(back->metrics[0].value, 70.5);
  EXPECT_EQ(back->metrics[0].unit, "mm");
  ASSERT_EQ(back->fault_counts.size(), 1u);
  EXPECT_EQ(back->fault_counts[0].count, 2);
  EXPECT_FALSE(store.run("nothing"));
}

TEST_F(TrainingStore, TellsLastAndBestOfEachExerciseAndCurvesOverTime) {
  Store store(file());
  const auto add = [&](std::int64_t at, const char* state, int faults, double seconds, const char* mode, double path) {
    Record r = run("P07", "a.xml", at);
    r.state = state, r.faults = faults, r.duration_s = seconds, r.mode = mode, r.metrics[0].value = path;
    store.add(r);
    return r.uuid;
  };
  add(2, "failed", 0, 5, "practice", 20);
  const std::string best = add(1, "done", 1, 50, "practice", 10);
  add(3, "done", 1, 60, "test", 30);
  const std::string last = add(5, "done", 2, 10, "test", 50);
  add(9, "done", 0, 1, "demonstration", 90);
  store.add(run("P07", "b.xml", 4));
  store.add(run("", "a.xml", 6));
  const auto history = store.history("p07");
  ASSERT_EQ(history.size(), 2u);
  EXPECT_EQ(history[0].scene, "a.xml");
  EXPECT_EQ(history[0].runs, 4);
  EXPECT_EQ(history[0].last->uuid, last);
  EXPECT_EQ(history[0].best->uuid, best);
  EXPECT_EQ(history[1].title, "Title of b.xml");
  const auto curves = store.curves("P07", "a.xml");
  ASSERT_EQ(curves.size(), 2u);
  EXPECT_EQ(curves[0].metric.id, "path_length");
  std::vector<double> values;
  for (const auto& p : curves[0].points) values.push_back(p.value);
  EXPECT_EQ(values, (std::vector<double>{10, 20, 30, 50}));
  EXPECT_EQ(store.history("").size(), 1u) << "guests have their own";
  EXPECT_TRUE(store.history("nobody").empty()) << "and it is not that of somebody who is not there";
  EXPECT_TRUE(store.runs("nobody").empty());
  EXPECT_EQ(store.runs("P07", 2).size(), 2u);
  EXPECT_EQ(store.runs("P07")[0].began_ms, 9);
}

bool anywhere(const fs::path& folder, const std::string& text) {
  for (const auto& f : fs::recursive_directory_iterator(folder)) {
    if (!f.is_regular_file()) continue;
    std::ifstream in(f.path(), std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(in), {}};
    if (bytes.find(text) != std::string::npos) return true;
  }
  return false;
}

TEST_F(TrainingStore, ForgetsAPersonDownToTheLastByte) {
  Store store(file());
  store.add(Person{0, "Pseudonym-of-one", "other", "right", 0, 0});
  Record r = run("Pseudonym-of-one", "a.xml", 1);
  r.report = "/report/of/that/one.html";
  store.add(r);
  store.add(run("other", "a.xml", 2));
  EXPECT_TRUE(anywhere(folder_.path(), "Pseudonym-of-one"));
  EXPECT_TRUE(store.forget("pseudonym-of-one"));
  EXPECT_FALSE(store.forget("pseudonym-of-one"));
  EXPECT_FALSE(store.run(r.uuid));
  EXPECT_FALSE(anywhere(folder_.path(), "Pseudonym-of-one"));
  EXPECT_FALSE(anywhere(folder_.path(), "/report/of/that/one.html"));
  EXPECT_EQ(store.history("other").size(), 1u);
}

TEST_F(TrainingStore, NothingThatWasAddedIsLostWhenTheProcessIsKilled) {
  int told[2];
  ASSERT_EQ(pipe(told), 0);
  const pid_t child = fork();
  if (child == 0) {
    try {
      Store store(file());
      for (std::int64_t k = 0;; ++k) {
        store.add(run("P07", "a.xml", k));
        if (write(told[1], &k, sizeof k) != sizeof k) _exit(1);
      }
    } catch (...) {
    }
    _exit(1);
  }
  std::int64_t last = -1;
  while (last < 40) ASSERT_EQ(read(told[0], &last, sizeof last), ssize_t(sizeof last));
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  close(told[1]);
  for (std::int64_t k; read(told[0], &k, sizeof k) == ssize_t(sizeof k);) last = k;
  close(told[0]);
  Store store(file());
  const auto runs = store.runs("P07", 100'000);
  ASSERT_GE(std::int64_t(runs.size()), last + 1);
  for (const Record& r : runs) EXPECT_EQ(store.run(r.uuid)->metrics.size(), 2u) << "a run is whole or not there";
}

TEST_F(TrainingStore, TwoWritersAndTwoReadersDoNotDisturbEachOther) {
  Store first(file()), second(file()), reader(file());
  constexpr int each = 60;
  const auto write = [](Store& store, const char* person) {
    for (int k = 0; k < each; ++k) store.add(run(person, "a.xml", k));
  };
  std::thread one(write, std::ref(first), "A"), two(write, std::ref(second), "B");
  const auto read_all = [](const Store& store) {
    std::size_t seen = 0;
    while (seen < 2 * each) {
      const auto a = store.full_runs("A"), b = store.full_runs("B");
      for (const Record& r : a) EXPECT_EQ(r.metrics.size(), 2u) << "a page never sees half a run";
      EXPECT_GE(a.size() + b.size(), seen) << "what was there stays there";
      seen = a.size() + b.size();
    }
    EXPECT_EQ(seen, std::size_t(2 * each));
  };
  std::thread other_page([&] { read_all(Store(file())); });
  read_all(reader);
  one.join(), two.join(), other_page.join();
}

TEST_F(TrainingStore, ABackupIsWholeWhileTheStoreIsInUse) {
  Store store(file());
  store.add(run("P07", "a.xml", 1));
  const fs::path copy = folder_.path() / "copy.sqlite";
  for (int k = 0; k < 2; ++k) store.back_up(copy);  // an older copy is replaced
  store.add(run("P07", "a.xml", 2));
  EXPECT_EQ(Store(copy).runs("P07").size(), 1u);
  EXPECT_EQ(store.runs("P07").size(), 2u);
}

TEST_F(TrainingStore, KnowsTheCurriculumThatAPersonFollows) {
  Store store(file());
  Person person;
  person.pseudonym = "P07";
  store.add(person);
  EXPECT_EQ(store.followed("P07"), "");
  store.follow("P07", "first_day");
  store.follow("p07", "residency_year");
  EXPECT_EQ(store.followed("P07"), "residency_year");
  store.follow("P07", "");
  EXPECT_EQ(store.followed("P07"), "");
  EXPECT_THROW(store.follow("P08", "first_day"), InputError);
  store.follow("P07", "first_day");
  store.forget("P07");
  store.add(person);
  EXPECT_EQ(store.followed("P07"), "") << "it was forgotten with the person";
}

TEST_F(TrainingStore, AFileOfTheFirstSchemaBecomesAPresentOne) {
  {
    Store store(file());
    store.add(run("P07", "a.xml", 1));
    Database database(file());
    database.run("DROP TABLE followed_curricula; PRAGMA user_version=2");
  }
  Store store(file());
  EXPECT_EQ(store.runs("P07").size(), 1u);
  store.follow("P07", "first_day");
  EXPECT_EQ(store.followed("P07"), "first_day");
  EXPECT_TRUE(fs::exists(file().string() + ".before_" + std::to_string(schema_version())));
}

TEST_F(TrainingStore, RefusesAFileOfANewerVersionAndWhatIsNoDatabase) {
  { Store store(file()); }
  {
    Database database(file());
    database.run("PRAGMA user_version=99");
  }
  EXPECT_NE(message_of([&] { Store store(file()); }).find("a newer version of Insula"), std::string::npos);
  const fs::path text = folder_.path() / "text.sqlite";
  std::ofstream(text) << std::string(5000, 'x');
  EXPECT_NE(message_of([&] { Store store(text); }).find("not a database"), std::string::npos);
  EXPECT_NE(message_of([&] { Store store("/proc/nowhere/x.sqlite"); }).find("/proc/nowhere"), std::string::npos);
}

TEST(Uuid, IsOfVersionFourAndNeverTheSame) {
  std::set<std::string> seen;
  for (int k = 0; k < 1000; ++k) {
    const std::string u = new_uuid();
    ASSERT_EQ(u.size(), 36u);
    EXPECT_EQ(u[14], '4');
    EXPECT_NE(std::string("89ab").find(u[19]), std::string::npos);
    EXPECT_TRUE(seen.insert(u).second);
  }
}

}  // namespace
}  // namespace insula::training
