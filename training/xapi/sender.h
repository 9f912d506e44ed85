// SPDX-License-Identifier: GPL-3.0-or-later
// Empties the outbox into a learning record store, in order of time. It keeps no state of its own: whenever it dies,
// another one goes on, and what is sent twice has the same ids.
#pragma once
#include <cstdint>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "training/store/outbox.h"
#include "training/store/store.h"
#include "training/xapi/record_store.h"
#include "training/xapi/statements.h"

namespace insula::xapi {

/// How a round of sending ended.
struct Round {
  enum class End {
    empty,  ///< nothing is left to send
    later,  ///< the store could not be reached, or asks for patience: again at `next_try_ms`
    stop,   ///< the store does not let this account in, or is no learning record store; a person must look
  };
  End end = End::empty;
  int sent = 0, refused = 0;  ///< runs
  std::int64_t next_try_ms = 0;
  std::string why;  ///< of later and stop
};

struct SenderSettings {
  std::size_t most_runs = 50;  ///< in one request
  bool patient = true;         ///< keeps the time of the next try that the outbox names
  std::function<std::int64_t()> now_ms;
};

class Sender {
 public:
  /// All of these must outlive it. random: what the waits after failures are drawn from.
  Sender(const training::Store& store, RecordStore& records, Origin origin, SenderSettings settings,
         std::mt19937_64& random);

  /// Sends what is pending until nothing is left or the store stops it. A bad statement does not block others: the
  /// batch is split until it is alone.
  Round round();

 private:
  struct Item {
    std::string run;
    int attempts = 0;
    std::vector<Json> statements;
  };
  using Items = std::vector<Item>;
  std::vector<Item> next_batch(Round& round);
  /// False: the round has ended.
  bool send(const Items& items, Round& round);
  bool send_halves(const Items& items, Round& round);
  bool settle_conflict(const Items& items, Round& round);
  bool stop(const Items& items, const std::string& why, Round& round);
  bool put_off(const Items& items, const Answer& answer, Round& round);
  void refuse(const std::string& run, const std::string& why, Round& round);
  void accept(const Items& items, Round& round);

  const training::Store& store_;
  training::Outbox outbox_;
  RecordStore& records_;
  Origin origin_;
  SenderSettings settings_;
  std::mt19937_64& random_;
};

}  // namespace insula::xapi
