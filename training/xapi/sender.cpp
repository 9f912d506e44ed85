// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/xapi/sender.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

#include "core/base/input_error.h"
#include "core/base/text.h"
#include "training/xapi/backoff.h"

namespace insula::xapi {
namespace {

constexpr std::int64_t most_patience_s = 3600;  // more than this is not believed

bool accepted(int status) { return status == 200 || status == 204; }
bool comes_back(int status) { return status == 0 || status == 408 || status == 429 || status >= 500; }
/// The request was understood and what it says is refused. 413: it is too large.
bool of_statements(int status) { return status == 400 || status == 413 || status == 422; }

std::string said(const Answer& a) {
  const std::string text = shown(trim(a.text));
  if (a.status == 0) return fmt::format("no answer: {}", text);
  return text.empty() ? fmt::format("status {}", a.status) : fmt::format("status {}: {}", a.status, text);
}

/// Whether a list of ids, the answer to a post, names all statements.
bool names_all(const std::string& text, const std::vector<const Json*>& statements) {
  const Json ids = Json::parse(text, nullptr, false);
  if (!ids.is_array()) return false;
  std::set<std::string> named;
  for (const Json& id : ids)
    if (id.is_string()) named.insert(id.get<std::string>());
  return std::all_of(statements.begin(), statements.end(),
                     [&](const Json* s) { return named.count((*s)["id"].get<std::string>()) > 0; });
}

/// Whether the store has this very statement. It may have added to it, and older programs may have said more or less.
bool is_ours(const Json& found, const Json& ours) {
  if (!found.is_object()) return false;
  const auto at = [](const Json& s, const char* path) {
    const Json::json_pointer where(path);
    return s.contains(where) ? s.at(where) : Json();
  };
  for (const char* path : {"/id", "/verb/id", "/object/id", "/actor/account/name", "/context/registration"})
    if (at(found, path) != at(ours, path)) return false;
  return true;
}

std::string body_of(const std::vector<const Json*>& statements) {
  std::string out = "[";
  for (const Json* s : statements) {
    if (out.size() > 1) out += ',';
    out += s->dump(-1, ' ', false, Json::error_handler_t::replace);
  }
  return out + "]";
}

}  // namespace

Sender::Sender(const training::Store& store, RecordStore& records, Origin origin, SenderSettings settings,
               std::mt19937_64& random)
    : store_(store),
      outbox_(store),
      records_(records),
      origin_(std::move(origin)),
      settings_(std::move(settings)),
      random_(random) {}

Round Sender::round() {
  Round round;
  for (Items items = next_batch(round); !items.empty(); items = next_batch(round))
    if (!send(items, round)) break;
  return round;
}

Sender::Items Sender::next_batch(Round& round) {
  for (;;) {
    const auto entries = outbox_.pending(settings_.most_runs);
    if (entries.empty()) return {};
    // The first in time keeps the others back, so that they arrive in order.
    if (settings_.patient && entries[0].next_try_ms > settings_.now_ms()) {
      round.end = Round::End::later, round.next_try_ms = entries[0].next_try_ms, round.why = entries[0].error;
      return {};
    }
    Items items;
    for (const auto& e : entries) {
      const auto run = store_.run(e.run);
      if (!run) continue;  // forgotten in between
      try {
        auto statements = statements_of(*run, origin_);
        if (statements.empty()) throw InputError("it is no attempt");
        items.push_back({e.run, e.attempts, std::move(statements)});
      } catch (const InputError& error) {
        refuse(e.run, error.what(), round);
      }
    }
    if (!items.empty()) return items;
  }
}

bool Sender::send(const Items& items, Round& round) {
  std::vector<const Json*> statements;
  for (const Item& i : items)
    for (const Json& s : i.statements) statements.push_back(&s);
  const Answer answer = records_.post(body_of(statements));
  if (answer.status == 200 && !names_all(answer.text, statements))
    return stop(items, "it does not answer as a learning record store does", round);
  if (accepted(answer.status)) {
    accept(items, round);
    return true;
  }
  if (comes_back(answer.status)) return put_off(items, answer, round);
  if (answer.status == 401 || answer.status == 403)
    return stop(items, "it does not let this account in (" + said(answer) + ")", round);
  if (answer.status != 409 && !of_statements(answer.status)) return stop(items, said(answer), round);
  if (items.size() > 1) return send_halves(items, round);
  if (answer.status == 409) return settle_conflict(items, round);
  refuse(items[0].run, said(answer), round);
  return true;
}

bool Sender::send_halves(const Items& items, Round& round) {
  const auto middle = items.begin() + std::ptrdiff_t(items.size() / 2);
  return send(Items(items.begin(), middle), round) && send(Items(middle, items.end()), round);
}

/// A statement with one of these ids is there. If it says what ours says, it came here before.
bool Sender::settle_conflict(const Items& items, Round& round) {
  const Item& item = items[0];
  for (const Json& s : item.statements) {
    Answer there = records_.get(s["id"].get<std::string>());
    if (there.status == 404) there = records_.post(body_of({&s}));  // the list was refused for the other one's sake
    else if (there.status == 200 && !is_ours(Json::parse(there.text, nullptr, false), s)) there.status = 409;
    if (accepted(there.status)) continue;
    if (comes_back(there.status)) return put_off(items, there, round);
    if (there.status == 401 || there.status == 403) return stop(items, said(there), round);
    const bool other = there.status == 409;
    refuse(item.run, other ? "another statement with the same id is there" : said(there), round);
    return true;
  }
  accept(items, round);
  return true;
}

bool Sender::stop(const Items& items, const std::string& why, Round& round) {
  std::vector<std::string> runs;
  for (const Item& i : items) runs.push_back(i.run);
  outbox_.put_off(runs, 0, why);
  round.end = Round::End::stop, round.why = why;
  return false;
}

bool Sender::put_off(const Items& items, const Answer& answer, Round& round) {
  const std::int64_t asked_ms = 1000 * std::min(answer.retry_after_s, most_patience_s);
  const std::int64_t wait = std::max(asked_ms, backoff_ms(items[0].attempts + 1, random_));
  round.end = Round::End::later, round.next_try_ms = settings_.now_ms() + wait, round.why = said(answer);
  std::vector<std::string> runs;
  for (const Item& i : items) runs.push_back(i.run);
  outbox_.put_off(runs, round.next_try_ms, round.why);
  return false;
}

void Sender::refuse(const std::string& run, const std::string& why, Round& round) {
  outbox_.refused({run}, why);
  ++round.refused;
}

void Sender::accept(const Items& items, Round& round) {
  std::vector<std::string> runs;
  for (const Item& i : items) runs.push_back(i.run);
  outbox_.sent(runs);
  round.sent += int(runs.size());
}

}  // namespace insula::xapi
