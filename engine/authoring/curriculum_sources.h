// SPDX-License-Identifier: GPL-3.0-or-later
// What curricula need to know of scenes and bands, read from their files. A scene is put together as for a run, since
// some of its metrics are known only then. Each scene is read once.
#pragma once
#include <map>

#include "core/registry/registry.h"
#include "training/curriculum/sources.h"

namespace insula {

class CurriculumFiles final : public CurriculumSources {
 public:
  explicit CurriculumFiles(const Registry& registry) : registry_(registry) {}
  std::filesystem::path shipped_folder() const override;
  const SceneFacts& scene(const std::filesystem::path& file) override;
  std::optional<BandFact> band(const std::filesystem::path& bands, const std::string& group, const SceneFacts& scene,
                               const MetricFact& metric, const std::string& hand, std::string& error) override;
  /// Those that were asked for, by file.
  const std::map<std::filesystem::path, SceneFacts>& scenes() const { return scenes_; }

 private:
  const Registry& registry_;
  std::map<std::filesystem::path, SceneFacts> scenes_;
};

}  // namespace insula
