// SPDX-License-Identifier: GPL-3.0-or-later
// The step.
#include "core/sim/simulation.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>

#include "core/scene/loader.h"

namespace insula {
namespace {

class StageClock {
 public:
  explicit StageClock(StepReport& r) : report_(r), start_(now()), last_(start_) {}
  void done(Stage s) {
    const auto t = now();
    report_.stage_ms[s] = ms(last_, t);
    last_ = t;
  }
  double total() const { return ms(start_, last_); }

 private:
  using Time = std::chrono::steady_clock::time_point;
  static Time now() { return std::chrono::steady_clock::now(); }
  static double ms(Time a, Time b) { return std::chrono::duration<double, std::milli>(b - a).count(); }
  StepReport& report_;
  Time start_, last_;
};

constexpr int steps_with_newton_soon = 15;  ///< after one whose sweeps stalled; then they are tried again
constexpr int most_passes = 3;  ///< of defect correction

}  // namespace

void StepReport::clear() {
  contacts.clear();
  strands.clear();
  tools.clear();
  vessels.clear();
  bleeding.clear();
  clips.clear();
  heart_phase = 0;
  events.clear();
  strands_total = strands_left = 0;
  rows = 0;
  solve = {};
  solver = {};
  defect_m = 0;
  stage_ms.fill(0);
  step_ms = 0;
  finite = true;
}

Simulation::Simulation(std::unique_ptr<Scene> scene, Diagnostics& diagnostics, int threads)
    : scene_(std::move(scene)), workers_(threads) {
  PrepareContext prepare{diagnostics, scene_->time_step()};
  bodies_ = scene_->all<Body>();
  instruments_ = scene_->all<Instrument>();
  surfaces_ = scene_->all<Surface>();
  constraints_ = scene_->all<Constraint>();
  for (std::size_t i = 0; i < bodies_.size(); ++i) bodies_[i]->index = int(i);
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
  if (auto s = scene_->all<SettleSettings>(); !s.empty()) settle_time_ = s.front()->time();
  for (Body* b : bodies_) b->connect(prepare);
  if (diagnostics.ok()) {
    for (Constraint* c : constraints_) c->connect(prepare, *this);
    for (Instrument* i : instruments_) i->join(prepare, *this);
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
  heavy_first_ = bodies_;
  std::stable_sort(heavy_first_.begin(), heavy_first_.end(), [](Body* a, Body* b) { return a->blocks() > b->blocks(); });
  parts_.reserve(8 * bodies_.size());
  builder_ = std::make_unique<ConstraintBuilder>(problem_, bodies_);
  context_.h = scene_->time_step();
  context_.gravity = scene_->gravity();
  context_.events = &sink_;
  if (diagnostics.ok() && settle_time_ > 0) settle(diagnostics);
}

Simulation::~Simulation() = default;

Instrument* Simulation::instrument_of(int hand) const {
  for (Instrument* i : instruments_)
    if (i->hand_index() == hand && i->active()) return i;
  return nullptr;
}

void Simulation::set_hand(int hand, const HandState& state) {
  if (Instrument* i = instrument_of(hand)) i->set_hand(state);
}

void Simulation::step() {
  report_.clear();
  sink_.clear();
  events_.clear();
  if (complications_ && context_.step >= 0) complications_->act(*this);
  for (Event& e : commanded_) sink_.emit(std::move(e));
  commanded_.clear();
  StageClock clock(report_);

  workers_.run(int(heavy_first_.size()), [this](int i) {
    if (Body* b = heavy_first_[std::size_t(i)]; b->active()) b->free_motion(context_);
  });
  clock.done(stage_free_motion);

  workers_.run(int(surfaces_.size()), [this](int i) {
    surfaces_[std::size_t(i)]->update();
    surfaces_[std::size_t(i)]->look_ahead();
  });
  for (Constraint* c : constraints_) c->detect(context_);
  clock.done(stage_collision);

  builder_->clear();
  for (Constraint* c : constraints_) c->build(context_, *builder_);
  for (Body* b : bodies_)
    if (b->active()) b->build(context_, *builder_);
  builder_->finish();
  workers_.run(int(heavy_first_.size()), [this](int i) {
    Body* b = heavy_first_[std::size_t(i)];
    b->begin_compliance(b->rows);
  });
  for (const ComplianceAct act : compliance_acts) {
    parts_.clear();
    for (Body* b : heavy_first_)
      for (int p = 0; p < b->compliance_parts(act); ++p) parts_.emplace_back(b, p);
    workers_.run(int(parts_.size()), [&](int i) { parts_[std::size_t(i)].first->compliance_part(act, parts_[std::size_t(i)].second); });
  }
  for (Body* b : bodies_) b->add_compliance(b->rows, problem_.w.data(), problem_.stride);
  clock.done(stage_build);

  warm_start();
  workspace_.reserve(problem_.rows, solve_settings_.max_newton > 0);
  workspace_.lambda.assign(problem_.lambda.begin(), problem_.lambda.end());
  solve_settings_.newton_soon = newton_soon_ > 0;
  report_.solve = solve(problem_, problem_.delta_free, solve_settings_, workspace_);
  defect_.begin(problem_, bodies_);
  for (int pass = 0; defect_.needed() && pass < most_passes; ++pass) {
    report_.defect_m = defect_.pass(problem_, workspace_.lambda.data(), workers_);
    if (report_.defect_m <= solve_settings_.tolerance_m) break;
    const int sweeps = report_.solve.sweeps;
    report_.solve = solve(problem_, problem_.delta_free, solve_settings_, workspace_);
    report_.solve.sweeps += sweeps;
  }
  problem_.lambda.assign(workspace_.lambda.begin(), workspace_.lambda.end());
  if (newton_soon_ > 0) --newton_soon_;
  else if (report_.solve.stalled) newton_soon_ = steps_with_newton_soon;
  clock.done(stage_solve);

  // The haptic problem wants the tools' terms of this step, before they move.
  std::size_t hands = 0;
  for (Instrument* i : instruments_)
    if (i->hand_index() >= 0 && i->active()) ++hands;
  problem_.tools.resize(hands);
  hands = 0;
  for (Instrument* i : instruments_)
    if (i->hand_index() >= 0 && i->active()) i->fill_terms(problem_.tools[hands++], problem_.rows);
  workers_.run(int(heavy_first_.size()), [this](int i) {
    Body* b = heavy_first_[std::size_t(i)];
    if (b->active()) b->apply(context_, b->rows, workspace_.lambda.data());
  });
  const ConstraintSolution solution{problem_, workspace_.lambda.data(), workspace_.delta.data()};
  for (Constraint* c : constraints_) c->finish(context_, solution);
  for (Body* b : bodies_)
    if (b->active()) b->finish(context_, solution);
  remember_solution();
  clock.done(stage_correct);

  context_.time += context_.h;
  ++context_.step;
  make_report();
  clock.done(stage_publish);
  report_.step_ms = clock.total();
}

void Simulation::warm_start() {
  for (const Block& b : problem_.blocks) {
    const auto at = std::lower_bound(remembered_.begin(), remembered_.end(), b.id,
                                     [](const Remembered& r, std::uint64_t id) { return r.id < id; });
    if (at == remembered_.end() || at->id != b.id || at->rows != b.rows()) continue;
    for (int k = 0; k < b.rows(); ++k) problem_.lambda[std::size_t(b.row + k)] = at->lambda[std::size_t(k)];
  }
}

void Simulation::remember_solution() {
  remembered_.clear();
  for (const Block& b : problem_.blocks) {
    Remembered r{b.id, b.rows(), {}};
    for (int k = 0; k < b.rows(); ++k) r.lambda[std::size_t(k)] = workspace_.lambda[std::size_t(b.row + k)];
    remembered_.push_back(r);
  }
  std::sort(remembered_.begin(), remembered_.end(), [](const Remembered& a, const Remembered& b) { return a.id < b.id; });
}

void Simulation::make_report() {
  StepReport& r = report_;
  r.time = context_.time;
  r.h = context_.h;
  r.step = context_.step;
  r.rows = problem_.rows;
  r.finite = std::isfinite(r.solve.residual_N);
  for (const Body* b : bodies_) {
    r.finite = r.finite && b->finite();
    const SolverStatus s = b->solver_status();
    r.solver.age = std::max(r.solver.age, s.age);
    r.solver.iterations = std::max(r.solver.iterations, s.iterations);
    r.solver.residual_m = std::max(r.solver.residual_m, s.residual_m);
    r.solver.factors += s.factors;
  }
  for (Constraint* c : constraints_) c->report(r);
  for (const Body* b : bodies_) b->report(r);
  for (Instrument* i : instruments_) {
    if (!i->active()) continue;
    ToolReport t;
    t.tool = i;
    t.hand = i->hand_index();
    t.hand_force = i->hand_force();
    Vec3 sum = Vec3::Zero();
    for (const ContactPoint& c : r.contacts) {
      if (c.a == i) sum += c.normal_force * c.normal + c.tangent_force;
      if (c.b == i) sum -= c.normal_force * c.normal + c.tangent_force;
    }
    t.contact_force = sum.norm();
    r.tools.push_back(t);
  }
  r.events = sink_.events();
  events_ = sink_.events();
  if (exercise_) {
    exercise_->log().events.clear();
    exercise_->observe(r);
    const auto& said = exercise_->log().events.events();
    events_.insert(events_.end(), said.begin(), said.end());
  }
}

void Simulation::reset() {
  for (Body* b : bodies_) b->reset();
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
    Diagnostics none;  // the same as at the start, where they were reported
    settle(none);
  }
}

double Simulation::energy() const {
  double sum = 0;
  for (const Body* b : bodies_) sum += b->energy();
  return sum;
}

void Simulation::may_wait(bool yes) {
  for (Body* b : bodies_) b->may_wait(yes);
}

void Simulation::draw_complications(std::uint64_t seed) {
  complication_seed_ = seed;
  if (complications_) complications_->draw(seed, *this);
}

// The exercise sees nothing of it, and time is negative until it begins.
void Simulation::settle(Diagnostics& diagnostics) {
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
  PrepareContext prepare{diagnostics, context_.h};
  for (Constraint* c : constraints_) c->settled(prepare);
  context_.time = 0;
  context_.step = 0;
  events_.clear();
  sink_.clear();
  report_.events.clear();
}

std::uint64_t Simulation::state_hash() const {
  std::vector<double> state;
  for (Body* b : bodies_) b->append_state(state);
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

SimulationResult load_simulation(const std::filesystem::path& file, const Registry& registry, int threads) {
  return connect(load_scene(file, registry), threads);
}

SimulationResult load_simulation_text(std::string_view text, const std::filesystem::path& virtual_path, const Registry& registry, int threads) {
  return connect(load_scene_text(text, virtual_path, registry), threads);
}

}  // namespace insula
