// SPDX-License-Identifier: GPL-3.0-or-later
// The step. The start and the reset are in simulation_setup.cpp.
#include "core/sim/simulation.h"

#include <algorithm>
#include <chrono>
#include <cmath>

#include "core/linalg/inexact_solver.h"

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

constexpr int steps_with_newton_soon = 15;  ///< steps with early Newton after a stall; then sweeps are tried again
constexpr int max_passes = 3;               ///< of defect correction

}  // namespace

void StepReport::clear() {
  contacts.clear();
  tools.clear();
  for (StructureForce& s : structures) s.of_hand = {Vec3::Zero(), Vec3::Zero()};
  events.clear();
  rows = 0;
  solve = {};
  solver = {};
  defect_m = 0;
  stage_ms.fill(0);
  step_ms = 0;
  finite = true;
}

void Simulation::step() {
  report_.clear();
  sink_.clear();
  events_.clear();
  stepping_ = true;
  if (complications_ && context_.step >= 0) complications_->act(*this);
  for (Event& e : commanded_) sink_.emit(std::move(e));
  commanded_.clear();
  StageClock clock(report_);
  move_freely();
  clock.done(stage_free_motion);
  detect();
  clock.done(stage_collision);
  build();
  compute_compliance();
  clock.done(stage_build);
  solve_rows();
  clock.done(stage_solve);
  correct_motion();
  clock.done(stage_correct);
  context_.time += context_.h;
  ++context_.step;
  make_report();
  stepping_ = false;
  if (!settling_) {
    note_factors();
    inputs_.swap(coming_);
    coming_.clear();
  }
  clock.done(stage_publish);
  report_.step_ms = clock.total();
}

void Simulation::move_freely() {
  workers_.run(int(heavy_first_.size()), [this](int i) {
    if (DynamicBody* b = heavy_first_[std::size_t(i)]; b->active()) b->free_motion(context_);
  });
}

void Simulation::detect() {
  workers_.run(int(surfaces_.size()), [this](int i) { surfaces_[std::size_t(i)]->update_collision(); });
  for (Constraint* c : constraints_) c->detect(context_);
}

void Simulation::build() {
  builder_->clear();
  for (Constraint* c : constraints_) {
    builder_->set_owner(*c);
    c->build(context_, *builder_);
  }
  for (DynamicBody* b : dynamic_bodies_)
    if (b->active()) {
      builder_->set_owner(*b);
      b->build(context_, *builder_);
    }
  builder_->finish();
}

void Simulation::compute_compliance() {
  workers_.run(int(heavy_first_.size()), [this](int i) {
    DynamicBody* b = heavy_first_[std::size_t(i)];
    b->begin_compliance(b->rows);
  });
  for (const ComplianceAct act : compliance_acts) {
    parts_.clear();
    for (DynamicBody* b : heavy_first_)
      if (BodySolver* s = b->solver())
        for (int p = 0; p < s->compliance_parts(act); ++p) parts_.emplace_back(s, p);
    workers_.run(int(parts_.size()),
                 [&](int i) { parts_[std::size_t(i)].first->compliance_part(act, parts_[std::size_t(i)].second); });
  }
  for (DynamicBody* b : dynamic_bodies_)
    b->add_response(b->rows, problem_.w.data(), problem_.stride, problem_.delta_free.data());
}

void Simulation::solve_rows() {
  warm_start();
  workspace_.reserve(problem_.rows, solve_settings_.max_newton > 0);
  workspace_.lambda.assign(problem_.lambda.begin(), problem_.lambda.end());
  solve_settings_.newton_soon = newton_soon_ > 0;
  defect_.begin(problem_, dynamic_bodies_);
  report_.solve = solve(problem_, problem_.delta_free, solve_settings_, workspace_);
  for (int pass = 0; defect_.needed() && pass < max_passes; ++pass) {
    report_.defect_m = defect_.pass(problem_, workspace_.lambda.data(), workers_);
    if (report_.defect_m <= solve_settings_.tolerance_m) break;
    const int sweeps = report_.solve.sweeps;
    report_.solve = solve(problem_, problem_.delta_free, solve_settings_, workspace_);
    report_.solve.sweeps += sweeps;
  }
  problem_.lambda.assign(workspace_.lambda.begin(), workspace_.lambda.end());
  if (newton_soon_ > 0) --newton_soon_;
  else if (report_.solve.stalled) newton_soon_ = steps_with_newton_soon;
}

void Simulation::correct_motion() {
  // The haptic problem needs the tools' terms of this step before the tools move.
  std::size_t hands = 0;
  for (Instrument* i : instruments_)
    if (i->hand_index() >= 0 && i->active()) ++hands;
  problem_.tools.resize(hands);
  hands = 0;
  for (Instrument* i : instruments_)
    if (i->hand_index() >= 0 && i->active()) i->fill_terms(problem_.tools[hands++], problem_.rows);
  workers_.run(int(heavy_first_.size()), [this](int i) {
    DynamicBody* b = heavy_first_[std::size_t(i)];
    if (b->active()) b->apply(context_, b->rows, workspace_.lambda.data());
  });
  problem_.step_s = context_.h;
  for (const DynamicBody* b : dynamic_bodies_)
    if (b->active()) b->add_rate(b->rows, problem_.rate.data());
  const ConstraintSolution solution{problem_, workspace_.lambda.data(), workspace_.delta.data()};
  for (Constraint* c : constraints_) c->finish(context_, solution);
  for (DynamicBody* b : dynamic_bodies_)
    if (b->active()) b->finish(context_, solution);
  remember_solution();
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
  std::sort(remembered_.begin(), remembered_.end(),
            [](const Remembered& a, const Remembered& b) { return a.id < b.id; });
}

void Simulation::publish() {
  for (Component* c : publishers_) c->publish();
  channel_table_.read(report_.channels);
}

void Simulation::report_tool(const Instrument& tool) {
  ToolReport t;
  t.tool = &tool;
  t.hand = tool.hand_index();
  t.hand_force = tool.hand_force();
  const auto carries = [&](const Body* body) {
    if (body == &tool) return true;
    const auto* rigid = dynamic_cast<const RigidBody*>(body);
    return rigid && rigid->held_by() == &tool;
  };
  Vec3 sum = Vec3::Zero();
  for (const ContactPoint& c : report_.contacts) {
    const bool a = carries(c.a), b = carries(c.b);
    if (a == b) continue;
    sum += (a ? 1.0 : -1.0) * (c.normal_force * c.normal + c.tangent_force);
  }
  t.contact_force = sum.norm();
  report_.tools.push_back(t);
}

void Simulation::report_hands() {
  report_.hands.fill({});
  for (const ToolReport& t : report_.tools) {
    if (t.hand < 0) continue;
    const auto& tool = static_cast<const Instrument&>(*t.tool);
    const HandState& state = tool.state();
    HandReport& h = report_.hands[std::size_t(t.hand)];
    h.present = state.present;
    h.tool = &tool;
    h.device = tool.device();
    h.tip = tool.pose();
    h.button = {state.button1, state.button2};
    h.contact_force = t.contact_force;
  }
}

void Simulation::make_report() {
  StepReport& r = report_;
  r.time = context_.time;
  r.h = context_.h;
  r.step = context_.step;
  r.rows = problem_.rows;
  r.finite = std::isfinite(r.solve.residual_N);
  for (DynamicBody* b : dynamic_bodies_) {
    r.finite = r.finite && b->finite();
    InexactSolver* inexact = b->solver() ? b->solver()->inexact() : nullptr;
    if (!inexact) continue;
    const SolverStatus s = inexact->status();
    r.solver.age = std::max(r.solver.age, s.age);
    r.solver.iterations = std::max(r.solver.iterations, s.iterations);
    r.solver.residual_m = std::max(r.solver.residual_m, s.residual_m);
    r.solver.factors += s.factors;
  }
  for (Constraint* c : constraints_) c->report(r);
  structure_forces_->read(problem_, r.contacts, r.structures);
  publish();
  for (Instrument* i : instruments_)
    if (i->active()) report_tool(*i);
  report_hands();
  r.events = sink_.events();
  events_ = sink_.events();
  if (exercise_) {
    exercise_->log().events.clear();
    exercise_->observe(r);
    channel_table_.read(r.channels);  // with the measures that rules have set
    exercise_->observe_metrics(r);
    const auto& said = exercise_->log().events.events();
    events_.insert(events_.end(), said.begin(), said.end());
  }
}

}  // namespace insula
