// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/authoring/curriculum_sources.h"

#include <exception>

#include "core/base/input_error.h"
#include "core/base/text.h"
#include "core/scene/loader.h"
#include "core/sim/complications.h"
#include "core/sim/reference_bands.h"
#include "core/sim/settings.h"
#include "core/sim/simulation.h"
#include "engine/live/project_folder.h"

namespace insula {
namespace {

void add_metrics(const Exercise& exercise, std::vector<MetricFact>& out) {
  for (const MetricSet* set : exercise.children_of<MetricSet>())
    for (const MetricBase* metric : set->metrics())
      for (std::size_t item = 0; item < metric->items().size(); ++item) {
        const DisplayedQuantity& shown = metric->displayed();
        out.push_back({metric->id(item), metric->spec().doc, metric->spec().of, metric->spec().better,
                       std::string(shown.quantity().name), shown.quantity().units, std::string(shown.unit()),
                       shown.scale()});
      }
}

SceneFacts facts_of(const std::filesystem::path& file, const Registry& registry) {
  SceneFacts facts;
  auto loaded = load_scene(file, registry);
  facts.diagnostics = std::move(loaded.diagnostics);
  if (!loaded.scene) return facts;
  // Nothing is stepped: a scene that settles first need not do so.
  for (SettleSettings* s : loaded.scene->all<SettleSettings>()) s->time.set(0);
  try {
    Simulation simulation(std::move(loaded.scene), facts.diagnostics);
    facts.title = simulation.scene().title();
    facts.has_complications = !simulation.scene().all<Complication>().empty();
    const Exercise* exercise = simulation.exercise();
    facts.has_exercise = exercise != nullptr;
    if (!exercise) return facts;
    for (const GoalState& goal : exercise->log().goals()) facts.goals.push_back(goal.id);
    for (const FaultState& fault : exercise->log().faults()) facts.faults.push_back({fault.id, fault.text});
    add_metrics(*exercise, facts.metrics);
  } catch (const std::exception& e) {
    facts.diagnostics.error({file.generic_string(), 0, 0}, e.what());
  }
  return facts;
}

}  // namespace

std::filesystem::path CurriculumFiles::shipped_folder() const {
  const std::filesystem::path project = project_folder();
  return project.empty() ? project : project / "curricula";
}

const SceneFacts& CurriculumFiles::scene(const std::filesystem::path& file) {
  const auto found = scenes_.find(file);
  return found != scenes_.end() ? found->second : scenes_.emplace(file, facts_of(file, registry_)).first->second;
}

std::optional<BandFact> CurriculumFiles::band(const std::filesystem::path& bands, const std::string& group,
                                              const SceneFacts& scene, const MetricFact& metric,
                                              const std::string& hand, std::string& error) {
  try {
    const ReferenceBands read = bands_for(bands, group, scene.title);
    MetricValue value;
    value.id = metric.id;
    value.unit = metric.unit;
    value.hand = hand == "left" ? left_hand : hand == "right" ? right_hand : both_hands;
    if (const ReferenceBand* band = read.find(value))
      return BandFact{band->low, band->median, band->high, band->pass_mark};
    error = "the bands of " + in_quotes(group) + " have no figures of " + in_quotes(metric.id) + ", " + hand + " hand" +
            (hand == "both" ? "s" : "");
  } catch (const InputError& e) {
    error = e.what();
  }
  return std::nullopt;
}

}  // namespace insula
