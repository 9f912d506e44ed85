// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/run_json.h"

#include <filesystem>

namespace insula::gateway {

namespace fs = std::filesystem;
using Ordered = nlohmann::ordered_json;
using training::Run;

Ordered run_json(const Run& r) {
  return {{"uuid", r.uuid},
          {"person", r.person},
          {"scene", r.scene},
          {"title", r.title},
          {"mode", r.mode},
          {"began_ms", r.began_ms},
          {"duration_s", r.duration_s},
          {"state", r.state},
          {"goals", r.goals},
          {"goals_done", r.goals_done},
          {"faults", r.faults},
          {"step_rate_hz", r.step_rate_hz},
          {"recording", fs::path(r.recording).stem().string()}};
}

Ordered full_run_json(const Run& r) {
  Ordered out = run_json(r);
  out["metrics"] = Ordered::array();
  for (const auto& m : r.metrics)
    out["metrics"].push_back({{"id", m.id},
                              {"hand", m.hand},
                              {"value", m.value},
                              {"text", m.text},
                              {"unit", m.unit},
                              {"better", m.better},
                              {"digits", m.digits}});
  out["fault_counts"] = Ordered::array();
  for (const auto& f : r.fault_counts)
    out["fault_counts"].push_back({{"id", f.id}, {"text", f.text}, {"count", f.count}});
  return out;
}

}  // namespace insula::gateway
