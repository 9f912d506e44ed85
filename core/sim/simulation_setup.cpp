// SPDX-License-Identifier: GPL-3.0-or-later
// Construction, settling, queries and reset of a simulation.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <utility>

#include "core/linalg/inexact_solver.h"
#include "core/mechanics/deformable_body.h"
#include "core/scene/loader.h"
#include "core/sim/simulation.h"

namespace insula {
namespace {

/// Null for a body with an exact solver or none.
InexactSolver* inexact_solver_of(DynamicBody& body) {
  BodySolver* solver = body.solver();
  return solver ? solver->inexact() : nullptr;
}

}  // namespace

Simulation::Simulation(std::unique_ptr<Scene> scene, Diagnostics& diagnostics, int threads)
    : scene_(std::move(scene)), workers_(threads) {
  PrepareContext prepare{diagnostics, scene_->time_step()};
  bodies_ = scene_->all<Body>();
  dynamic_bodies_ = scene_->all<DynamicBody>();
  instruments_ = scene_->all<Instrument>();
  surfaces_ = scene_->all<Surface>();
  constraints_ = scene_->all<Constraint>();
  for (std::size_t i = 0; i < bodies_.size(); ++i) bodies_[i]->index = int(i);
  structure_forces_ = std::make_unique<StructureForces>(bodies_);
  report_.structures = structure_forces_->none();
  if (auto s = scene_->all<SolverSettings>(); !s.empty()) {
    solve_settings_.max_sweeps = s.front()->max_sweeps();
    solve_settings_.tolerance_m = s.front()->tolerance();
    solve_settings_.conjugate = s.front()->conjugate();
    solve_settings_.max_newton = s.front()->newton();
  }
  if (auto v = scene_->all<ViewSettings>(); !v.empty()) view_ = v.front();
  // A hand begins with its first tool; the others lie on the tray.
  std::array<bool, 2> full{};
  for (Instrument* i : instruments_) {
    const int hand = i->hand_index();
    if (hand < 0) continue;
    i->start_in_hand(!full[std::size_t(hand)]);
    full[std::size_t(hand)] = true;
  }
  if (auto s = scene_->all<SettleSettings>(); !s.empty()) {
    settle_time_ = s.front()->time();
    settle_step_ = s.front()->time_step();
  }
  for (DeformableBody* b : scene_->all<DeformableBody>()) b->connect(prepare);
  if (diagnostics.ok()) {
    for (Constraint* c : constraints_) c->connect(prepare, *this);
    for (Instrument* i : instruments_) i->join(prepare, *this);
    collect_step_data();
    for (Constraint* c : constraints_) c->find_channels(prepare, *this);
    if (auto e = scene_->all<Exercise>(); !e.empty()) {
      exercise_ = e.front();
      exercise_->connect(prepare, *this);
    }
    if (auto c = scene_->all<Complications>(); !c.empty()) {
      complications_ = c.front();
      complications_->connect(prepare, *this);
      complications_->draw(0, *this);
    }
  }
  heavy_first_ = dynamic_bodies_;
  std::stable_sort(heavy_first_.begin(), heavy_first_.end(),
                   [](DynamicBody* a, DynamicBody* b) { return a->blocks() > b->blocks(); });
  parts_.reserve(8 * bodies_.size());
  inputs_.reserve(16);
  coming_.reserve(16);
  builder_ = std::make_unique<ConstraintBuilder>(problem_, bodies_);
  context_.h = scene_->time_step();
  context_.gravity = scene_->gravity();
  context_.events = &sink_;
  if (diagnostics.ok() && settle_time_ > 0) settle(diagnostics);
  if (diagnostics.ok()) publish();
}

void Simulation::collect_step_data() {
  channel_table_.collect(scene_->components());
  report_.channel_table = &channel_table_;
  for (Component* c : scene_->components()) {
    for (const DrawableBase* d : c->drawables()) drawables_.push_back({c, d});
    if (!c->channels().empty() || !c->drawables().empty()) publishers_.push_back(c);
  }
}

double Simulation::channel(std::string_view id) const {
  const ChannelEntry* e = channel_table_.find(id);
  if (!e) throw std::out_of_range("the scene has no channel " + std::string(id));
  return *e->channel->values(e->item);
}

Simulation::~Simulation() = default;

Instrument* Simulation::instrument_of(int hand) const {
  for (Instrument* i : instruments_)
    if (i->hand_index() == hand && i->active()) return i;
  return nullptr;
}

/// An input for the recording of the coming step. What components do within a step is none.
SimulationInput& Simulation::note(SimulationInput::Kind kind, int index) {
  coming_.emplace_back();
  coming_.back().kind = kind;
  coming_.back().index = index;
  return coming_.back();
}

void Simulation::set_hand(int hand, const HandState& state) {
  note(SimulationInput::Kind::hand, hand).hand = state;
  if (Instrument* i = instrument_of(hand)) i->set_hand(state);
}

void Simulation::set_collision_horizon(double seconds) {
  note(SimulationInput::Kind::horizon).seconds = seconds;
  context_.collision_horizon_s = seconds;
}

void Simulation::give(const SimulationInput& input) {
  using InputKind = SimulationInput::Kind;
  switch (input.kind) {
    case InputKind::hand: return set_hand(input.index, input.hand);
    case InputKind::command: command(input.verb, input.argument); return;
    case InputKind::complications: return draw_complications(input.seed);
    case InputKind::horizon: return set_collision_horizon(input.seconds);
    case InputKind::reset: return reset();
    case InputKind::factor: break;
  }
  if (input.index < 0 || input.index >= int(dynamic_bodies_.size())) return;
  if (InexactSolver* s = inexact_solver_of(*dynamic_bodies_[std::size_t(input.index)])) s->take_next();
}

void Simulation::repeat_factors() {
  timing_ = FactorTiming::told;
  set_timing(timing_);
}

void Simulation::reset() {
  note(SimulationInput::Kind::reset);
  for (DynamicBody* b : dynamic_bodies_) b->reset();
  for (Surface* s : surfaces_) s->update();
  for (Constraint* c : constraints_) c->reset();
  if (exercise_) exercise_->reset();
  if (complications_) complications_->draw(complication_seed_, *this);
  remembered_.clear();
  newton_soon_ = 0;
  commanded_.clear();
  context_.time = 0;
  context_.step = 0;
  problem_.resize(0);
  problem_.blocks.clear();
  problem_.tools.clear();
  report_.clear();
  report_.time = 0;
  report_.step = 0;
  events_.clear();
  sink_.clear();
  if (settle_time_ > 0) {
    Diagnostics none;  // the same messages as at the start, where they were reported
    settle(none);
  }
  for (const ChannelEntry& e : channel_table_.entries()) const_cast<ChannelBase*>(e.channel)->reset();
  publish();
}

double Simulation::energy() const {
  double sum = 0;
  for (const DynamicBody* b : dynamic_bodies_) sum += b->energy();
  return sum;
}

void Simulation::set_deterministic(bool yes) {
  timing_ = yes ? FactorTiming::counted : FactorTiming::when_ready;
  set_timing(timing_);
}

void Simulation::set_timing(FactorTiming timing) {
  for (DynamicBody* b : dynamic_bodies_)
    if (InexactSolver* s = inexact_solver_of(*b)) s->set_timing(timing);
}

void Simulation::note_factors() {
  for (std::size_t i = 0; i < dynamic_bodies_.size(); ++i)
    if (InexactSolver* s = inexact_solver_of(*dynamic_bodies_[i]); s && s->took())
      note(SimulationInput::Kind::factor, int(i));
}

void Simulation::draw_complications(std::uint64_t seed) {
  note(SimulationInput::Kind::complications).seed = seed;
  complication_seed_ = seed;
  if (complications_) complications_->draw(seed, *this);
}

// The exercise does not observe these steps. Time is negative until it begins. They have the same bits every time.
void Simulation::settle(Diagnostics& diagnostics) {
  settling_ = true;
  set_timing(FactorTiming::counted);
  const double run_step = std::exchange(context_.h, settle_step_);
  const int n = int(std::ceil(settle_time_ / context_.h - 1e-9));
  Exercise* const exercise = exercise_;
  exercise_ = nullptr;
  context_.step = -n;
  for (int i = 0; i < n; ++i) {
    context_.time = double(i - n) * context_.h;
    step();
  }
  exercise_ = exercise;
  for (Surface* s : surfaces_) s->update();
  context_.h = run_step;
  PrepareContext prepare{diagnostics, run_step};
  for (Constraint* c : constraints_) c->settled(prepare);
  context_.time = 0;
  context_.step = 0;
  events_.clear();
  sink_.clear();
  report_.events.clear();
  set_timing(timing_);
  settling_ = false;
}

void Simulation::body_sums(std::vector<double>& sums) const {
  sums.clear();
  for (DynamicBody* b : dynamic_bodies_) {
    state_scratch_.clear();
    b->append_state(state_scratch_);
    double sum = 0;
    for (double d : state_scratch_) sum += d;
    sums.push_back(sum);
  }
}

std::uint64_t Simulation::state_hash() const {
  std::vector<double>& state = state_scratch_;
  state.clear();
  for (DynamicBody* b : dynamic_bodies_) b->append_state(state);
  for (Constraint* c : constraints_) c->append_state(state);
  std::uint64_t hash = 14695981039346656037ull;
  for (double d : state) {
    std::uint64_t bits;
    std::memcpy(&bits, &d, 8);
    for (int k = 0; k < 8; ++k) {
      hash ^= (bits >> (8 * k)) & 0xff;
      hash *= 1099511628211ull;
    }
  }
  return hash;
}

namespace {
SimulationResult connect(LoadResult loaded, int threads) {
  SimulationResult out;
  out.diagnostics = std::move(loaded.diagnostics);
  if (!loaded.scene) return out;
  auto simulation = std::make_unique<Simulation>(std::move(loaded.scene), out.diagnostics, threads);
  if (out.diagnostics.ok()) out.simulation = std::move(simulation);
  return out;
}
}  // namespace

SimulationResult load_simulation(const std::filesystem::path& file, const Registry& registry, int threads,
                                 double time_step_s) {
  return connect(load_scene(file, registry, time_step_s), threads);
}

SimulationResult load_simulation_text(std::string_view text, const std::filesystem::path& virtual_path,
                                      const Registry& registry, int threads) {
  return connect(load_scene_text(text, virtual_path, registry), threads);
}

}  // namespace insula
