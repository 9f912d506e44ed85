// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/live/exercise_choice.h"

#include <nlohmann/json.hpp>

#include "engine/command_line/run.h"
#include "engine/live/notice.h"
#include "engine/live/session_mode.h"

namespace insula {
namespace {

constexpr std::uint64_t largest_seed = 2147483647;  // as in curricula

}  // namespace

std::string state_json(const ChosenExercise& choice, const char* state, const std::string& text) {
  const nlohmann::ordered_json json{{"scene", choice.scene},     {"person", choice.person}, {"mode", choice.mode},
                                    {"request", choice.request}, {"state", state},          {"text", text}};
  return json.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

ExerciseChoice::ExerciseChoice(ChosenExercise present, std::filesystem::path state, Command command,
                               std::function<void(const ChosenExercise&)> taken)
    : present_(std::move(present)), state_(std::move(state)), command_(std::move(command)), taken_(std::move(taken)) {
  tell(present_, "running");
}

std::optional<ChosenExercise> read_choice(std::string_view text) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("scene") || !json.contains("person")) return std::nullopt;
  ChosenExercise out;
  const std::pair<const char*, std::string*> texts[] = {
      {"scene", &out.scene}, {"person", &out.person}, {"mode", &out.mode}, {"request", &out.request}};
  for (const auto& [name, value] : texts) {
    const auto found = json.find(name);
    if (found == json.end()) continue;
    if (!found->is_string()) return std::nullopt;
    *value = found->get<std::string>();
  }
  if (!out.mode.empty() && out.mode != name_of(SessionMode::practice) && out.mode != name_of(SessionMode::test))
    return std::nullopt;
  const auto seed = json.find("seed");
  if (seed == json.end()) return out;
  if (!seed->is_number_unsigned() || seed->get<std::uint64_t>() > largest_seed || *seed == 0) return std::nullopt;
  out.seed = seed->get<std::uint32_t>();
  return out;
}

void ExerciseChoice::ask(std::string_view text) {
  const auto choice = read_choice(text);
  if (!choice) return;
  wanted_ = *choice;
  waiting_ = true;
  tell(wanted_, "loading");
}

void ExerciseChoice::look(Supervisor& supervisor) {
  if (!waiting_) return;
  Supervisor::Offer offer;
  offer.command_after = command_(wanted_);
  offer.command = offer.command_after;
  offer.command.emplace_back("--standby");
  offer.ready_line = standby_line;
  offer.refused = [this, choice = wanted_](const auto& lines, const ChildExit& exit) {
    tell(choice, "refused", why_refused(lines, exit));
  };
  offer.taken = [this, choice = wanted_] {
    present_ = choice;
    tell(present_, "running");
    taken_(present_);
  };
  waiting_ = !supervisor.offer("engine", std::move(offer));
}

void ExerciseChoice::tell(const ChosenExercise& choice, const char* state, const std::string& text) {
  if (!state_.empty()) leave_notice(state_, state_json(choice, state, text));
}

}  // namespace insula
