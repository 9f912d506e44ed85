// SPDX-License-Identifier: GPL-3.0-or-later
// The command lines of the commands for persons.
#include <memory>

#include "engine/command_line/common_options.h"
#include "engine/command_line/people.h"

namespace insula {
namespace {

CLI::IsMember one_of(const auto& names) { return CLI::IsMember(std::vector<std::string>(names.begin(), names.end())); }

}  // namespace

void add_people_commands(CommandLine& line) {
  auto* people = line.app.add_subcommand("people", "persons who train, and what they have done");
  people->require_subcommand(1);
  const auto o = std::make_shared<PeopleOptions>();
  const auto add = [&](const char* name, const char* doc, int (*run)(const CommandContext&, const PeopleOptions&)) {
    auto* command = people->add_subcommand(name, doc);
    add_data(*command, o->data);
    command->callback(
        [&line, o, run] { line.chosen = [o, run](const CommandContext& context) { return run(context, *o); }; });
    return command;
  };
  auto* added = add("add", "a person, under a pseudonym", cmd_people_add);
  added->add_option("pseudonym", o->person.pseudonym, "1 to 40 characters")->required();
  added->add_option("--role", o->person.role, "what the person is")
      ->check(one_of(training::roles))
      ->capture_default_str();
  added->add_option("--handedness", o->person.handedness, "the better hand")
      ->check(one_of(training::handedness_names))
      ->capture_default_str();
  added->add_option("--year", o->person.year, "year of training; 0: not said")->capture_default_str();

  add("list", "all persons, with the number of their runs", cmd_people_list)->add_flag("--json", o->json, "as JSON");

  for (auto* command :
       {add("progress", "how far a person has come in a curriculum, and what is next", cmd_people_progress),
        add("certificate", "what a person who has passed a curriculum can show", cmd_people_certificate)}) {
    command->add_option("pseudonym", o->pseudonym, "of the person")->required();
    command->add_option("curriculum", o->curriculum, "its file")->required();
    command->add_flag("--json", o->json, "as JSON");
  }

  auto* curricula = add("curricula", "the curricula that a person may follow", cmd_curricula);
  curricula->add_flag("--json", o->json, "all about them, as JSON");
  curricula->add_option("-o,--output", o->output, "file to write the JSON to");

  auto* exported = add("export", "tables of persons, runs, metrics and faults, or statements", cmd_people_export);
  exported->add_option("-o,--output", o->output, "folder to write tables to");
  exported->add_option("--xapi", o->xapi, "file to write statements of the Experience API to, as JSON");
  exported->add_option("--person", o->pseudonym, "only this one (default: all, and guests)");
  exported->add_option("--format", o->format, "one file for each table")
      ->check(CLI::IsMember({"csv", "json"}))
      ->capture_default_str();

  auto* send = add("send", "send attempts to a learning record store, or say what waits", cmd_people_send);
  add_record_store(*send, o->records, "");
  send->add_flag("--watch", o->watch, "go on until Ctrl-C, and send what is new")->needs("--lrs");
  send->add_flag("--all", o->queue_all, "queue also what was refused, and runs of before there was a queue");
  send->add_option("--home-page", o->home_page,
                   "address of this installation, to which its accounts belong (default: one drawn at random)");

  auto* forget = add("forget", "remove a person with all runs, recordings and reports", cmd_people_forget);
  forget->add_option("pseudonym", o->pseudonym, "of the person")->required();
  forget->add_option("--folder", o->folders,
                     "folder that is searched for recordings and reports; may be given several times (default: those "
                     "of play)");

  add("backup", "copy the training store into one file, also while it is in use", cmd_people_backup)
      ->add_option("file", o->output, "file to write")
      ->required();
}

}  // namespace insula
