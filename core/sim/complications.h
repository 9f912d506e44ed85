// SPDX-License-Identifier: GPL-3.0-or-later
// Random complications: which of them happen in this run, and when. The draw depends only on a seed, so the seed in a
// report identifies the run.
#pragma once
#include <cstdint>
#include <string>
#include <vector>

#include "core/registry/component.h"

namespace insula {

class Simulation;

/// `<complication command="pump fail" probability="0.3" from="20 s" to="90 s"/>`: a command of a component
/// (Simulation::command "ask") at a time drawn between two.
class Complication final : public Component {
 public:
  static constexpr std::string_view kind_name = "complication";
  Param<std::string> command{this,
                             {.name = "command", .doc = "what happens: id of a component, its command, its argument"}};
  Param<Scalar> probability{
      this,
      {.name = "probability", .fallback = "1", .min = "0", .max = "1", .doc = "how likely it is to happen in a run"}};
  Param<Duration> from{
      this, {.name = "from", .fallback = "0 s", .min = "0 s", .max = "3600 s", .doc = "earliest time of the exercise"}};
  Param<Duration> to{this, {.name = "to", .min = "0 s", .max = "3600 s", .doc = "latest time of the exercise"}};

  void prepare(PrepareContext& context) override;
};

/// The result of the draw for one complication.
struct DrawnComplication {
  std::string id, command;
  double probability = 0;
  bool happens = false;
  double time = 0;  ///< s; drawn even if it does not happen
  bool begun = false;
  std::string refused;  ///< reason why it was refused at its time; empty: done, or not begun
};

/// `<complications>`: owns them. Each has a random stream of its own, so an additional complication does not change the
/// others.
class Complications final : public Component {
 public:
  static constexpr std::string_view kind_name = "list of complications";
  Param<int> seed{this,
                  {.name = "seed",
                   .fallback = "0",
                   .min = "0",
                   .max = "2147483647",
                   .doc = "what the draw begins from; 0: the scene's seed"}};

  void prepare(PrepareContext& context) override;
  /// Checks that the commands exist.
  void connect(PrepareContext& context, const Simulation& simulation);
  /// Draws again from `seed`; 0 means the seed of the element, or of the scene.
  void draw(std::uint64_t seed, const Simulation& simulation);
  /// Starts what is due at the start of the coming step.
  void act(Simulation& simulation);
  std::uint64_t drawn_from() const { return drawn_from_; }
  const std::vector<DrawnComplication>& drawn() const { return drawn_; }

 private:
  std::vector<Complication*> list_;
  std::vector<DrawnComplication> drawn_;
  std::uint64_t drawn_from_ = 0;
};

}  // namespace insula
