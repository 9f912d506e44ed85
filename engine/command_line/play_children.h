// SPDX-License-Identifier: GPL-3.0-or-later
// The processes of `insula play`: how each is started, and what the gateway says on its standard output.
#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "engine/command_line/play.h"
#include "engine/live/exercise_choice.h"
#include "engine/live/supervisor.h"

namespace insula {

/// Files by which the start page learns what there is and what runs; empty: it has none.
struct StartPageFiles {
  std::filesystem::path catalogue;  ///< catalogue_json()
  std::filesystem::path choice;     ///< state_json()
  std::filesystem::path curricula;  ///< curriculum_list_json(); written when a page asks for it
};

/// What is done with the gateway's lines.
struct GatewayLines {
  std::function<void(const std::string& url, bool first)> serving;  ///< first: not after a restart
  std::function<void(std::string_view json)> chosen;                ///< ExerciseChoice::ask()
  std::function<void()> curricula;                                  ///< a page wants the list of curricula
};

ChildSpec engine_child(const PlayOptions& options, const std::filesystem::path& program,
                       const std::filesystem::path& bundles);
ChildSpec haptic_child(const PlayOptions& options, const std::filesystem::path& folder);
/// pins: file of write_pins(); empty: none.
ChildSpec gateway_child(const PlayOptions& options, const std::filesystem::path& folder, const StartPageFiles& files,
                        const std::filesystem::path& pins, const GatewayLines& lines);

/// Sends what persons do to the learning record store of the options. The session goes on without it.
ChildSpec sender_child(const PlayOptions& options, const std::filesystem::path& program);

/// The options for another exercise or person. A motion and bands belong to the first scene. Mode and seed are those of
/// the choice; without a mode, it is chosen on the page.
PlayOptions chosen_options(const PlayOptions& first, const ChosenExercise& choice);
/// Of the session's fields; empty: a guest.
std::string person_of(const PlayOptions& options);

}  // namespace insula
