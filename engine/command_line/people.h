// SPDX-License-Identifier: GPL-3.0-or-later
// The commands for persons and what they have done: people add, list, progress, export, send,
// forget, backup.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "engine/command_line/commands.h"
#include "engine/command_line/record_store_options.h"
#include "engine/command_line/run_command_line.h"
#include "training/curriculum/evaluate.h"
#include "training/store/store.h"

namespace insula {

struct PeopleOptions {
  std::filesystem::path data;                  ///< folder of the user's data; empty: the platform's
  training::Person person;                     ///< add
  std::filesystem::path curriculum;            ///< progress, certificate
  std::string pseudonym;                       ///< progress, certificate, forget; export: only this person, empty: all
  std::filesystem::path output;                ///< export: folder; backup, curricula: file
  std::string format = "csv";                  ///< export: "csv" or "json"
  std::vector<std::filesystem::path> folders;  ///< forget: of recordings and reports; empty: those of play
  bool json = false;                           ///< list, progress, certificate, curricula
  std::filesystem::path xapi;                  ///< export: file for statements; empty: none
  RecordStoreOptions records;                  ///< send
  std::string home_page;                       ///< send: of this installation; empty: as it is
  bool watch = false, queue_all = false;       ///< send
};

/// Where a person stands in a curriculum, with the store it was read from.
struct StandingInCurriculum {
  Curriculum curriculum;
  Progress progress;
  training::Store store;
};
/// None if the curriculum has errors or the person is not known; both are printed.
std::optional<StandingInCurriculum> standing_in(const CommandContext& context, const PeopleOptions& options);

/// Status 0; 2 if the pseudonym is in use or a field is wrong.
int cmd_people_add(const CommandContext& context, const PeopleOptions& options);
/// With the number of runs and the day of the last one.
int cmd_people_list(const CommandContext& context, const PeopleOptions& options);
/// Writes persons, runs, metrics and faults as one file each, or statements of the Experience API. Status 0; 1 if one
/// cannot be written; 2 if the person is not known.
int cmd_people_export(const CommandContext& context, const PeopleOptions& options);
/// Sends what is in the outbox to a learning record store; without its address, says what is in the outbox. Status 0; 1
/// if something was not sent or was refused; 2 if an option is wrong, or, while watching, if the store does not let the
/// account in.
int cmd_people_send(const CommandContext& context, const PeopleOptions& options);
/// Removes a person with all runs, recordings and reports. Status 0, also if there is nothing; 1 if a file cannot be
/// removed.
int cmd_people_forget(const CommandContext& context, const PeopleOptions& options);
/// Says how far a person has come in a curriculum, and what is next. Status 0; 2 if the curriculum has errors or the
/// person is not known.
int cmd_people_progress(const CommandContext& context, const PeopleOptions& options);
/// Prints the certificate of a curriculum that the person has passed. Status 0; 2 if it is not passed, has errors, or
/// the person is not known.
int cmd_people_certificate(const CommandContext& context, const PeopleOptions& options);
/// Lists the curricula that may be followed, or writes all about them as JSON. One with errors does not hide the
/// others. Status 0; 1 if the file cannot be written.
int cmd_curricula(const CommandContext& context, const PeopleOptions& options);
/// Copies the store into one file, also while it is in use.
int cmd_people_backup(const CommandContext& context, const PeopleOptions& options);

/// Adds all of these commands to the program.
void add_people_commands(CommandLine& line);

}  // namespace insula
