// SPDX-License-Identifier: GPL-3.0-or-later
// Ten thousand sessions: what a page asks for must not cost more because others have trained too.
#include <gtest/gtest.h>

#include <chrono>
#include <cstdio>

#include "training/store/database.h"
#include "training/store/outbox.h"
#include "training/store/records_for_test.h"

namespace insula::training {
namespace {

constexpr int persons = 50, runs_each = 200, scenes = 8, metrics = 6;

std::string name_of(int person) { return "P" + std::to_string(person); }
std::string scene_of(int run) { return "scenes/training/" + std::to_string(run % scenes) + ".xml"; }

std::vector<Run> runs_of(int person) {
  std::vector<Run> out;
  for (int k = 0; k < runs_each; ++k) {
    Run r = run_for_test(name_of(person), scene_of(k), 1'700'000'000'000 + 1000LL * (k * persons + person));
    r.metrics.clear();
    for (int m = 0; m < metrics; ++m)
      r.metrics.push_back(
          {"metric_" + std::to_string(m), m % 2 ? "left" : "right", k + 0.5 * m, "Text", "mm", "low", 1});
    r.fault_counts = {{"torn", "A strand tore", 1 + k % 3}, {"pressed", "Pressed too hard", 2}};
    r.faults = 3 + k % 3;
    out.push_back(std::move(r));
  }
  return out;
}

void fill(Store& store, int first, int end) {
  std::vector<Run> all;
  for (int p = first; p < end; ++p)
    for (Run& r : runs_of(p)) all.push_back(std::move(r));
  ASSERT_EQ(store.add(all), all.size());
}

/// What the start page and the page of a person ask for.
void ask_as_a_page(const Store& store, const std::string& person) {
  EXPECT_EQ(store.history(person).size(), std::size_t(scenes));
  EXPECT_EQ(store.runs(person).size(), 200u);
  EXPECT_EQ(store.curves(person, scene_of(0)).size(), std::size_t(metrics));
  EXPECT_EQ(store.full_runs(person).size(), std::size_t(runs_each));
}

DatabaseWork work_of_a_page(const Store& store) {
  const DatabaseWork before = store.work();
  ask_as_a_page(store, name_of(1));
  const DatabaseWork after = store.work();
  return {after.queries - before.queries, after.rows - before.rows, after.scanned - before.scanned,
          after.steps - before.steps};
}

double ms_since(std::chrono::steady_clock::time_point from) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - from).count();
}

class TenThousandRuns : public testing::Test {
 protected:
  std::filesystem::path file(const char* name) const { return folder_.path() / name; }
  test_files::TempFolder folder_;
};

TEST_F(TenThousandRuns, CostAPageNoMoreThanThoseOfItsPersonAlone) {
  Store all(file("all.sqlite")), alone(file("alone.sqlite"));
  fill(all, 0, persons);
  fill(alone, 1, 2);
  const DatabaseWork among_all = work_of_a_page(all), by_oneself = work_of_a_page(alone);
  EXPECT_EQ(among_all.queries, by_oneself.queries);
  EXPECT_EQ(among_all.rows, by_oneself.rows);
  EXPECT_EQ(among_all.scanned, 0);
  EXPECT_LT(double(among_all.steps), 1.02 * double(by_oneself.steps));
  // Two queries for each scene of the history, and the other answers take one to four each.
  EXPECT_LE(among_all.queries, 2 * scenes + 12);
  EXPECT_LT(among_all.rows, 2 * runs_each * (metrics + 4)) << "rows are read once for each answer";

  const std::int64_t before = all.work().rows;
  EXPECT_EQ(all.persons().size(), std::size_t(persons));
  EXPECT_EQ(all.work().rows - before, persons);
  const DatabaseWork outbox_before = all.work();
  EXPECT_EQ(Outbox(all).pending(50).size(), 50u);
  EXPECT_EQ(all.work().rows - outbox_before.rows, 50);
  EXPECT_EQ(all.work().scanned, outbox_before.scanned);
}

/// The times are printed, not judged: they are those of the machine.
TEST_F(TenThousandRuns, OpenQuickly) {
  {
    Store store(file("all.sqlite"));
    const auto began = std::chrono::steady_clock::now();
    fill(store, 0, persons);
    std::printf("filled in %.0f ms\n", ms_since(began));
  }
  const auto began = std::chrono::steady_clock::now();
  const Store store(file("all.sqlite"));
  const double opened = ms_since(began);
  EXPECT_EQ(store.persons().size(), std::size_t(persons));
  EXPECT_EQ(store.history(name_of(7)).size(), std::size_t(scenes));
  const double first = ms_since(began);
  ask_as_a_page(store, name_of(7));
  std::printf("10,000 runs: open %.1f ms, open and first answers %.1f ms, and all of a person's runs %.1f ms\n", opened,
              first, ms_since(began));
}

/// SQLite's own plan for each query that a page leads to: no table is read from end to end.
TEST_F(TenThousandRuns, QueriesOfAPersonUseAnIndex) {
  { Store store(file("empty.sqlite")); }
  const Database database(file("empty.sqlite"));
  for (const char* query :
       {"SELECT uuid FROM runs WHERE person IS ?1 ORDER BY began_ms DESC, id DESC LIMIT 200",
        "SELECT scene, count(*) FROM runs WHERE person IS ?1 AND mode != 'demonstration' GROUP BY scene",
        "SELECT v.value FROM runs JOIN run_metrics v ON v.run = runs.id JOIN metrics m ON m.scene = runs.scene AND "
        "m.metric = v.metric WHERE person IS ?1 AND runs.scene = ?2",
        "SELECT f.count FROM runs JOIN run_faults f ON f.run = runs.id WHERE person IS ?1 ORDER BY f.run, f.fault",
        "SELECT uuid FROM outbox JOIN runs ON runs.id = outbox.run WHERE outbox.state = 'pending' "
        "ORDER BY outbox.began_ms, outbox.run LIMIT 50"}) {
    Statement plan = database.prepare(std::string("EXPLAIN QUERY PLAN ") + query);
    while (plan.step()) {
      const std::string detail = plan.text(3);
      EXPECT_FALSE(detail.starts_with("SCAN")) << query << ": " << detail;
    }
  }
}

}  // namespace
}  // namespace insula::training
