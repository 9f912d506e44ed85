// SPDX-License-Identifier: GPL-3.0-or-later
// The training store: persons, their runs and metrics in one SQLite file. Several processes may have it open. All
// members throw InputError when the file cannot be read or written.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "training/store/database.h"
#include "training/store/records.h"

namespace insula::training {

class Store {
 public:
  /// Opens the file. It and its folder are created if they are missing, and an older file is migrated.
  explicit Store(const std::filesystem::path& file);

  /// Adds a person who is not known yet. Throws InputError if the pseudonym is in use or a field is wrong.
  Person add(Person person);
  std::vector<Person> persons() const;  ///< by pseudonym
  std::optional<Person> find(const std::string& pseudonym) const;
  /// Removes a person and all of his runs, and overwrites what they were. False: nobody has this pseudonym.
  bool forget(const std::string& pseudonym);

  /// Lets a person follow the curriculum of that name; an empty one ends it. Throws InputError if nobody has the
  /// pseudonym.
  void follow(const std::string& pseudonym, const std::string& curriculum);
  /// Name of the curriculum that the person follows; empty: none.
  std::string followed(const std::string& pseudonym) const;

  /// Keeps a run. A person who is not known yet is added. False: a run with this uuid is there already.
  bool add(const Run& run);
  /// Keeps several runs at once, all of them or, after a failure, none. Returns how many were new.
  std::size_t add(const std::vector<Run>& runs);
  static constexpr std::size_t all_runs = std::size_t(1) << 40;
  /// The newest `most` runs of a person, or of guests if the pseudonym is empty, without metrics and faults by name.
  std::vector<Run> runs(const std::string& person, std::size_t most = 200) const;
  /// All runs of a person, with metrics and faults, newest first. The number of queries does not depend on the runs.
  std::vector<Run> full_runs(const std::string& person) const;
  /// With its metrics and faults.
  std::optional<Run> run(const std::string& uuid) const;
  /// One entry for each exercise that the person has run, demonstrations left out, by scene.
  std::vector<ExerciseHistory> history(const std::string& person) const;
  /// Of all metrics of a person in an exercise, demonstrations left out, by metric and hand.
  std::vector<LearningCurve> curves(const std::string& person, const std::string& scene) const;

  /// A copy in one file, made while the store is in use.
  void back_up(const std::filesystem::path& to) const { database_.back_up(to); }
  const DatabaseWork& work() const { return database_.work(); }

 private:
  friend class Outbox;
  /// add() within a transaction.
  bool insert(const Run& run);
  /// Number of the person; none for guests, -1 for somebody who is not there.
  std::optional<std::int64_t> number_of(const std::string& pseudonym) const;
  /// The same. Adds who is not there.
  std::optional<std::int64_t> number_or_new(const std::string& pseudonym);

  Database database_;
};

/// A random UUID of version 4 (RFC 9562).
std::string new_uuid();

}  // namespace insula::training
