// SPDX-License-Identifier: GPL-3.0-or-later
#include <fmt/chrono.h>
#include <fmt/ostream.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <utility>

#include "core/base/input_error.h"
#include "core/base/text.h"
#include "engine/command_line/people.h"
#include "engine/command_line/play.h"
#include "engine/command_line/sessions.h"
#include "engine/reports/table_file.h"
#include "engine/reports/xapi_origin.h"
#include "training/store/data_folder.h"
#include "training/store/outbox.h"
#include "training/store/store.h"

namespace insula {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using training::Person;
using training::Run;
using training::Store;

Store open_store(const PeopleOptions& o) { return Store(training::data_folder(o.data).store()); }

/// UTC, ISO 8601.
std::string time_text(std::int64_t ms) {
  return ms == 0 ? std::string() : fmt::format("{:%Y-%m-%dT%H:%M:%S}Z", fmt::gmtime(std::time_t(ms / 1000)));
}

Json person_json(const Person& p) {
  return {{"pseudonym", p.pseudonym},
          {"role", p.role},
          {"handedness", p.handedness},
          {"year", p.year},
          {"added", time_text(p.created_ms)}};
}

/// The persons to be exported; guests' runs belong to "".
std::vector<std::string> whose(const Store& store, const std::string& only) {
  if (!only.empty()) return {only};
  std::vector<std::string> out{""};
  for (const Person& p : store.persons()) out.push_back(p.pseudonym);
  return out;
}

void export_persons(const Store& store, const PeopleOptions& o, std::ostream& out) {
  TableFile table(o.output, "persons", o.format, {"pseudonym", "role", "handedness", "year", "added"});
  const auto only = o.pseudonym.empty() ? std::nullopt : store.find(o.pseudonym);
  for (const Person& p : only ? std::vector{*only} : store.persons())
    table.row({p.pseudonym, p.role, p.handedness, p.year, time_text(p.created_ms)});
  fmt::print(out, "{}\n", table.close().string());
}

void export_runs(const Store& store, const PeopleOptions& o, std::ostream& out) {
  TableFile runs(o.output, "runs", o.format,
                 {"run", "person", "scene", "title", "mode", "began", "duration_s", "state", "goals", "goals_done",
                  "faults", "step_rate_hz", "report", "recording"});
  TableFile metrics(o.output, "metrics", o.format, {"run", "metric", "hand", "value", "unit", "better", "text"});
  TableFile faults(o.output, "faults", o.format, {"run", "fault", "count", "text"});
  for (const std::string& person : whose(store, o.pseudonym))
    for (const Run& r : store.full_runs(person)) {
      runs.row({r.uuid, r.person, r.scene, r.title, r.mode, time_text(r.began_ms), r.duration_s, r.state, r.goals,
                r.goals_done, r.faults, r.step_rate_hz, r.report, r.recording});
      for (const auto& m : r.metrics) metrics.row({r.uuid, m.id, m.hand, m.value, m.unit, m.better, m.text});
      for (const auto& f : r.fault_counts) faults.row({r.uuid, f.id, f.count, f.text});
    }
  for (TableFile* t : {&runs, &metrics, &faults}) fmt::print(out, "{}\n", t->close().string());
}

/// A JSON list of the statements, in order of time for each person. It is written piece by piece.
void export_statements(const Store& store, const PeopleOptions& o, std::ostream& out) {
  const xapi::Origin origin = xapi_origin(training::Outbox(store));
  std::ofstream file(o.xapi, std::ios::binary);
  bool first = true;
  for (const std::string& person : whose(store, o.pseudonym)) {
    auto runs = store.full_runs(person);
    std::reverse(runs.begin(), runs.end());
    for (const Run& run : runs)
      for (const Json& s : xapi::statements_of(run, origin))
        file << (std::exchange(first, false) ? "[\n" : ",\n") << s.dump(-1, ' ', false, Json::error_handler_t::replace);
  }
  file << (first ? "[]\n" : "\n]\n");
  file.close();
  if (!file) throw InputError(fmt::format("{}: it cannot be written", o.xapi.string()));
  fmt::print(out, "{}\n", fs::absolute(o.xapi).string());
}

}  // namespace

int cmd_people_add(const CommandContext& context, const PeopleOptions& o) {
  try {
    training::check(o.person);
    open_store(o).add(o.person);
  } catch (const InputError& e) {
    fmt::print(context.err, "error: {}\n", e.what());
    return 2;
  }
  fmt::print(context.out, "added {}\n", o.person.pseudonym);
  return 0;
}

int cmd_people_list(const CommandContext& context, const PeopleOptions& o) {
  const Store store = open_store(o);
  Json list = Json::array();
  for (const Person& p : store.persons()) {
    int runs = 0;
    std::int64_t last = 0;
    for (const auto& h : store.history(p.pseudonym)) {
      runs += h.runs;
      if (h.last) last = std::max(last, h.last->began_ms);
    }
    list.push_back(person_json(p));
    list.back()["runs"] = runs;
    list.back()["last_run"] = time_text(last);
  }
  if (o.json) {
    fmt::print(context.out, "{}\n", list.dump(2));
    return 0;
  }
  if (list.empty()) fmt::print(context.out, "nobody yet: insula people add PSEUDONYM\n");
  for (const Json& p : list) {
    const int year = p["year"];
    fmt::print(context.out, "{:<20} {:<11} {:<9} {:<5} {:>5} runs  {}\n", p["pseudonym"].get<std::string>(),
               p["role"].get<std::string>(), p["handedness"].get<std::string>(), year ? std::to_string(year) : "",
               p["runs"].get<int>(), p["last_run"].get<std::string>());
  }
  return 0;
}

int cmd_people_export(const CommandContext& context, const PeopleOptions& o) {
  const Store store = open_store(o);
  if (!o.pseudonym.empty() && !store.find(o.pseudonym)) {
    fmt::print(context.err, "error: nobody has the pseudonym {}\n", in_quotes(o.pseudonym));
    return 2;
  }
  if (o.output.empty() && o.xapi.empty()) {
    fmt::print(context.err, "error: say where to write: -o FOLDER for tables, --xapi FILE for statements\n");
    return 2;
  }
  if (!o.xapi.empty()) export_statements(store, o, context.out);
  if (o.output.empty()) return 0;
  fs::create_directories(o.output);
  export_persons(store, o, context.out);
  export_runs(store, o, context.out);
  return 0;
}

int cmd_people_forget(const CommandContext& context, const PeopleOptions& o) {
  if (open_store(o).forget(o.pseudonym)) fmt::print(context.out, "removed {} from the training store\n", o.pseudonym);
  ForgetOptions files;
  files.person = o.pseudonym;
  files.folders = o.folders.empty() ? folders_of_play(o.data) : o.folders;
  return cmd_session_forget(context, files);
}

int cmd_people_backup(const CommandContext& context, const PeopleOptions& o) {
  open_store(o).back_up(o.output);
  fmt::print(context.out, "{}\n", fs::absolute(o.output).string());
  return 0;
}

}  // namespace insula
