// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/store/outbox.h"

namespace insula::training {

std::vector<OutboxEntry> Outbox::entries(const char* state, std::int64_t most) const {
  Statement s = database_.prepare(
      "SELECT uuid, attempts, next_try_ms, error FROM outbox JOIN runs ON runs.id = outbox.run "
      "WHERE outbox.state = ?1 ORDER BY outbox.began_ms, outbox.run LIMIT ?2");
  s.bind(state, most);
  std::vector<OutboxEntry> out;
  while (s.step()) out.push_back({s.text(0), int(s.integer(1)), s.integer(2), s.text(3)});
  return out;
}

std::vector<OutboxEntry> Outbox::pending(std::size_t most) const { return entries("pending", std::int64_t(most)); }
std::vector<OutboxEntry> Outbox::refused() const { return entries("refused", -1); }

OutboxCounts Outbox::counts() const {
  OutboxCounts out;
  Statement s = database_.prepare("SELECT state, count(*) FROM outbox GROUP BY state");
  while (s.step()) {
    const std::string state = s.text(0);
    (state == "sent" ? out.sent : state == "refused" ? out.refused : out.pending) = s.integer(1);
  }
  return out;
}

void Outbox::change(const std::vector<std::string>& runs, const char* state, std::int64_t next_try_ms,
                    const std::string& error) const {
  Transaction transaction(database_);
  Statement s = database_.prepare(
      "UPDATE outbox SET state = ?2, attempts = attempts + 1, next_try_ms = ?3, error = ?4 "
      "WHERE run = (SELECT id FROM runs WHERE uuid = ?1)");
  for (const std::string& run : runs) s.bind(run, state, next_try_ms, error).run();
  transaction.commit();
}

void Outbox::sent(const std::vector<std::string>& runs) const { change(runs, "sent", 0, ""); }
void Outbox::refused(const std::vector<std::string>& runs, const std::string& error) const {
  change(runs, "refused", 0, error);
}
void Outbox::put_off(const std::vector<std::string>& runs, std::int64_t next_try_ms, const std::string& error) const {
  change(runs, "pending", next_try_ms, error);
}

std::int64_t Outbox::queue_all() const {
  Transaction transaction(database_);
  database_
      .prepare("UPDATE outbox SET state = 'pending', attempts = 0, next_try_ms = 0, error = '' WHERE state = 'refused'")
      .run();
  std::int64_t queued = database_.changes();
  // The condition is that of Run::is_attempt().
  database_
      .prepare(
          "INSERT INTO outbox (run, began_ms) SELECT id, began_ms FROM runs WHERE person IS NOT NULL AND "
          "mode != 'demonstration' AND id NOT IN (SELECT run FROM outbox)")
      .run();
  queued += database_.changes();
  transaction.commit();
  return queued;
}

std::string Outbox::home_page() const {
  Statement s = database_.prepare("SELECT value FROM settings WHERE name = 'home_page'");
  return s.step() ? s.text(0) : std::string();
}

void Outbox::set_home_page(const std::string& address) const {
  database_.prepare("INSERT OR REPLACE INTO settings VALUES ('home_page', ?1)").bind(address).run();
}

}  // namespace insula::training
