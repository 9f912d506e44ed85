// SPDX-License-Identifier: GPL-3.0-or-later
// insula doctor
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <ostream>
#include <random>
#include <sstream>
#include <thread>

#include "core/bus/bus.h"
#include "core/bus/lcm_bus.h"
#include "engine/command_line/doctor.h"
#include "engine/live/project_folder.h"
#include "haptic_server/devices/device_kinds.h"
#include "haptic_server/servo_loop.h"

namespace fs = std::filesystem;

namespace insula {
namespace {

MachineFinding good(std::string id, std::string text) { return {std::move(id), Fitness::good, std::move(text), {}}; }

MachineFinding processor() {
  const unsigned cores = std::thread::hardware_concurrency();
  const std::string text = fmt::format("{} core{}", cores, cores == 1 ? "" : "s");
  if (cores >= 2) return good("processor", text);
  return {"processor", Fitness::lacking, text, "Engine, haptic server and page need two cores between them."};
}

MachineFinding memory() {
  constexpr double needed_GiB = 3;
  const double there = double(sysconf(_SC_PHYS_PAGES)) * double(sysconf(_SC_PAGE_SIZE)) / (1024.0 * 1024.0 * 1024.0);
  const std::string text = fmt::format("{:.1f} GiB", there);
  if (there >= needed_GiB) return good("memory", text);
  return {"memory", Fitness::lacking, text, fmt::format("A session with a browser needs {:.0f} GiB.", needed_GiB)};
}

/// A message of a step's size, sent to this machine itself.
MachineFinding bus() {
  const std::string url = lcm_url_from_environment();
  std::unique_ptr<Bus> bus = make_bus();
  const std::string channel = fmt::format("INSULA_DOCTOR_{}", std::random_device()());
  bool heard = false;
  const std::vector<std::uint8_t> message(80'000);
  if (bus->good()) {
    bus->subscribe(channel, [&](Bytes bytes) { heard = heard || bytes.size() == message.size(); });
    bus->publish(channel, message);
    for (int k = 0; k < 20 && bus->good() && !heard; ++k) bus->poll(25);
  }
  if (heard) return good("bus", "messages arrive by " + url);
  std::string remedy = bus->error();
  if (remedy.empty())
    remedy = "No message came back within half a second. See docs/bus.md for addresses, routes and firewalls.";
  return {"bus", Fitness::unusable, "no message arrives by " + url, remedy};
}

MachineFinding real_time() {
  const RealtimeGrant grant = probe_realtime(LoopSettings().priority);
  if (grant.advice.empty()) return good("real_time", "real-time scheduling and locked memory are granted");
  return {"real_time", Fitness::lacking,
          grant.scheduler ? "memory cannot be locked" : "no right to real-time scheduling", grant.advice};
}

/// The first of these programs on the path; empty: none.
std::string on_path(const std::vector<std::string>& names) {
  const char* path = std::getenv("PATH");
  for (const std::string& name : names) {
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');)
      if (access((fs::path(folder) / name).c_str(), X_OK) == 0 && !fs::is_directory(fs::path(folder) / name))
        return name;
  }
  return {};
}

MachineFinding browser() {
  const std::string found = on_path({"firefox", "firefox-esr", "chromium", "google-chrome", "xdg-open"});
  const bool display = std::getenv("DISPLAY") || std::getenv("WAYLAND_DISPLAY");
  if (found.empty())
    return {"browser", Fitness::lacking, "no browser was found",
            "sudo apt-get install firefox-esr, or open the page from another machine (docs/room.md)."};
  if (!display)
    return {"browser", Fitness::lacking, found + ", but there is no display",
            "Open the address that insula play prints on a machine with a display, through ssh -L or a room "
            "(docs/room.md)."};
  return good("browser", found);
}

MachineFinding graphics() {
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator("/dev/dri", ignored)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with("renderD")) continue;
    if (access(entry.path().c_str(), R_OK | W_OK) == 0) return good("graphics", entry.path().string());
    return {"graphics", Fitness::lacking, "no right to use " + entry.path().string(),
            "sudo adduser $USER render, and log in again."};
  }
  return {"graphics", Fitness::lacking, "no graphics processor",
          "The page draws in software, at draft quality. Its driver may be missing (mesa-va-drivers, nvidia-driver)."};
}

MachineFinding devices() {
  std::string there, missing, remedy;
  for (const DeviceKind& kind : all_device_kinds()) {
    if (!kind.real) continue;
    const DeviceSearch found = kind.search();
    for (const FoundDevice& device : found.devices) there += (there.empty() ? "" : ", ") + device.label;
    if (!found.missing.empty())
      remedy += fmt::format("{}{}: {}", remedy.empty() ? "" : " ", kind.name, kind.how_to_get);
  }
  if (!there.empty()) return good("devices", there);
  return {"devices", Fitness::lacking, "no device for the hands; mouse and keys serve",
          "insula devices tells what is supported and what is missing." + (remedy.empty() ? "" : " " + remedy)};
}

const char* word(Fitness f) { return f == Fitness::good ? "good" : f == Fitness::lacking ? "lacking" : "unusable"; }

}  // namespace

std::vector<MachineFinding> examine_machine() {
  return {processor(), memory(), bus(), real_time(), browser(), graphics(), devices()};
}

int cmd_doctor(const CommandContext& context, bool json) {
  const std::vector<MachineFinding> findings = examine_machine();
  const bool fit = std::none_of(findings.begin(), findings.end(),
                                [](const MachineFinding& f) { return f.fitness == Fitness::unusable; });
  if (json) {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const MachineFinding& f : findings)
      all.push_back({{"id", f.id}, {"fitness", word(f.fitness)}, {"text", f.text}, {"remedy", f.remedy}});
    context.out << nlohmann::ordered_json{{"fit", fit}, {"findings", all}}.dump(1) << '\n';
    return fit ? 0 : 1;
  }
  for (const MachineFinding& f : findings) {
    context.out << fmt::format("{:<8}  {:<10} {}\n", word(f.fitness), f.id, f.text);
    if (!f.remedy.empty()) context.out << "          " << f.remedy << '\n';
  }
  context.out << (fit ? "Insula runs on this machine.\n" : "Insula does not run on this machine as it is.\n");
  return fit ? 0 : 1;
}

}  // namespace insula
