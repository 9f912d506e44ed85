// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/store/outbox.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>

#include "training/store/database.h"
#include "training/store/records_for_test.h"

namespace insula::training {
namespace {

class TrainingOutbox : public testing::Test {
 protected:
  std::filesystem::path file() const { return folder_.path() / "training.sqlite"; }
  std::vector<std::string> waiting(const Store& store) const {
    std::vector<std::string> out;
    for (const auto& e : Outbox(store).pending(1000)) out.push_back(e.run);
    return out;
  }

  test_files::TempFolder folder_;
};

TEST_F(TrainingOutbox, HoldsTheAttemptsOfPersonsInOrderOfTime) {
  Store store(file());
  const auto late = run_for_test("P07", "a.xml", 9), early = run_for_test("P08", "a.xml", 3);
  auto shown = run_for_test("P07", "a.xml", 1);
  shown.mode = "demonstration";
  for (const auto& r : {late, early, shown, run_for_test("", "a.xml", 2)}) store.add(r);
  store.add(late);
  EXPECT_EQ(waiting(store), (std::vector{early.uuid, late.uuid}));
  EXPECT_EQ(Outbox(store).pending(1).size(), 1u);
}

TEST_F(TrainingOutbox, RemembersWhatWasSentRefusedAndPutOff) {
  Store store(file());
  std::vector<training::Run> runs;
  for (int k = 0; k < 4; ++k) runs.push_back(run_for_test("P07", "a.xml", k));
  EXPECT_EQ(store.add(runs), 4u);
  {
    const Outbox outbox(store);
    outbox.sent({runs[0].uuid, runs[3].uuid});
    outbox.refused({runs[1].uuid}, "no");
    outbox.put_off({runs[2].uuid}, 5000, "nobody there");
    outbox.put_off({runs[2].uuid}, 7000, "still nobody there");
  }
  const Store again(file());
  const Outbox outbox(again);
  const auto pending = outbox.pending(10);
  ASSERT_EQ(pending.size(), 1u);
  EXPECT_EQ(pending[0].attempts, 2);
  EXPECT_EQ(pending[0].next_try_ms, 7000);
  EXPECT_EQ(pending[0].error, "still nobody there");
  ASSERT_EQ(outbox.refused().size(), 1u);
  EXPECT_EQ(outbox.refused()[0].error, "no");
  EXPECT_EQ(outbox.counts().sent, 2);
  EXPECT_EQ(outbox.queue_all(), 1) << "what was sent stays sent";
  EXPECT_EQ(outbox.pending(10).size(), 2u);
  EXPECT_TRUE(outbox.refused().empty());
}

TEST_F(TrainingOutbox, ForgetsWhatWaitsForAPersonWhoIsForgotten) {
  Store store(file());
  store.add(run_for_test("P07", "a.xml", 1));
  const auto other = run_for_test("P08", "a.xml", 2);
  store.add(other);
  store.forget("P07");
  EXPECT_EQ(waiting(store), std::vector{other.uuid});
  EXPECT_EQ(Outbox(store).counts().pending, 1);
}

TEST_F(TrainingOutbox, ComesToAnOlderStoreWithoutWhatHappenedBefore) {
  const auto old = run_for_test("P07", "a.xml", 1);
  {
    Store store(file());
    store.add({old, run_for_test("", "a.xml", 2)});
  }
  {
    Database database(file());
    database.run(
        "DROP TABLE followed_curricula; DROP TABLE outbox; DROP TABLE settings; DROP INDEX runs_by_time; ALTER TABLE "
        "runs DROP COLUMN version; "
        "PRAGMA user_version=1;");
  }
  Store store(file());
  EXPECT_TRUE(waiting(store).empty());
  EXPECT_EQ(store.run(old.uuid)->metrics.size(), 2u);
  EXPECT_EQ(Outbox(store).queue_all(), 1) << "guests are not queued";
  EXPECT_EQ(waiting(store), std::vector{old.uuid});
}

TEST_F(TrainingOutbox, DrawsAHomePageOfItsOwnAndKeepsAnother) {
  const Store one(file()), other(folder_.path() / "other.sqlite");
  const std::string drawn = Outbox(one).home_page();
  EXPECT_TRUE(drawn.starts_with("https://") && drawn.ends_with(".insula.invalid")) << drawn;
  EXPECT_EQ(drawn, Outbox(Store(file())).home_page());
  EXPECT_NE(drawn, Outbox(other).home_page());
  Outbox(one).set_home_page("https://training.example.org");
  EXPECT_EQ(Outbox(Store(file())).home_page(), "https://training.example.org");
}

/// A run that is kept is queued, whenever the writer is killed: neither is there without the other.
TEST_F(TrainingOutbox, HasEachRunOfAWriterThatIsKilled) {
  int told[2];
  ASSERT_EQ(pipe(told), 0);
  const pid_t child = fork();
  if (child == 0) {
    try {
      Store store(file());
      for (std::int64_t k = 0;; ++k) {
        store.add(run_for_test("P07", "a.xml", k));
        if (write(told[1], &k, sizeof k) != sizeof k) _exit(1);
      }
    } catch (...) {
    }
    _exit(1);
  }
  close(told[1]);
  std::int64_t last = -1;
  while (last < 40) ASSERT_EQ(read(told[0], &last, sizeof last), ssize_t(sizeof last));
  kill(child, SIGKILL);
  waitpid(child, nullptr, 0);
  for (std::int64_t k; read(told[0], &k, sizeof k) == ssize_t(sizeof k);) last = k;
  close(told[0]);
  const Store store(file());
  const auto runs = store.runs("P07", Store::all_runs);
  EXPECT_GE(std::int64_t(runs.size()), last + 1);
  std::vector<std::string> in_order;
  for (auto r = runs.rbegin(); r != runs.rend(); ++r) in_order.push_back(r->uuid);
  const auto queued = Outbox(store).pending(Store::all_runs);
  ASSERT_EQ(queued.size(), in_order.size());
  for (std::size_t k = 0; k < queued.size(); ++k) EXPECT_EQ(queued[k].run, in_order[k]);
}

}  // namespace
}  // namespace insula::training
