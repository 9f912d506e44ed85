// SPDX-License-Identifier: GPL-3.0-or-later
// The haptic server: two devices, one servo, three threads.
#include <pthread.h>
#include <signal.h>
#include <spdlog/spdlog.h>
#include <sys/prctl.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <thread>

#include "core/base/input_error.h"
#include "core/params/option.h"
#include "haptic_server/newton_budget.h"
#include "haptic_server/server.h"
#include "haptic_server/servo_loop.h"

namespace {

using namespace insula;
using namespace std::chrono_literals;
using Steady = std::chrono::steady_clock;

std::atomic<bool> asked_to_stop{false};  // the only variable that a signal handler may change

void on_signal(int) { asked_to_stop.store(true); }

struct Arguments {
  std::string left = "simulated", right = "simulated", motion;
  double duration_s = 0;
  double spin_us = -1;  ///< negative: the default of LoopSettings
  bool status = false;
  LoopSettings loop;
};

void print_status(const insula_lcm::haptic_status_t& s) {
  std::printf(
      "%.0f ticks/s, fresh forces left %.0f/s right %.0f/s, late p50 %.0f p99 %.0f max %.0f us, missed %lld, solve p50 "
      "%.0f p99 %.0f us, sweeps %.1f, residual %.1e m, %d rows, problem %.1f ms old, received %lld, refused %lld%s%s\n",
      s.ticks_per_s, s.fresh_forces_per_s[0], s.fresh_forces_per_s[1], s.lateness_us_p50, s.lateness_us_p99,
      s.lateness_us_max, static_cast<long long>(s.missed_ticks), s.solve_us_p50, s.solve_us_p99, s.sweeps_mean,
      s.residual_m_max, s.rows, s.problem_age_ms, static_cast<long long>(s.problems_received),
      static_cast<long long>(s.messages_refused), s.note.empty() ? "" : ": ", s.note.c_str());
  std::fflush(stdout);
}

/// Reduces the unknowns of the servo's Newton steps if this machine cannot compute them within a tick.
void fit_newton_steps(ServerOptions& options) {
  int& unknowns = options.servo.newton_unknowns;
  constexpr double newton_share = 0.4;  // of a tick; sweeps and the rest take another third
  const int most = unknowns_within(newton_share * options.period_s, unknowns, factorisation_time(unknowns));
  if (most >= unknowns) return;
  spdlog::info(
      "this machine makes Newton steps of {} unknowns within a tick, not {}: with more rows forces end less exactly",
      most, unknowns);
  unknowns = most;
}

ServerOptions server_options(const Arguments& a) {
  ServerOptions options;
  options.period_s = 1 / a.loop.rate_hz;
  fit_newton_steps(options);
  if (a.motion == "none") options.motion = Motion();
  else if (!a.motion.empty()) options.motion = load_motion(a.motion);
  return options;
}

void receive_until_stopped(HapticServer& server, const std::atomic<bool>& run) {
  while (run.load()) {
    try {
      server.receive(50);
    } catch (const std::exception& e) {  // a message must not end the server
      spdlog::warn("{}", e.what());
    }
  }
}

/// Publishes states every 4 ms and a status each second, until the time is over or a signal comes.
void publish_until_asked_to_stop(HapticServer& server, const Bus& bus, const Arguments& a) {
  const auto start = Steady::now();
  auto next_status = start + 1s;
  bool bus_was_good = true;
  for (auto next = start; !asked_to_stop.load(); std::this_thread::sleep_until(next)) {
    server.publish_state();
    server.collect();
    const auto now = Steady::now();
    if (now >= next_status) {
      const auto& status = server.publish_status();
      if (a.status) print_status(status);
      if (bus.good() != bus_was_good && !bus.good()) spdlog::warn("{}", bus.error());
      bus_was_good = bus.good();
      next_status = std::max(next_status + 1s, now);
    }
    if (a.duration_s > 0 && now - start >= std::chrono::duration<double>(a.duration_s)) break;
    next = std::max(next + 4ms, now);
  }
}

/// Fades the forces to zero. The gate needs at most 50 ms for this.
void fade_out(HapticServer& server) {
  server.begin_stop();
  const auto patience = Steady::now() + 300ms;
  std::this_thread::sleep_for(5ms);
  while (!server.quiet() && Steady::now() < patience) {
    server.publish_state();
    std::this_thread::sleep_for(4ms);
  }
}

int serve(const Arguments& a) {
  std::unique_ptr<Bus> bus = make_bus();
  if (!bus->good()) {
    spdlog::error("{}", bus->error());
    return 1;
  }
  ServerOptions options = server_options(a);
  std::array<DeviceChoice, 2> devices{make_device(a.left, 0), make_device(a.right, 1)};
  const std::array<Device*, 2> device{devices[0].device.get(), devices[1].device.get()};

  const RealtimeGrant grant = probe_realtime(a.loop.priority);
  options.realtime = grant.scheduler;
  options.advice = grant.advice;
  if (!grant.advice.empty()) spdlog::warn("{}", grant.advice);

  const MonotonicClock clock;
  // Devices start first, since the gate takes its limits from the device's own data.
  for (Device* d : device) d->start();
  HapticServer server(*bus, std::move(devices), clock, std::move(options));
  spdlog::info("haptic server: left {}, right {}, {:.0f} Hz, {}", a.left, a.right, a.loop.rate_hz,
               grant.scheduler ? "real-time" : "without real-time scheduling");

  std::atomic<bool> run{true};
  std::thread receiver([&] { receive_until_stopped(server, run); });
  std::thread servo([&] { run_servo(server, a.loop, run); });
  publish_until_asked_to_stop(server, *bus, a);
  fade_out(server);
  run = false;
  servo.join();
  receiver.join();
  for (Device* d : device) {
    d->write(Vec3::Zero(), Vec3::Zero());
    d->stop();
  }
  server.publish_state();
  spdlog::info("haptic server: ended");
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  Arguments a;
  CLI::App app{"Insula's haptic server: one servo for both hands"};
  std::string kinds;
  for (const std::string& k : device_kinds()) kinds += (kinds.empty() ? "" : ", ") + k;
  app.add_option(
         "--left", a.left,
         "device of the left hand: KIND[:WHICH], several with commas between: the first that is plugged in. Kinds: " +
             kinds)
      ->capture_default_str();
  app.add_option("--right", a.right, "device of the right hand")->capture_default_str();
  app.add_option("--motion", a.motion, "motion of simulated hands instead of the scene's: a CSV file, or none");
  insula::add_quantity<insula::Frequency>(app, "--rate", a.loop.rate_hz,
                                          {.bare = "Hz", .min = "100 Hz", .max = "4 kHz", .doc = "rate of the servo"})
      ->default_str("1 kHz");
  insula::add_quantity<insula::Duration>(app, "--duration", a.duration_s,
                                         {.bare = "s", .min = "0 s", .doc = "end after this time; 0: never"});
  app.add_option("--priority", a.loop.priority, "real-time priority of the servo")
      ->check(CLI::Range(1, 99))
      ->capture_default_str();
  insula::add_quantity<insula::Duration>(
      app, "--spin", a.spin_us, {.bare = "us", .min = "0 us", .max = "500 us", .doc = "busy waiting before each tick"});
  app.add_flag("--status", a.status, "print a line each second");
  try {
    std::vector<std::string> words = insula::command_words(argc, argv);
    std::reverse(words.begin(), words.end());  // as CLI11 takes them
    app.parse(std::move(words));
  } catch (const CLI::ParseError& e) {
    return app.exit(e);
  }
  a.loop.spin_us = int(a.spin_us);

  struct sigaction action {};
  action.sa_handler = on_signal;
  sigaction(SIGTERM, &action, nullptr);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGHUP, &action, nullptr);
  signal(SIGPIPE, SIG_IGN);
  try {
    return serve(a);
  } catch (const insula::InputError& e) {
    spdlog::error("{}", e.what());
    return 2;
  } catch (const std::exception& e) {
    spdlog::error("{}", e.what());
    return 1;
  }
}
