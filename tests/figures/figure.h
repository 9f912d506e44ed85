// SPDX-License-Identifier: GPL-3.0-or-later
// Results of a test of a law beside the law, for the figures of docs/validation.md.
#pragma once
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace insula::test {

/// Written as NAME.json when INSULA_FIGURES names a folder; otherwise nothing is kept. tools/manual/figures.py draws
/// it: laws as lines, what the run gave as points.
class Figure {
 public:
  Figure(std::string name, const std::string& title, const std::string& x, const std::string& y)
      : name_(std::move(name)) {
    if (const char* folder = std::getenv("INSULA_FIGURES")) folder_ = folder;
    json_ = {{"title", title},
             {"x", x},
             {"y", y},
             {"law", nlohmann::ordered_json::object()},
             {"run", nlohmann::ordered_json::object()}};
  }
  Figure(const Figure&) = delete;
  Figure& operator=(const Figure&) = delete;
  ~Figure() {
    if (!folder_.empty()) std::ofstream(folder_ / (name_ + ".json")) << json_ << "\n";
  }
  /// Adds a point of a curve, in the units of the axes' labels.
  void law(const std::string& curve, double x, double y) { add("law", curve, x, y); }
  void run(const std::string& curve, double x, double y) { add("run", curve, x, y); }

 private:
  void add(const char* kind, const std::string& curve, double x, double y) {
    if (!folder_.empty()) json_[kind][curve].push_back({x, y});
  }
  std::string name_;
  std::filesystem::path folder_;
  nlohmann::ordered_json json_;
};

}  // namespace insula::test
