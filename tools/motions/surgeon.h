// SPDX-License-Identifier: GPL-3.0-or-later
// Scripted hands that free an aneurysm by operating in its running scene. The dissector goes to the nearest and
// outermost strand, turns the blade across it and sweeps it back and forth. Grids of distances keep it clear of the
// vessel and the lobes.
#pragma once
#include <functional>

#include "core/mechanics/shell_body.h"
#include "tools/motions/sweeps.h"

namespace insula {

/// How briskly hands move.
struct Pace {
  double stroke = 0.25, stroke_per_m = 110;  ///< s, and s/m of half a stroke
  double travel = 0.016, turn = 2.2;         ///< m/s, rad/s
  double at_least = 0.3;                     ///< s, of a path between strokes
  double enter = 2.2;                        ///< s, from outside of the field and back
  bool until_severed = false;                ///< no more strokes than part the strand; else three in any case
};

class Surgeon {
 public:
  /// The scene has a vessel with a sac, strands, a view, frontal, temporal and insula, the suction tube in the left
  /// hand (0) and the dissector in the right (1), as exercise 2 has. Steps it a tenth of a second: the first report
  /// names the strands. Throws InputError.
  explicit Surgeon(Simulation& simulation);

  /// Which strands no sweep reaches as they stand with room for the wall's pulse; indices into the report's strands.
  std::vector<int> out_of_reach() const;
  /// Divides strands until none stands or the rest is out of reach, and draws the hands out again. Rehearsed on tougher
  /// strands than the scene's, so that each is divided with room to spare when the motion is played. Says how many
  /// stand. `told` hears of each sweep.
  int divide(const Pace& pace, const std::function<void(const Sweep&, int tries)>& told = nullptr);
  void write(const std::filesystem::path& file) const { hands_.write(file); }
  double time() const { return hands_.time(); }
  const std::vector<StrandState>& strands() const { return strands_.now(); }  ///< as they are now
  const Vec3& centre() const { return centre_; }                              ///< of the sac, m
  const Vec3& outward() const { return outward_; }                            ///< to the surgeon

 protected:
  /// Mean of a region's vertices as they lie now.
  Vec3 middle_of(const std::string& region) const;
  /// The suction tube waits beside the sac, on the left.
  Wish left_rest() const;

  Simulation& simulation_;
  mutable Strands strands_{simulation_};
  Hands hands_;
  Vec3 centre_, outward_, lean_, left_shaft_;  ///< set by find()
  const ShellBody* artery_ = nullptr;

 private:
  const ShellBody* find();
  void see(const Body& body, Clearance& grid);
  void add_tool(const Instrument& tool);
  void look();
  /// To the start of a sweep: straight when there is room, else back along the shaft, across, and in again.
  void go(const Wish& to, const Pace& pace);

  Clearance vessel_, others_;
  SweepPlanner planner_;
};

}  // namespace insula
