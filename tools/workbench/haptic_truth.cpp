// SPDX-License-Identifier: GPL-3.0-or-later
// Reference, recording, replay, comparison.
#include "tools/workbench/haptic_truth.h"

#include <fmt/ostream.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "core/base/input_error.h"
#include "core/base/random.h"
#include "core/haptics/condense.h"
#include "core/haptics/contact_frame_prediction.h"
#include "core/haptics/haptic_update.h"
#include "core/haptics/surface_patch_builder.h"
#include "engine/live/command_script.h"
#include "engine/live/exchange_pause.h"
#include "engine/live/publisher.h"

namespace insula {
namespace {

constexpr double tick_s = 1e-3;
constexpr double rendered_N = 1e-6;
constexpr double onset_share = 0.02;  // of the peak: from here on there is contact
constexpr double onset_least_N = 0.5e-3;
constexpr double quiet_share =
    0.25;  // of that threshold: from below it, a force that only creeps over the threshold is no onset
constexpr int quiet_ticks = 50;  // without contact before an onset, and most that it takes

/// Steps a simulation with the devices on the motion's path.
class Driven {
 public:
  Driven(Simulation& simulation, const Motion& motion)
      : simulation_(simulation), motion_(motion), script_(motion.commands()) {}
  void step() {
    const double end = simulation_.time() + simulation_.h();
    for (int hand = 0; hand < 2; ++hand) {
      if (!motion_.has(hand)) continue;
      const HandSample at = motion_.at(hand, end);
      simulation_.set_hand(hand, {true, at.pose, at.button1, at.button2});
    }
    script_.advance(simulation_);
    simulation_.step();
    for (const Event& e : simulation_.events())  // or another tool than the motion's would be measured, unnoticed
      if (e.kind == "refused")
        throw InputError(
            fmt::format("at {:.3f} s of the motion, with a step of {:.3g} ms, its command \"{}\" is refused: {}; give "
                        "it at 0 s, before the hand has gone anywhere",
                        end - simulation_.h(), 1e3 * simulation_.h(), e.id, e.text));
  }
  Vec3 force(int hand) const {
    const Instrument* tool = simulation_.instrument_of(hand);
    return tool ? Vec3(tool->hand_force().head<3>()) : Vec3(Vec3::Zero());
  }

 private:
  Simulation& simulation_;
  const Motion& motion_;
  CommandScript script_;
};

void keep_diagonal(ConstraintProblem& p) {
  for (int i = 0; i < p.rows; ++i)
    for (int j = 0; j < p.rows; ++j)
      if (i != j) p.w[std::size_t(i) * std::size_t(p.stride) + std::size_t(j)] = 0;
}

/// What new problems change, told from what the servo changes by itself: another servo beside it, which takes each
/// problem over at once, after a last tick with the old one.
class JumpMeter {
 public:
  explicit JumpMeter(ServoSettings settings) : own_((settings.force_crossfade.within_s = 0, settings)) {}
  void tick(const RecordedStep* fresh, double age_s, const ServoInput& input, const ServoResult& rendered,
            ForceTrace& out) {
    ServoResult now = own_.tick(input);
    const ServoResult went_on = now;
    if (fresh) {
      own_.set_problem(&fresh->update.problem, fresh->update.offset, age_s);
      now = own_.tick(input);
    }
    for (std::size_t i = 0; i < 2; ++i) {
      const Vec3 &own = now.hand[i].force, &force = rendered.hand[i].force;
      if (!own.isZero(0) && !last_own_[i].isZero(0) && !force.isZero(0) && !last_[i].isZero(0))
        out.jump[i] = std::max(out.jump[i], (force - last_[i]).norm() - (went_on.hand[i].force - last_own_[i]).norm());
      last_own_[i] = own;
      last_[i] = force;
    }
  }

 private:
  Servo own_;
  std::array<Vec3, 2> last_{Vec3::Zero(), Vec3::Zero()}, last_own_{Vec3::Zero(), Vec3::Zero()};
};

}  // namespace

ForceTrace reference_forces(Simulation& simulation, const Motion& motion, double duration_s) {
  ForceTrace out;
  Driven driven(simulation, motion);
  for (const long n = std::lround(duration_s / tick_s); simulation.steps() < n;) {
    driven.step();
    out.add(driven.force(0), driven.force(1));
  }
  return out;
}

std::vector<RecordedStep> record_steps(Simulation& simulation, const Motion& motion, double duration_s,
                                       double prediction_horizon_s, bool patches) {
  std::vector<RecordedStep> out;
  Driven driven(simulation, motion);
  ExchangePause pause;
  Condenser condense;
  ContactFramePrediction predict;
  SurfacePatchBuilder add_patches;
  ProblemStamp stamp;
  ConstraintProblem condensed;
  std::vector<std::uint8_t> bytes;
  std::string why;
  while (simulation.time() < duration_s) {
    driven.step();
    RecordedStep& step = out.emplace_back();
    step.pose_s = simulation.time();
    step.force = {driven.force(0), driven.force(1)};
    stamp.step_s = simulation.h();
    stamp.sim_time_s = simulation.time();
    const ConstraintProblem& step_problem =
        patches ? add_patches(simulation, Publisher::max_rows) : simulation.problem();
    const ConstraintProblem& sent =
        condense(prediction_horizon_s >= 0 ? predict(simulation, step_problem, prediction_horizon_s) : step_problem,
                 Publisher::max_rows, condensed);
    if (!encode_problem(stamp, sent, pause.hands(simulation), bytes) || !decode_problem(bytes, step.update, why))
      out.pop_back();
    add_patches.compute_modes();
  }
  return out;
}

ForceTrace replay(const std::vector<RecordedStep>& steps, const Motion& motion, double duration_s,
                  const ReplaySettings& settings) {
  ForceTrace out;
  Servo servo(settings.servo);
  JumpMeter jumps(settings.servo);
  ConstraintProblem bare;
  std::size_t next = 0;
  const auto arrives = [&](std::size_t k) {
    return steps[k].pose_s + settings.latency_s + settings.jitter * steps[k].update.step_s * Random(k).uniform();
  };
  std::array<Vec3, 2> held{Vec3::Zero(), Vec3::Zero()};
  const long ticks = std::lround(duration_s / tick_s);
  for (long k = 1; k <= ticks; ++k) {
    const double t = double(k) * tick_s;
    bool fresh = false;
    for (; next < steps.size() && arrives(next) <= t + 1e-9; ++next) fresh = true;
    if (fresh) {
      const RecordedStep& step = steps[next - 1];
      held = step.force;
      if (settings.rendering == Rendering::diagonal) {
        servo.set_problem(nullptr);
        bare = step.update.problem;
        keep_diagonal(bare);
      }
      servo.set_problem(settings.rendering == Rendering::diagonal ? &bare : &step.update.problem, step.update.offset,
                        t - step.pose_s);
    }
    if (settings.rendering == Rendering::hindsight) {
      std::size_t after = 0;
      while (after < steps.size() && steps[after].pose_s < t) ++after;
      if (after == 0 || after == steps.size()) {
        out.add(held[0], held[1]);
        continue;
      }
      const RecordedStep &a = steps[after - 1], &b = steps[after];
      const double s = (t - a.pose_s) / (b.pose_s - a.pose_s);
      out.add((1 - s) * a.force[0] + s * b.force[0], (1 - s) * a.force[1] + s * b.force[1]);
      continue;
    }
    if (settings.rendering == Rendering::held) {
      out.add(held[0], held[1]);
      continue;
    }
    ServoInput input;
    for (int hand = 0; hand < 2; ++hand) {
      if (!motion.has(hand)) continue;
      input.device[std::size_t(hand)] = motion.at(hand, t).pose;
      input.connected[std::size_t(hand)] = true;
    }
    const ServoResult r = servo.tick(input);
    if (settings.rendering == Rendering::servo)
      jumps.tick(fresh ? &steps[next - 1] : nullptr, fresh ? t - steps[next - 1].pose_s : 0, input, r, out);
    out.add(r.hand[0].force, r.hand[1].force);
  }
  return out;
}

void write_traces(const std::filesystem::path& file, const ForceTrace& reference, const ForceTrace& rendered) {
  std::filesystem::create_directories(file.parent_path());
  std::ofstream out(file);
  fmt::print(out,
             "time_s,left_x,left_y,left_z,right_x,right_y,right_z,servo_left_x,servo_left_y,servo_left_z,servo_right_x,"
             "servo_right_y,servo_right_z\n");
  for (std::size_t i = 0; i < rendered.force[0].size(); ++i) {
    fmt::print(out, "{:.3f}", tick_s * double(i + 1));
    for (const ForceTrace* t : {&reference, &rendered})
      for (const auto& hand : t->force) fmt::print(out, ",{:.6g},{:.6g},{:.6g}", hand[i].x(), hand[i].y(), hand[i].z());
    out << '\n';
  }
}

TruthOfHand compare(const std::vector<Vec3>& reference, const std::vector<Vec3>& rendered) {
  TruthOfHand out;
  const std::size_t n = std::min(reference.size(), rendered.size());
  for (std::size_t i = 0; i < n; ++i) out.peak_N = std::max(out.peak_N, reference[i].norm());
  if (!(out.peak_N > 0)) return out;
  double sum = 0;
  std::size_t count = 0;
  for (std::size_t i = 0; i < n; ++i) {
    if (reference[i].norm() < rendered_N && rendered[i].norm() < rendered_N) continue;
    const double error = (rendered[i] - reference[i]).norm() / out.peak_N;
    sum += error * error;
    ++count;
    out.worst = std::max(out.worst, error);
  }
  out.rms = std::sqrt(sum / double(std::max<std::size_t>(1, count)));
  // Onsets of the reference, and when the rendered force crosses the same threshold, looked for from as long before as
  // it was quiet.
  const double threshold = std::max(onset_least_N, onset_share * out.peak_N);
  int quiet = quiet_ticks, rising = 0;
  for (std::size_t i = 0; i < n; ++i) {
    const double size = reference[i].norm();
    if (size < quiet_share * threshold) {
      quiet = rising > 0 ? 1 : quiet + 1;
      rising = 0;
      continue;
    }
    ++rising;
    if (size < threshold) continue;
    if (quiet >= quiet_ticks && rising <= quiet_ticks) {
      std::size_t at = i;
      if (rendered[i].norm() < threshold)
        while (at < n && rendered[at].norm() < threshold) ++at;
      else
        while (at > 0 && i - at < std::size_t(quiet_ticks) && rendered[at - 1].norm() >= threshold) --at;
      const double delay = (double(at) - double(i)) * tick_s;
      if (out.onsets == 0 || std::abs(delay) > std::abs(out.onset_s)) out.onset_s = delay;
      ++out.onsets;
    }
    quiet = 0;
  }
  return out;
}

}  // namespace insula
