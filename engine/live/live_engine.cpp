// SPDX-License-Identifier: GPL-3.0-or-later
// The real-time loop.
#include "engine/live/live_engine.h"

#include <spdlog/spdlog.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <thread>

#include "core/base/input_error.h"
#include "core/base/text.h"
#include "core/bus/arrival_order.h"
#include "core/bus/channels.h"
#include "core/bus/codec.h"
#include "engine/live/bundle.h"
#include "engine/live/command_script.h"
#include "engine/live/lockstep_hands.h"
#include "engine/live/motion_start.h"
#include "engine/live/notice.h"
#include "engine/live/publisher.h"
#include "engine/live/session_mode.h"
#include "engine/live/soft_guiding.h"
#include "engine/reports/session_reports.h"
#include "engine/session/live_recording.h"

namespace insula {
namespace fs = std::filesystem;
namespace {

// A device state older than this no longer moves a tool.
constexpr std::int64_t stale_us = 200'000;
constexpr double settle_s = 0.3;
// Longest time for which the first steps wait for scripted hands, s: without any haptic server, and with one.
constexpr double server_patience_s = 0.5, hands_patience_s = 3;
// A scripted hand within this distance and angle of its motion follows it.
constexpr double near_m = 1e-3, near_rad = 0.1;
// Largest number of requests between two steps; more indicate an error in a script.
constexpr std::size_t max_requested = 100;

struct Inputs {
  insula_lcm::device_state_t devices{};
  ArrivalOrder order;
  std::int64_t received_us = 0;
  bool pause = false, reset = false, quit = false;
  bool driven = false;                                     ///< a person has moved a hand since the start
  std::optional<std::string> begin;                        ///< argument of the last "begin"
  std::optional<std::string> soft_guide;                   ///< argument of the last "soft_guide"
  std::vector<std::string> read;                           ///< messages that the trainee has read
  std::vector<std::pair<std::string, std::string>> asked;  ///< command and argument, in order of arrival

  void subscribe(Bus& bus, SessionReports& reports, LiveRecording& recording) {
    bus.subscribe(channel::device_state, [this, &reports, &recording](Bytes b) {
      std::string why;
      insula_lcm::device_state_t m{};
      if (!decode(b, m, why)) return;
      const std::int64_t now_us = monotonic_us();
      if (!order.take(m.session, m.sequence, 1000 * now_us)) return;
      devices = std::move(m);
      received_us = now_us;
      reports.hear(devices);
      recording.hands(b);
    });
    bus.subscribe(channel::servo_ticks, [&recording](Bytes b) {
      std::string why;
      insula_lcm::servo_ticks_t m{};
      if (decode(b, m, why)) recording.ticks(b);
    });
    bus.subscribe(channel::haptic_status, [&reports](Bytes b) {
      std::string why;
      insula_lcm::haptic_status_t m{};
      if (decode(b, m, why)) reports.hear(m);
    });
    bus.subscribe(channel::hand_input, [this](Bytes b) {
      std::string why;
      insula_lcm::hand_input_t m{};
      if (decode(b, m, why)) driven = true;
    });
    bus.subscribe(channel::user_command, [this](Bytes b) {
      std::string why;
      insula_lcm::user_command_t m{};
      if (!decode(b, m, why)) return;
      if (m.command == "pause") pause = true;
      else if (m.command == "resume") pause = false;
      else if (m.command == "reset") reset = true;
      else if (m.command == "quit") quit = true;
      else if (m.command == "begin") begin = m.argument;
      else if (m.command == "soft_guide") soft_guide = m.argument;
      else if (m.command == "release") return;  // the haptic server's
      else if (m.command == "read") {
        if (read.size() < max_requested) read.push_back(m.argument);
      } else if (m.command == "exchange" || m.command == "ask" || m.command == "message") {
        if (asked.size() < max_requested) asked.emplace_back(m.command, m.argument);
      } else spdlog::info("unknown command \"{}\" ignored", m.command.substr(0, 40));
    });
  }

  /// Whether the arms follow the motion: simulated arms that no person has taken over.
  bool follows(const Motion& motion) const {
    if (driven) return false;
    if (!motion.has(0) && !motion.has(1)) return true;
    if (monotonic_us() - received_us > stale_us) return false;
    for (const auto& h : devices.hand)
      if (motion.has(h.hand) && !(h.connected && h.device == "simulated")) return false;
    return true;
  }

  /// Whether a person's arm has the place of a scripted hand.
  bool persons_arm(const Motion& motion) const {
    return std::any_of(devices.hand.begin(), devices.hand.end(),
                       [&](const auto& h) { return motion.has(h.hand) && h.connected && h.device != "simulated"; });
  }

  /// Whether the hands that the motion moves are where it has them at this time.
  bool at(const Motion& motion, double time) const {
    if (!follows(motion)) return false;
    for (int hand = 0; hand < 2; ++hand) {
      if (!motion.has(hand)) continue;
      const Pose wanted = motion.at(hand, time).pose;
      const auto here = std::find_if(devices.hand.begin(), devices.hand.end(), [&](const auto& h) {
        const Vec3 p(h.p_m[0], h.p_m[1], h.p_m[2]);
        const Quat q(h.q[0], h.q[1], h.q[2], h.q[3]);
        return h.hand == hand && (p - wanted.p).norm() < near_m && q.angularDistance(wanted.q) < near_rad;
      });
      if (here == devices.hand.end()) return false;
    }
    return true;
  }

  /// Sets the hands of the step, and returns the time stamp of their poses, CLOCK_MONOTONIC, us; 0: none.
  /// ready: scripted hands are known to belong to this run.
  std::int64_t apply(Simulation& simulation, bool ready) const {
    if (monotonic_us() - received_us > stale_us) return 0;
    // Until the haptic server knows this session, its hands are still at their poses in the last one.
    if (!ready && simulation.time() < settle_s) return 0;
    for (const auto& h : devices.hand) {
      if (!h.connected || h.hand < 0 || h.hand > 1) continue;
      HandState s;
      s.present = true;
      s.device.p = Vec3(h.p_m[0], h.p_m[1], h.p_m[2]);
      s.device.q = Quat(h.q[0], h.q[1], h.q[2], h.q[3]).normalized();
      s.button1 = h.button1;
      s.button2 = h.button2;
      simulation.set_hand(h.hand, s);
    }
    return std::max<std::int64_t>(0, devices.time_us);
  }
};

fs::path bundle_folder(const fs::path& root, std::int64_t session) {
  fs::path base = root;
  if (base.empty()) {
    const char* runtime = std::getenv("XDG_RUNTIME_DIR");
    base = runtime && *runtime ? fs::path(runtime) : fs::temp_directory_path();
    base /= "insula-" + std::to_string(getuid());
  }
  return fs::absolute(base) / std::to_string(session);
}

}  // namespace

fs::path find_motion(const Simulation& simulation, const std::string& wanted) {
  if (wanted.empty() || wanted == "none") return {};
  std::vector<std::string> ids;
  if (const Exercise* e = simulation.exercise())
    for (const MotionEntry* m : e->motions()) {
      if (m->id == wanted) return fs::absolute(m->file());
      ids.push_back(m->id);
    }
  if (fs::is_regular_file(wanted)) return fs::absolute(wanted);
  std::string text = "no motion \"" + wanted + "\"";
  const std::string near = nearest_name(wanted, ids);
  if (!near.empty()) text += did_you_mean(near);
  else if (!ids.empty()) {
    text += "; this scene has";
    for (const auto& id : ids) text += " " + id;
  }
  throw InputError(text);
}

namespace {

/// Finds and reads the file of the wanted motion. False if the file that the person named cannot be read, or the motion
/// may not start where it does.
bool load_motion_of(const Simulation& simulation, const std::string& wanted, fs::path& file, Motion& motion) {
  try {
    file = find_motion(simulation, wanted);
    if (file.empty()) return true;
    motion = load_motion(file);
  } catch (const InputError& e) {
    // A scene without the default motion is played by a person.
    if (wanted != "steady") {
      std::fprintf(stderr, "error: %s\n", e.what());
      return false;
    }
    return true;
  }
  try {
    check_start(simulation, motion);
  } catch (const InputError& e) {
    std::fprintf(stderr, "error: %s: %s\n", file.string().c_str(), e.what());
    return false;
  }
  return true;
}

/// How a session begins that the command line says nothing of, or whose scene has nothing to choose.
SessionMode first_mode(const LiveOptions& options, const Simulation& simulation, const Motion& motion) {
  const SessionMode usual = motion.empty() ? SessionMode::practice : SessionMode::demonstration;
  const SessionMode mode = options.mode.value_or(usual);
  return mode == SessionMode::waiting && !simulation.exercise() ? usual : mode;
}

/// Keeps the loop in step with simulated time.
class Pace {
 public:
  using Clock = std::chrono::steady_clock;
  explicit Pace(double period_s)
      : period_(std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(period_s))) {}

  /// Takes messages until the next step is due. If the loop is far behind, time is dropped and not made up for.
  void wait(Bus& bus) {
    next_ += period_;
    const auto now = Clock::now();
    if (now > next_ + 2 * period_) {
      ++dropped_;
      next_ = now;
    }
    while (Clock::now() < next_) {
      const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(next_ - Clock::now()).count();
      if (left > 1) bus.poll(int(left) - 1);
      else std::this_thread::sleep_until(next_);
    }
  }
  std::int64_t dropped() const { return dropped_; }
  double seconds() const { return std::chrono::duration<double>(Clock::now() - began_).count(); }

 private:
  Clock::duration period_;
  Clock::time_point began_ = Clock::now(), next_ = began_;
  std::int64_t dropped_ = 0;
};

/// Persons move the hands: no step waits for a factor, and the servo finds contacts until the next problem comes.
void prepare_for_persons(Simulation& simulation) {
  simulation.set_deterministic(false);
  simulation.set_collision_horizon(Publisher::collision_horizon_steps * simulation.h());
}

/// One session: the simulation, its inputs and its outputs.
class LiveSession {
 public:
  LiveSession(Simulation& simulation, const LiveOptions& options, Bus& bus, fs::path motion, const Motion& script,
              Publisher& publisher, SessionReports& reports, LiveRecording& recording)
      : simulation_(simulation),
        options_(options),
        bus_(bus),
        motion_(std::move(motion)),
        script_(script),
        publisher_(publisher),
        reports_(reports),
        recording_(recording),
        notice_(options.notice) {
    inputs_.subscribe(bus, reports, recording);
    set_mode(first_mode(options, simulation, script));
  }

  void run(const std::atomic<bool>& stop, Pace& pace) {
    const auto over = [&] { return options_.duration > 0 && !(simulation_.time() < options_.duration - 1e-9); };
    while (!stop && !inputs_.quit && !over()) {
      while (bus_.poll(0) > 0) {
      }
      take_requests();
      keep_reviews();
      publisher_.note({.mode = mode_,
                       .report = reports_.last_report(),
                       .recording = recording_.file(),
                       .soft_guide = guiding_.chosen(),
                       .guided = guiding_.now() ? guiding_.now()->hand : -1,
                       .unrecorded = recording_.failure()});
      const bool waits = !stands() && wait_for_hands();
      if (stands()) stand_still();
      else if (!waits && !step()) continue;
      if (!options_.unthrottled || stands() || waits) pace.wait(bus_);
    }
  }

  /// The last report, whose review goes into the recording.
  void end() {
    reports_.end_run(simulation_);
    reports_.wait();
    keep_reviews();
  }

 private:
  /// What is known of a pass through the exercise that ends here.
  void end_pass() {
    recording_.end_pass(simulation_);
    reports_.end_run(simulation_);
  }

  /// The debrief of a recording has the words of the reports.
  void keep_reviews() {
    for (const std::string& review : reports_.take_reviews()) recording_.review(review);
  }

  void start_again() {
    simulation_.reset();
    commands_.reset();
    end_demonstration();
    ready_ = over_ = false;
    waiting_since_us_ = 0;
  }

  /// After the first step: whether the run waits until the scripted hands are at their motion. So a motion starts at
  /// the same step in every session, as it does in a run without processes. Repeats the problem meanwhile, since the
  /// haptic server places the hands by it.
  bool wait_for_hands() {
    if (over_ || simulation_.steps() == 0) return false;
    const std::int64_t now = monotonic_us();
    if (waiting_since_us_ == 0) waiting_since_us_ = now;
    const double waited_s = 1e-6 * double(now - waiting_since_us_);
    ready_ = (script_.has(0) || script_.has(1)) && inputs_.at(script_, simulation_.time());
    const bool hopeless = mode_ != SessionMode::demonstration || (!script_.has(0) && !script_.has(1)) ||
                          inputs_.driven || inputs_.persons_arm(script_) || waited_s > hands_patience_s ||
                          (inputs_.received_us == 0 && waited_s > server_patience_s);
    over_ = ready_ || hopeless;
    if (!over_) publisher_.again(simulation_);
    return !over_;
  }

  bool stands() const { return inputs_.pause || options_.still || mode_ == SessionMode::waiting; }

  /// Only a demonstration moves simulated hands by the motion.
  void set_mode(SessionMode mode) {
    mode_ = mode;
    const bool shows = mode == SessionMode::demonstration;
    commands_ = CommandScript(shows ? script_.commands() : std::vector<MotionCommand>{});
    reports_.set_mode(mode);
    recording_.note({{"mode", std::string(name_of(mode)), "", 0, simulation_.time()}});
    publisher_.follow(shows ? motion_ : fs::path());
  }

  /// "demonstration", "practice" or "test": the exercise starts again in that mode.
  void begin(const std::string& name) {
    const std::optional<SessionMode> mode = session_mode(name);
    if (!mode || *mode == SessionMode::waiting || (*mode == SessionMode::demonstration && script_.empty())) {
      publisher_.events(
          {{"refused", "begin", "This scene has no " + shown(name) + " to begin", 0, simulation_.time()}});
      return;
    }
    inputs_.pause = inputs_.driven = false;
    end_pass();
    start_again();
    set_mode(*mode);
    // The haptic server reads the motion before it hears of the start.
    publisher_.info("running", notice_.text());
    spdlog::info("{} begins", name_of(*mode));
  }

  void take_requests() {
    if (inputs_.begin) {
      begin(*inputs_.begin);
      inputs_.begin.reset();
    }
    if (inputs_.reset) {
      inputs_.reset = false;
      inputs_.driven = false;  // the haptic server returned the hands to the motion
      end_pass();
      start_again();
      spdlog::info("reset");
    }
    if (inputs_.soft_guide) choose_soft_guide(*inputs_.soft_guide);
    inputs_.soft_guide.reset();
    pass_on_receipts();
    for (const auto& [verb, argument] : inputs_.asked) {
      const std::string why = simulation_.command(verb, argument);
      if (!why.empty()) spdlog::info("{} \"{}\" refused: {}", verb, shown(argument), why);
    }
    inputs_.asked.clear();
  }

  /// "on" or "off". Nobody gets a soft force in a test. The choice stays for the session, and the recording has it.
  void choose_soft_guide(const std::string& choice) {
    const bool on = choice == "on";
    std::string why;
    if (!on && choice != "off") why = "A soft force is \"on\" or \"off\", not " + shown(choice);
    if (on && mode_ == SessionMode::test) why = "A test gives no soft force";
    if (!why.empty()) return publisher_.events({{"refused", "soft_guide", why, 0, simulation_.time()}});
    guiding_.choose(on);
    const std::vector<Event> said{{"soft_guide", choice, "", 0, simulation_.time()}};
    publisher_.events(said);
    recording_.note(said);
  }

  void stand_still() {
    const std::vector<Event> announced = simulation_.take_announced();  // no step will publish them
    publisher_.events(announced);
    reports_.note(announced);
    recording_.note(announced);
    publisher_.paused_frame(simulation_);
    publisher_.info("paused", notice_.text());
  }

  /// The instructor sees that a message has been read.
  void pass_on_receipts() {
    std::vector<Event> receipts;
    for (const std::string& text : inputs_.read) receipts.push_back({"read", "message", text, 0, simulation_.time()});
    inputs_.read.clear();
    if (receipts.empty()) return;
    publisher_.events(receipts);
    reports_.note(receipts);
    recording_.note(receipts);
  }

  /// A demonstration that nobody has taken over: hands of this process follow the motion, step by step.
  bool demonstrates() const {
    return mode_ == SessionMode::demonstration && ready_ && !inputs_.driven && !inputs_.persons_arm(script_);
  }
  /// From the start, as a run without processes. No person's hand needs contacts beyond the step.
  void begin_demonstration() {
    simulation_.reset();
    commands_.reset();
    reports_.begin();
    demonstration_.emplace(simulation_, script_);
    simulation_.set_deterministic(true);
    simulation_.set_collision_horizon(0);
  }
  void end_demonstration() {
    if (!demonstration_) return;
    demonstration_.reset();
    prepare_for_persons(simulation_);
  }

  /// False if a value of the simulation became non-finite. The simulation has then started again.
  bool step() {
    if (!demonstrates()) end_demonstration();
    else if (!demonstration_) begin_demonstration();
    const bool lockstep = demonstration_.has_value();
    std::int64_t posed = monotonic_us();
    if (lockstep) demonstration_->before_step(simulation_);
    else posed = inputs_.apply(simulation_, ready_);
    const bool follows = lockstep || (mode_ == SessionMode::demonstration && inputs_.follows(script_));
    commands_.advance(simulation_, follows);
    simulation_.step();
    if (lockstep) demonstration_->after_step(simulation_);
    recording_.step(simulation_);
    reports_.set_recorded_pass(recording_.pass());
    if (!simulation_.report().finite) {
      reports_.step(simulation_, posed > 0, follows);
      end_pass();
      spdlog::error("the simulation left the range of numbers at {:.3f} s; it starts again", simulation_.time());
      start_again();
      return false;
    }
    publisher_.step(simulation_, posed);
    if (const auto& guiding = guiding_.step(simulation_, mode_)) publisher_.guide(*guiding);
    publisher_.info("running", notice_.text());
    reports_.step(simulation_, posed > 0, follows);
    return true;
  }

  Simulation& simulation_;
  const LiveOptions& options_;
  Bus& bus_;
  fs::path motion_;
  const Motion& script_;
  SessionMode mode_ = SessionMode::practice;
  Publisher& publisher_;
  SessionReports& reports_;
  LiveRecording& recording_;
  CommandScript commands_;
  Notice notice_;
  Inputs inputs_;
  SoftGuiding guiding_;
  std::optional<LockstepHands> demonstration_;
  bool ready_ = false;  ///< the scripted hands are at their motion
  bool over_ = false;   ///< the wait for them
  std::int64_t waiting_since_us_ = 0;
};

}  // namespace

int run_live(const LiveOptions& options, const Registry& registry, Bus& bus, const std::atomic<bool>& stop) {
  std::string chosen;
  SimulationResult loaded = load_at_rate(options.scene, registry, options.threads, options.rate, chosen);
  if (!chosen.empty()) spdlog::info(chosen);
  const std::string said = loaded.diagnostics.format();
  if (!said.empty()) std::fputs(said.c_str(), stderr);
  if (!loaded.simulation) return 2;
  Simulation& simulation = *loaded.simulation;
  prepare_for_persons(simulation);
  if (options.seed != 0) simulation.draw_complications(options.seed);
  fs::path motion;
  Motion script;
  if (!load_motion_of(simulation, options.motion, motion, script)) return 2;
  if (options.take_over && !options.take_over()) return 0;
  const std::int64_t session = monotonic_us();
  const fs::path bundle = bundle_folder(options.bundle_root, session);
  write_bundle(simulation, bundle, session, options.still);
  const std::string title =
      simulation.scene().title().empty() ? options.scene.stem().string() : simulation.scene().title();
  Publisher publisher(bus, session, options.scene, bundle, {}, title);
  SessionReports reports(options.report, options.scene, motion.empty() ? "" : options.motion, options.fields);
  reports.keep_in(options.store);
  try {
    const fs::path bands = options.bands.empty() ? bands_beside(options.scene) : options.bands;
    if (!bands.empty()) reports.compare_with(bands_for(bands, options.band_group, simulation.scene().title()));
  } catch (const InputError& e) {
    spdlog::error("{}. Reports have no bands", e.what());
  }
  LiveRecording recording(options.record, simulation, {options.scene, options.motion, "live", options.fields});
  reports.set_recording(recording.file());
  LiveSession live(simulation, options, bus, motion, script, publisher, reports, recording);
  spdlog::info("\"{}\" runs: {} bodies, {} constraints, step {:.2f} ms", title, simulation.bodies().size(),
               simulation.constraints().size(), simulation.h() * 1000);
  publisher.info("running");

  Pace pace(simulation.h());
  live.run(stop, pace);
  publisher.info("ended");
  live.end();
  recording.close(simulation);
  const double wall = pace.seconds();
  spdlog::info(
      "ended after {:.2f} s simulated in {:.2f} s (real_time_factor {:.2f}), {} steps dropped, {} messages not sent",
      simulation.time(), wall, wall > 0 ? simulation.time() / wall : 0, pace.dropped(), publisher.failed());
  std::error_code ignored;
  if (!options.keep_bundle) fs::remove_all(bundle, ignored);
  return 0;
}

}  // namespace insula
