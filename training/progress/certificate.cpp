// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/progress/certificate.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <stdexcept>

#include "training/progress/curriculum_json.h"

namespace insula::training {
namespace {

using Ordered = nlohmann::ordered_json;

CertifiedTask certified(const Store& store, const Module& module, const Task& task, const TaskProgress& progress) {
  CertifiedTask out;
  out.module = module.title, out.title = task.title, out.gates = task.gates;
  out.attempts_to_level = progress.attempts_to_level.value_or(0);
  out.passed_ms = progress.passed_ms.value_or(0);
  for (const std::string& uuid : progress.runs)
    if (auto run = store.run(uuid)) out.runs.push_back(std::move(*run));
  return out;
}

Ordered task_json(const CertifiedTask& t) {
  Ordered runs = Ordered::array(), gates = Ordered::array();
  for (const Gate& g : t.gates) gates.push_back(gate_json(g));
  for (const Run& r : t.runs)
    runs.push_back({{"uuid", r.uuid},
                    {"began_ms", r.began_ms},
                    {"mode", r.mode},
                    {"state", r.state},
                    {"goals", r.goals},
                    {"goals_done", r.goals_done},
                    {"faults", r.faults},
                    {"duration_s", r.duration_s}});
  return {{"module", t.module},        {"title", t.title},
          {"gates", std::move(gates)}, {"attempts_to_level", t.attempts_to_level},
          {"passed_ms", t.passed_ms},  {"runs", std::move(runs)}};
}

}  // namespace

std::string certificate_digest(const std::string& person, const std::string& content, std::vector<std::string> runs) {
  std::sort(runs.begin(), runs.end());
  runs.erase(std::unique(runs.begin(), runs.end()), runs.end());
  std::string text = person + "\n" + content + "\n";
  for (const std::string& run : runs) text += run + "\n";
  std::array<unsigned char, EVP_MAX_MD_SIZE> bytes{};
  unsigned int size = 0;
  if (EVP_Digest(text.data(), text.size(), bytes.data(), &size, EVP_sha256(), nullptr) != 1)
    throw std::runtime_error("no SHA-256 on this machine");
  std::string out;
  for (int i = 0; i < 8; ++i) out += fmt::format("{}{:02x}", i > 0 && i % 2 == 0 ? "-" : "", bytes[std::size_t(i)]);
  return out;
}

std::optional<Certificate> certificate(const Store& store, const std::string& person, const Curriculum& curriculum,
                                       const Progress& progress) {
  if (!progress.passed) return std::nullopt;
  Certificate out;
  const auto known = store.find(person);
  out.person = known ? known->pseudonym : person;
  out.curriculum = curriculum.title;
  out.content = fmt::format("{:016x}", curriculum.content_hash);
  std::vector<std::string> runs;
  for (std::size_t m = 0; m < progress.modules.size(); ++m)
    for (std::size_t t = 0; t < progress.modules[m].tasks.size(); ++t) {
      const Module& module = curriculum.modules.at(m);
      out.tasks.push_back(certified(store, module, module.tasks.at(t), progress.modules[m].tasks[t]));
      out.passed_ms = std::max(out.passed_ms, out.tasks.back().passed_ms);
      for (const Run& run : out.tasks.back().runs) {
        runs.push_back(run.uuid);
        out.began_ms = out.began_ms == 0 ? run.began_ms : std::min(out.began_ms, run.began_ms);
      }
    }
  out.digest = certificate_digest(out.person, out.content, std::move(runs));
  return out;
}

Ordered certificate_json(const Certificate& c, std::string_view version) {
  Ordered tasks = Ordered::array();
  for (const CertifiedTask& t : c.tasks) tasks.push_back(task_json(t));
  return {{"person", c.person},     {"curriculum", c.curriculum}, {"content", c.content},
          {"began_ms", c.began_ms}, {"passed_ms", c.passed_ms},   {"version", version},
          {"digest", c.digest},     {"tasks", std::move(tasks)}};
}

}  // namespace insula::training
