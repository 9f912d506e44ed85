// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/store/schema.h"

#include <fmt/format.h>

#include <iterator>

#include "core/base/input_error.h"

namespace insula::training {
namespace {

// One entry leads from the schema of its place in the list to the next one. Entries are never changed, only added.
constexpr const char* migrations[] = {
    // 1: persons, their runs, and what was measured in each run.
    R"(CREATE TABLE persons (
         id INTEGER PRIMARY KEY, pseudonym TEXT NOT NULL UNIQUE COLLATE NOCASE, role TEXT NOT NULL,
         handedness TEXT NOT NULL, year INTEGER NOT NULL, created_ms INTEGER NOT NULL);
       CREATE TABLE runs (
         id INTEGER PRIMARY KEY, uuid TEXT NOT NULL UNIQUE, person INTEGER REFERENCES persons ON DELETE CASCADE,
         scene TEXT NOT NULL, title TEXT NOT NULL, mode TEXT NOT NULL, began_ms INTEGER NOT NULL,
         duration_s REAL NOT NULL, state TEXT NOT NULL, goals INTEGER NOT NULL, goals_done INTEGER NOT NULL,
         faults INTEGER NOT NULL, step_rate_hz REAL NOT NULL, seed INTEGER, guided INTEGER NOT NULL,
         report TEXT NOT NULL, recording TEXT NOT NULL);
       CREATE INDEX runs_of_person ON runs (person, scene, began_ms);
       CREATE TABLE metrics (
         scene TEXT NOT NULL, metric TEXT NOT NULL, text TEXT NOT NULL, unit TEXT NOT NULL, better TEXT NOT NULL,
         digits INTEGER NOT NULL, PRIMARY KEY (scene, metric)) WITHOUT ROWID;
       CREATE TABLE run_metrics (
         run INTEGER NOT NULL REFERENCES runs ON DELETE CASCADE, metric TEXT NOT NULL, hand TEXT NOT NULL,
         value REAL NOT NULL, PRIMARY KEY (run, metric, hand)) WITHOUT ROWID;
       CREATE TABLE run_faults (
         run INTEGER NOT NULL REFERENCES runs ON DELETE CASCADE, fault TEXT NOT NULL, text TEXT NOT NULL,
         count INTEGER NOT NULL, PRIMARY KEY (run, fault)) WITHOUT ROWID;)",
    // What learning record stores are to be told. began_ms is that of the run, for the order of sending.
    R"(ALTER TABLE runs ADD COLUMN version TEXT NOT NULL DEFAULT '';
       CREATE INDEX runs_by_time ON runs (person, began_ms);
       CREATE TABLE outbox (
         run INTEGER PRIMARY KEY REFERENCES runs ON DELETE CASCADE, began_ms INTEGER NOT NULL,
         state TEXT NOT NULL DEFAULT 'pending', attempts INTEGER NOT NULL DEFAULT 0,
         next_try_ms INTEGER NOT NULL DEFAULT 0, error TEXT NOT NULL DEFAULT '');
       CREATE INDEX outbox_in_order ON outbox (state, began_ms, run);
       CREATE TABLE settings (name TEXT PRIMARY KEY, value TEXT NOT NULL) WITHOUT ROWID;
       INSERT INTO settings VALUES ('home_page', 'https://' || lower(hex(randomblob(8))) || '.insula.invalid');)",
    // The curriculum that a person follows.
    R"(CREATE TABLE followed_curricula (
         person INTEGER PRIMARY KEY REFERENCES persons ON DELETE CASCADE, curriculum TEXT NOT NULL,
         chosen_ms INTEGER NOT NULL);)",
};

int version_of(const Database& database) {
  Statement s = database.prepare("PRAGMA user_version");
  s.step();
  return int(s.integer(0));
}

void refuse_newer(const Database& database, int version) {
  if (version > schema_version())
    throw InputError(fmt::format("{}: a newer version of Insula has written it (schema {}; this program knows {})",
                                 database.file(), version, schema_version()));
}

}  // namespace

int schema_version() { return int(std::size(migrations)); }

void migrate(const Database& database) {
  int version = version_of(database);
  refuse_newer(database, version);
  if (version == schema_version()) return;
  if (version > 0) database.back_up(database.file() + fmt::format(".before_{}", schema_version()));
  Transaction transaction(database);
  version = version_of(database);  // another process may have been first
  refuse_newer(database, version);
  for (; version < schema_version(); ++version) database.run(migrations[version]);
  database.run(fmt::format("PRAGMA user_version={}", version));
  transaction.commit();
}

}  // namespace insula::training
