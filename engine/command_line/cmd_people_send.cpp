// SPDX-License-Identifier: GPL-3.0-or-later
// insula people send: what persons have done goes to a learning record store.
#include <fmt/chrono.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <chrono>
#include <thread>

#include "core/base/input_error.h"
#include "core/base/text.h"
#include "engine/command_line/people.h"
#include "engine/reports/xapi_origin.h"
#include "training/store/data_folder.h"
#include "training/store/outbox.h"
#include "training/xapi/http_record_store.h"
#include "training/xapi/identifiers.h"
#include "training/xapi/sender.h"
#include "training/xapi/sender_lock.h"

namespace insula {
namespace {

using training::Outbox;
using xapi::Round;

constexpr std::int64_t look_ms = 1000;  // how often a sender that watches looks for new runs

std::int64_t present_ms() {
  using namespace std::chrono;
  return duration_cast<milliseconds>(system_clock::now().time_since_epoch()).count();
}

/// Changes what the outbox holds, as the options ask for.
void prepare(const CommandContext& context, const PeopleOptions& o, const Outbox& outbox) {
  if (!o.home_page.empty()) {
    if (!xapi::is_iri(o.home_page) || !o.home_page.starts_with("http"))
      throw InputError(fmt::format("--home-page {}: this is no address", in_quotes(o.home_page)));
    outbox.set_home_page(o.home_page);
  }
  if (o.queue_all) fmt::print(context.out, "queued {} runs\n", outbox.queue_all());
}

void print_state(std::ostream& out, const Outbox& outbox) {
  const auto counts = outbox.counts();
  fmt::print(out, "runs: {} to be sent, {} sent, {} refused\nhome page: {}\n", counts.pending, counts.sent,
             counts.refused, outbox.home_page());
  for (const auto& e : outbox.refused()) fmt::print(out, "refused {}: {}\n", e.run, e.error);
  for (const auto& e : outbox.pending(1))
    if (!e.error.empty()) fmt::print(out, "last attempt: {}\n", e.error);
}

void tell(const CommandContext& context, const Round& round) {
  if (round.sent > 0) fmt::print(context.out, "sent {} run{}\n", round.sent, round.sent == 1 ? "" : "s");
  if (round.refused > 0)
    fmt::print(context.err, "error: the store refused {} run{}; insula people send says why\n", round.refused,
               round.refused == 1 ? "" : "s");
  if (round.end == Round::End::later) fmt::print(context.err, "not all was sent: {}\n", round.why);
  if (round.end == Round::End::stop) fmt::print(context.err, "error: nothing more is sent: {}\n", round.why);
  context.out.flush(), context.err.flush();
}

void sleep_ms(std::int64_t ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }

/// Until a person must look. Each failure is told once.
int watch(const CommandContext& context, xapi::Sender& sender) {
  std::string told;
  for (;;) {
    Round round = sender.round();
    const bool again = round.end == Round::End::later && round.why == told;
    if (!again || round.sent > 0 || round.refused > 0) tell(context, round);
    told = round.why;
    if (round.end == Round::End::stop) return 2;
    const std::int64_t wait = round.end == Round::End::later ? round.next_try_ms - present_ms() : look_ms;
    sleep_ms(std::clamp<std::int64_t>(wait, 100, 5 * look_ms));
  }
}

}  // namespace

int cmd_people_send(const CommandContext& context, const PeopleOptions& o) {
  try {
    const auto file = training::data_folder(o.data).store();
    const training::Store store(file);
    const Outbox outbox(store);
    prepare(context, o, outbox);
    if (o.records.lrs.empty()) {
      print_state(context.out, outbox);
      return 0;
    }
    xapi::HttpRecordStore records(o.records.lrs, xapi::read_login(o.records.login), o.records.authorities);
    const xapi::SenderLock lock(file);
    while (!lock.take()) {
      if (o.watch) {
        sleep_ms(look_ms);
        continue;
      }
      fmt::print(context.out, "another program is sending already\n");
      return 0;
    }
    std::mt19937_64 random(std::random_device{}());
    xapi::Sender sender(store, records, xapi_origin(outbox), {50, o.watch, present_ms}, random);
    if (o.watch) return watch(context, sender);
    const Round round = sender.round();
    tell(context, round);
    return round.end == Round::End::empty && round.refused == 0 ? 0 : 1;
  } catch (const InputError& e) {
    fmt::print(context.err, "error: {}\n", e.what());
    return 2;
  }
}

}  // namespace insula
