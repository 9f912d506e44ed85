// SPDX-License-Identifier: GPL-3.0-or-later
// What a learning record store is still to be told: an entry for each attempt of a person, written with its run in one
// transaction. It goes with the run when the person is forgotten.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "training/store/store.h"

namespace insula::training {

struct OutboxEntry {
  std::string run;  ///< its uuid
  int attempts = 0;
  std::int64_t next_try_ms = 0;  ///< not before; milliseconds since 1970, UTC
  std::string error;             ///< of the last attempt; empty: none, or it was sent
};

struct OutboxCounts {
  std::int64_t pending = 0, sent = 0, refused = 0;
};

/// All members throw InputError when the store cannot be read or written.
class Outbox {
 public:
  /// The store must outlive it.
  explicit Outbox(const Store& store) : database_(store.database_) {}

  /// The entries that have neither been sent nor refused, in order of the runs' beginnings.
  std::vector<OutboxEntry> pending(std::size_t most) const;
  std::vector<OutboxEntry> refused() const;  ///< in the same order
  OutboxCounts counts() const;

  /// Each of these changes all given runs or none.
  void sent(const std::vector<std::string>& runs) const;
  void refused(const std::vector<std::string>& runs, const std::string& error) const;
  /// They stay pending.
  void put_off(const std::vector<std::string>& runs, std::int64_t next_try_ms, const std::string& error) const;
  /// Queues the attempts that are not there, such as those of before there was an outbox, and what was refused.
  /// Returns how many.
  std::int64_t queue_all() const;

  /// Address of this installation, to which the accounts of its persons belong. It is drawn at random at first.
  std::string home_page() const;
  void set_home_page(const std::string& address) const;

 private:
  std::vector<OutboxEntry> entries(const char* state, std::int64_t most) const;
  void change(const std::vector<std::string>& runs, const char* state, std::int64_t next_try_ms,
              const std::string& error) const;

  const Database& database_;
};

}  // namespace insula::training
