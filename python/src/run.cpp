// SPDX-License-Identifier: GPL-3.0-or-later
// Steps, history and states of a run.
#include "python/src/run.h"

#include <fmt/format.h>

#include <stdexcept>

#include "core/base/input_error.h"
#include "engine/live/motion_start.h"
#include "python/src/byte_stream.h"

namespace insula::python {
namespace {

constexpr std::string_view magic = "insula state 1\n";

}  // namespace

std::string State::bytes() const {
  std::string out(magic);
  put(out, scene);
  put(out, step_s);
  put(out, steps);
  put(out, time_s);
  put(out, hash);
  return out + history.bytes();
}

State State::of_bytes(std::string_view bytes) {
  if (!bytes.starts_with(magic)) throw InputError("this is no saved state of Insula");
  ByteReader in(bytes.substr(magic.size()));
  State state;
  state.scene = in.take<std::uint64_t>();
  state.step_s = in.take<double>();
  state.steps = in.take<std::int64_t>();
  state.time_s = in.take<double>();
  state.hash = in.take<std::uint64_t>();
  state.history = History(std::string(in.rest()));
  return state;
}

Run::Run(std::unique_ptr<Registry> registry, std::unique_ptr<Simulation> simulation, std::vector<Diagnostic> warnings)
    : registry_(std::move(registry)), simulation_(std::move(simulation)), warnings_(std::move(warnings)) {}

Run::Turn::Turn(Run& run) : run_(run) {
  if (run.busy_.test_and_set()) throw std::runtime_error("another thread is at work in this simulation");
}

void Run::set_hand(int hand, const HandState& state) {
  if (headless_) throw std::logic_error("a motion moves the hands: call follow(None) first");
  history_.set_hand(hand, state);
  simulation_->set_hand(hand, state);
}

std::string Run::command(const std::string& verb, const std::string& argument) {
  history_.command(verb, argument);
  return simulation_->command(verb, argument);
}

void Run::follow(Motion motion) {
  if (!motion.empty() && simulation_->steps() == 0) check_start(*simulation_, motion);
  history_.follow(motion);
  motion_ = std::move(motion);
  headless_ = motion_.empty() ? nullptr : std::make_unique<HeadlessRun>(*simulation_, motion_);
}

void Run::draw_complications(std::uint64_t seed) {
  history_.draw_complications(seed);
  seed_ = seed;
  simulation_->draw_complications(seed);
}

void Run::do_step() {
  if (headless_) headless_->step();
  else simulation_->step();
  history_.step();
}

void Run::step() {
  do_step();
  const std::vector<Event>& events = simulation_->events();
  events_.insert(events_.end(), events.begin(), events.end());
  if (!simulation_->report().finite)
    throw std::runtime_error(fmt::format("the simulation left the range of numbers at {:.3f} s", simulation_->time()));
}

void Run::reset() {
  history_.clear();
  events_.clear();
  if (headless_) headless_->reset();
  else simulation_->reset();
  if (seed_) history_.draw_complications(*seed_);
  if (headless_) history_.follow(motion_);
}

State Run::save() const {
  const Simulation& s = *simulation_;
  return {s.scene().content_hash(), s.h(), s.steps(), s.time(), s.state_hash(), history_};
}

void Run::restore(const State& state) {
  if (state.scene != simulation_->scene().content_hash()) throw InputError("the state belongs to another scene");
  if (state.step_s != simulation_->h()) throw InputError("the state has another time step");
  std::size_t done = history_.bytes().size();
  if (!history_.begins(state.history)) {
    headless_.reset();
    motion_ = {};
    if (seed_) simulation_->draw_complications(0);
    seed_.reset();
    reset();
    done = 0;
  }
  events_.clear();
  state.history.replay(
      {.set_hand = [this](int hand, const HandState& s) { set_hand(hand, s); },
       .command = [this](const std::string& verb, const std::string& argument) { command(verb, argument); },
       .draw_complications = [this](std::uint64_t seed) { draw_complications(seed); },
       .follow = [this](Motion motion) { follow(std::move(motion)); },
       .step = [this] { do_step(); }},
      done);
  if (simulation_->state_hash() != state.hash)
    throw InputError("the state is reached with other bits: it was saved by another version or instruction set");
}

}  // namespace insula::python
