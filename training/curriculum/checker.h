// SPDX-License-Identifier: GPL-3.0-or-later
// From the elements of a curriculum to plain data: what several parameters say together, and what the scenes and bands
// must have.
#pragma once
#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/scene/suggestions.h"
#include "training/curriculum/curriculum.h"
#include "training/curriculum/reader.h"
#include "training/curriculum/sources.h"

namespace insula {

class CurriculumChecker {
 public:
  CurriculumChecker(CurriculumReader& reader, CurriculumSources& sources, Suggestions& suggestions,
                    Diagnostics& diagnostics)
      : reader_(reader), sources_(sources), suggestions_(suggestions), diagnostics_(diagnostics) {}

  Curriculum check(const CurriculumRoot& root);

 private:
  Module module(const ModuleElement& from);
  Task task(const TaskElement& from);
  WarmUp warm_up(const WarmUpElement& from);
  void circles(const std::vector<ModuleElement*>& modules);
  /// A file from the folder in which the program runs, so that messages name it as the author does.
  static std::filesystem::path as_named(const CurriculumElement& from, const Param<File>& file);
  /// The facts of a scene that has an exercise and no errors; null, with a report, for others.
  const SceneFacts* facts(const CurriculumElement& from, const Param<File>& scene);

  Gate gate(const GateElement& from, const SceneFacts* facts, const std::filesystem::path& scene);
  void faults_gate(const FaultsGate& from, const SceneFacts* facts, Gate& gate);
  void metric_gate(const MetricGate& from, const SceneFacts* facts, const std::filesystem::path& scene, Gate& gate);
  /// The metric that a gate names, and its hand; null, with a report, if there is none.
  const MetricFact* metric(const MetricGate& from, const SceneFacts& facts, std::string& hand);
  std::optional<double> limit(const MetricGate& from, const Param<MetricLimit>& param, const MetricFact& metric);
  void band(const MetricGate& from, const SceneFacts& facts, const MetricFact& metric,
            const std::filesystem::path& scene, Gate& gate);

  void error(const CurriculumElement& element, const ParamBase& param, const std::string& text);
  /// "; did you mean ...?", a list of the names, or nothing.
  std::string suggestion(const std::string& name, const std::vector<std::string>& names);

  CurriculumReader& reader_;
  CurriculumSources& sources_;
  Suggestions& suggestions_;
  Diagnostics& diagnostics_;
  std::set<std::filesystem::path> reported_;  ///< scenes whose own errors were reported
};

}  // namespace insula
