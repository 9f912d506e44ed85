// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/store/store.h"

#include <fmt/format.h>

#include <chrono>
#include <random>

#include "core/base/input_error.h"
#include "core/base/text.h"
#include "training/store/run_details.h"
#include "training/store/schema.h"

namespace insula::training {
namespace fs = std::filesystem;
namespace {

constexpr const char* person_columns = "id, pseudonym, role, handedness, year, created_ms";
// The person's number is replaced by the pseudonym.
constexpr const char* run_columns =
    "runs.id, uuid, ifnull((SELECT pseudonym FROM persons WHERE id = runs.person), ''), scene, title, mode, began_ms, "
    "duration_s, state, goals, goals_done, faults, step_rate_hz, report, recording, seed, guided, version";
// A guest's runs have no person. IS compares NULL too, and uses the index.
constexpr const char* of_person = "person IS ?1";

constexpr std::int64_t nobody = -1;  // number of a person who is not there

std::int64_t now_ms() {
  using namespace std::chrono;
  return duration_cast<milliseconds>(system_clock::now().time_since_epoch()).count();
}

fs::path with_folder(const fs::path& file) {
  std::error_code error;
  if (file.has_parent_path()) fs::create_directories(file.parent_path(), error);
  if (error) throw InputError(fmt::format("{}: no folder can be made there: {}", file.string(), error.message()));
  return file;
}

Person person_of(const Statement& s) {
  return {s.integer(0), s.text(1), s.text(2), s.text(3), int(s.integer(4)), s.integer(5)};
}

Run run_of(const Statement& s) {
  Run r;
  r.id = s.integer(0), r.uuid = s.text(1), r.person = s.text(2), r.scene = s.text(3), r.title = s.text(4);
  r.mode = s.text(5), r.began_ms = s.integer(6), r.duration_s = s.real(7), r.state = s.text(8);
  r.goals = int(s.integer(9)), r.goals_done = int(s.integer(10)), r.faults = int(s.integer(11));
  r.step_rate_hz = s.real(12), r.report = s.text(13), r.recording = s.text(14);
  if (!s.null(15)) r.seed = s.integer(15);
  r.guided = s.integer(16) != 0, r.version = s.text(17);
  return r;
}

}  // namespace

Store::Store(const fs::path& file) : database_(with_folder(file)) { migrate(database_); }

Person Store::add(Person person) {
  check(person);
  Transaction transaction(database_);
  if (find(person.pseudonym)) throw InputError(fmt::format("the pseudonym {} is in use", in_quotes(person.pseudonym)));
  person.created_ms = now_ms();
  database_.prepare("INSERT INTO persons (pseudonym, role, handedness, year, created_ms) VALUES (?1, ?2, ?3, ?4, ?5)")
      .bind(person.pseudonym, person.role, person.handedness, person.year, person.created_ms)
      .run();
  person.id = database_.last_id();
  transaction.commit();
  return person;
}

std::vector<Person> Store::persons() const {
  std::vector<Person> out;
  Statement s = database_.prepare(fmt::format("SELECT {} FROM persons ORDER BY pseudonym", person_columns));
  while (s.step()) out.push_back(person_of(s));
  return out;
}

std::optional<Person> Store::find(const std::string& pseudonym) const {
  Statement s = database_.prepare(fmt::format("SELECT {} FROM persons WHERE pseudonym = ?1", person_columns));
  s.bind(pseudonym);
  return s.step() ? std::optional(person_of(s)) : std::nullopt;
}

bool Store::forget(const std::string& pseudonym) {
  database_.prepare("DELETE FROM persons WHERE pseudonym = ?1").bind(pseudonym).run();
  const bool gone = database_.changes() > 0;
  // The log still has the rows until it is written back.
  if (gone) database_.run("PRAGMA wal_checkpoint(TRUNCATE);");
  return gone;
}

void Store::follow(const std::string& pseudonym, const std::string& curriculum) {
  const auto person = find(pseudonym);
  if (!person) throw InputError(fmt::format("nobody has the pseudonym {}", in_quotes(pseudonym)));
  if (curriculum.empty())
    return database_.prepare("DELETE FROM followed_curricula WHERE person = ?1").bind(person->id).run();
  database_.prepare("INSERT OR REPLACE INTO followed_curricula (person, curriculum, chosen_ms) VALUES (?1, ?2, ?3)")
      .bind(person->id, curriculum, now_ms())
      .run();
}

std::string Store::followed(const std::string& pseudonym) const {
  Statement s = database_.prepare(
      "SELECT curriculum FROM followed_curricula WHERE person = (SELECT id FROM persons WHERE pseudonym = ?1)");
  s.bind(pseudonym);
  return s.step() ? s.text(0) : std::string();
}

std::optional<std::int64_t> Store::number_of(const std::string& pseudonym) const {
  const auto known = pseudonym.empty() ? std::nullopt : find(pseudonym);
  if (known) return known->id;
  return pseudonym.empty() ? std::nullopt : std::optional(nobody);
}

std::optional<std::int64_t> Store::number_or_new(const std::string& pseudonym) {
  const auto known = number_of(pseudonym);
  if (known != nobody) return known;
  Person person;
  person.pseudonym = pseudonym;
  check(person);
  database_.prepare("INSERT INTO persons (pseudonym, role, handedness, year, created_ms) VALUES (?1, ?2, ?3, 0, ?4)")
      .bind(person.pseudonym, person.role, person.handedness, now_ms())
      .run();
  return database_.last_id();
}

bool Store::insert(const Run& run) {
  const auto person = number_or_new(run.person);
  database_
      .prepare(
          "INSERT INTO runs (uuid, person, scene, title, mode, began_ms, duration_s, state, goals, goals_done, "
          "faults, step_rate_hz, report, recording, seed, guided, version) VALUES (?1, ?2, ?3, ?4, ?5, ?6, ?7, ?8, "
          "?9, ?10, ?11, ?12, ?13, ?14, ?15, ?16, ?17) ON CONFLICT (uuid) DO NOTHING")
      .bind(run.uuid, person, run.scene, run.title, run.mode, run.began_ms, run.duration_s, run.state, run.goals,
            run.goals_done, run.faults, run.step_rate_hz, run.report, run.recording, run.seed, int(run.guided),
            run.version)
      .run();
  if (database_.changes() == 0) return false;
  const std::int64_t id = database_.last_id();
  insert_details(database_, run, id);
  if (run.is_attempt())
    database_.prepare("INSERT INTO outbox (run, began_ms) VALUES (?1, ?2)").bind(id, run.began_ms).run();
  return true;
}

bool Store::add(const Run& run) {
  Transaction transaction(database_);
  const bool added = insert(run);
  if (added) transaction.commit();
  return added;
}

std::size_t Store::add(const std::vector<Run>& runs) {
  Transaction transaction(database_);
  std::size_t added = 0;
  for (const Run& run : runs) added += insert(run);
  transaction.commit();
  return added;
}

std::vector<Run> Store::runs(const std::string& person, std::size_t most) const {
  std::vector<Run> out;
  Statement s = database_.prepare(
      fmt::format("SELECT {} FROM runs WHERE {} ORDER BY began_ms DESC, id DESC LIMIT ?2", run_columns, of_person));
  s.bind(number_of(person), std::int64_t(most));
  while (s.step()) out.push_back(run_of(s));
  return out;
}

std::vector<Run> Store::full_runs(const std::string& person) const {
  std::vector<Run> out = runs(person, all_runs);
  read_details(database_, out, of_person, [&](Statement& s) { s.bind(number_of(person)); });
  return out;
}

std::optional<Run> Store::run(const std::string& uuid) const {
  Statement s = database_.prepare(fmt::format("SELECT {} FROM runs WHERE uuid = ?1", run_columns));
  s.bind(uuid);
  if (!s.step()) return std::nullopt;
  std::vector<Run> out{run_of(s)};
  read_details(database_, out, "uuid = ?1", [&](Statement& d) { d.bind(uuid); });
  return std::move(out[0]);
}

std::vector<ExerciseHistory> Store::history(const std::string& person) const {
  std::vector<ExerciseHistory> out;
  Statement scenes = database_.prepare(
      fmt::format("SELECT scene, count(*) FROM runs WHERE {} AND mode != 'demonstration' GROUP BY scene", of_person));
  const auto number = number_of(person);
  scenes.bind(number);
  const auto first = [&](const std::string& scene, const char* order) -> std::optional<Run> {
    Statement s = database_.prepare(
        fmt::format("SELECT {} FROM runs WHERE {} AND scene = ?2 AND mode != 'demonstration' ORDER BY {} LIMIT 1",
                    run_columns, of_person, order));
    s.bind(number, scene);
    return s.step() ? std::optional(run_of(s)) : std::nullopt;
  };
  while (scenes.step()) {
    ExerciseHistory h;
    h.scene = scenes.text(0), h.runs = int(scenes.integer(1));
    h.last = first(h.scene, "began_ms DESC, id DESC");
    h.best = first(h.scene, "state = 'done' DESC, faults, duration_s, began_ms, id");
    h.title = h.last ? h.last->title : "";
    out.push_back(std::move(h));
  }
  return out;
}

std::vector<LearningCurve> Store::curves(const std::string& person, const std::string& scene) const {
  std::vector<LearningCurve> out;
  Statement s = database_.prepare(fmt::format(
      "SELECT v.metric, v.hand, v.value, m.text, m.unit, m.better, m.digits, uuid, began_ms, mode, state FROM runs "
      "JOIN run_metrics v ON v.run = runs.id JOIN metrics m ON m.scene = runs.scene AND m.metric = v.metric "
      "WHERE {} AND runs.scene = ?2 AND mode != 'demonstration' ORDER BY v.metric, v.hand, began_ms, runs.id",
      of_person));
  s.bind(number_of(person), scene);
  while (s.step()) {
    if (out.empty() || out.back().metric.id != s.text(0) || out.back().metric.hand != s.text(1))
      out.push_back({{s.text(0), s.text(1), 0, s.text(3), s.text(4), s.text(5), int(s.integer(6))}, {}});
    out.back().points.push_back({s.text(7), s.integer(8), s.text(9), s.text(10) == "done", s.real(2)});
  }
  return out;
}

std::string new_uuid() {
  std::random_device random;
  const auto part = [&] { return (std::uint64_t(random()) << 32) | random(); };
  const std::uint64_t high = (part() & ~0xf000ull) | 0x4000ull;
  const std::uint64_t low = (part() & ~(3ull << 62)) | (2ull << 62);
  return fmt::format("{:08x}-{:04x}-{:04x}-{:04x}-{:012x}", high >> 32, (high >> 16) & 0xffff, high & 0xffff, low >> 48,
                     low & 0xffffffffffffull);
}

}  // namespace insula::training
