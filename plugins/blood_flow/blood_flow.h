// SPDX-License-Identifier: GPL-3.0-or-later
// Blood flow through a vessel as a lumped network along its centrelines (equations in blood_flow.cpp).
#pragma once
#include <string>
#include <vector>

#include "plugins/blood_flow/dye.h"
#include "plugins/blood_flow/lumen_piece.h"
#include "plugins/blood_flow/vessel_graph.h"
#include "plugins/blood_flow/vessel_state.h"
#include "plugins/pressure/pressure.h"

namespace insula {

class BloodFlow final : public Constraint, public ChamberFeed, public VesselSource, public LumenSource {
 public:
  static constexpr std::string_view kind_name = "blood_flow";

  Ref<BloodPressure> blood_pressure{
      this,
      {.name = "pressure",
       .doc = "pressure of the arteries that feed the vessel; its chambers are fed by this network"}};
  Param<Viscosity> viscosity{
      this, {.name = "viscosity", .fallback = "3.5 mPa s", .min = "0.5 mPa s", .max = "20 mPa s", .doc = "of blood"}};
  Param<Density> density{
      this, {.name = "density", .fallback = "1.06 g/cm3", .min = "0.9 g/cm3", .max = "1.2 g/cm3", .doc = "of blood"}};
  Param<Length> thickness{this,
                          {.name = "thickness",
                           .fallback = "0.3 mm",
                           .min = "0 mm",
                           .max = "2 mm",
                           .doc = "of the wall; the lumen is what lies inside of its middle surface by half of that"}};
  Param<Length> spacing{this,
                        {.name = "spacing",
                         .fallback = "0.7 mm",
                         .min = "0.2 mm",
                         .max = "20 mm",
                         .doc = "distance of the stations at which the lumen is measured"}};
  Param<Scalar> closed_below{this,
                             {.name = "closed_below",
                              .fallback = "0.05",
                              .min = "0",
                              .max = "0.5",
                              .doc = "a lumen below this share of its own at rest is closed"}};
  Param<std::string> inlet{
      this,
      {.name = "inlet",
       .fallback = "",
       .doc = "opening through which blood enters; none given: the one called inlet, else the widest"}};
  Param<FlowRate> flow{this,
                       {.name = "flow",
                        .fallback = "130 ml/min",
                        .min = "1 ml/min",
                        .max = "2000 ml/min",
                        .doc = "through the inlet at rest"}};
  Param<Scalar> split{this,
                      {.name = "split",
                       .fallback = "1.5",
                       .min = "0",
                       .max = "3",
                       .doc = "flow of an outlet at rest is in proportion to its area to this power"}};
  Param<Scalar> upstream_drop{this,
                              {.name = "upstream_drop",
                               .fallback = "0.08",
                               .min = "0",
                               .max = "0.5",
                               .doc = "share of the arterial pressure lost before the inlet at rest"}};
  Param<Pressure> venous{this,
                         {.name = "venous",
                          .fallback = "8 mmHg",
                          .min = "0 mmHg",
                          .max = "40 mmHg",
                          .doc = "pressure behind the vascular bed"}};
  Param<Pressure> outside{this,
                          {.name = "outside",
                           .fallback = "0 mmHg",
                           .min = "0 mmHg",
                           .max = "40 mmHg",
                           .doc = "pressure around the vessel"}};
  Param<Scalar> collateral{this,
                           {.name = "collateral",
                            .fallback = "0.015",
                            .min = "0",
                            .max = "1",
                            .doc = "share of an outlet's flow that other arteries could supply"}};
  Param<Duration> seal_decay{this,
                             {.name = "seal_decay",
                              .fallback = "3 s",
                              .min = "0.1 s",
                              .max = "1000 s",
                              .doc = "time in which the pressure of a sealed part decays towards that outside"}};
  Param<Scalar> sac_exchange{this,
                             {.name = "sac_exchange",
                              .fallback = "0.15",
                              .min = "0",
                              .max = "1",
                              .doc = "blood that a sac exchanges with its vessel at rest, over the flow of the inlet"}};
  Param<Scalar> discharge{
      this,
      {.name = "discharge", .fallback = "0.6", .min = "0.1", .max = "1", .doc = "discharge coefficient of a tear"}};

  ChannelGroup<Pressure> stretch_pressure{this,
                                          {.name = "pressure",
                                           .doc = "in the middle of the stretch",
                                           .min = "0 mmHg",
                                           .max = "300 mmHg",
                                           .shown = Shown::vital,
                                           .display = "mmHg",
                                           .digits = 0}};
  ChannelGroup<FlowRate> stretch_flow{
      this,
      {.name = "flow", .doc = "mean of the last heartbeat", .shown = Shown::vital, .display = "ml/min", .digits = 0}};
  ChannelGroup<Scalar> flow_share{this,
                                  {.name = "flow_share",
                                   .doc = "flow over that at rest, 0 for flow back; not of a dead end, such as a sac",
                                   .min = "0",
                                   .shown = Shown::vital,
                                   .display = "%",
                                   .digits = 0,
                                   .good = {.from = "0.75"},
                                   .high = {.from = "0.5"}}};
  ChannelGroup<Scalar> lumen{this,
                             {.name = "lumen",
                              .doc = "narrowest cross-section over its own at rest",
                              .min = "0",
                              .shown = Shown::vital,
                              .display = "%",
                              .digits = 0}};
  ChannelGroup<Scalar> dye{this,
                           {.name = "dye",
                            .doc = "concentration of indocyanine green",
                            .min = "0",
                            .max = "1",
                            .shown = Shown::none,
                            .digits = 3,
                            .role = Role::shade}};

  void connect(PrepareContext& context, Simulation& simulation) override;
  void build(const StepContext&, ConstraintBuilder&) override {}
  bool adds_rows() const override { return false; }  ///< its chambers' rows are those of the pressure
  void publish() override;
  void append_vessels(std::vector<VesselState>& out) const override;
  void append_lumens(std::vector<LumenPiece>& out) const override;
  std::size_t most_lumens() const override;
  void reset() override;
  void append_state(std::vector<double>& out) const override;
  std::vector<CommandInfo> commands() const override;
  std::string run_command(std::string_view name, std::string_view argument) override;

  double reference(int chamber) const override { return reference_[std::size_t(chamber)]; }
  void reduce(const StepContext& context, StarMesh& chambers) override;
  void settle(const StepContext& context, const double* pressure, const double* yielding) override;

  /// Opens a tear in a chamber's wall, m2; 0 closes it.
  void set_tear(int chamber, double area) { tear_area_[std::size_t(chamber)] = area; }
  double tear_flow(int chamber) const {
    return tear_flow_[std::size_t(chamber)];
  }                                                                              ///< m3/s out of it, in the last step
  bool sealed(int chamber) const { return sealed_[std::size_t(chamber)] != 0; }  ///< cut off from all openings
  const VesselGraph& graph() const { return graph_; }
  double node_pressure(int node) const { return pressure_[std::size_t(node)]; }  ///< Pa
  double arterial_flow() const { return arterial_flow_; }                        ///< through the inlet, m3/s
  struct Outlet {
    int node = -1;
    double bed = 0, collateral = 0;  ///< conductances, m3/(s Pa)
    double rest_flow = 0, flow = 0;  ///< into the bed, m3/s
  };
  const std::vector<Outlet>& outlets() const { return outlets_; }
  double upstream() const { return upstream_; }  ///< conductance, m3/(s Pa)

 private:
  bool find_ends(PrepareContext& context);
  bool set_beds(PrepareContext& context);
  bool map_chambers(PrepareContext& context);
  void set_links(StarMesh& mesh) const;
  void find_sealed();
  double flow_of(const Stretch& s, int index) const;
  void carry_dye(const StepContext& context);
  void average(double h);
  void declare_channels();

  VesselGraph graph_;
  DyeTransport dye_;
  int inlet_node_ = -1;
  double upstream_ = 0;
  std::vector<Outlet> outlets_;
  std::vector<int> chamber_node_, place_,
      node_at_;                    ///< position of a node in the elimination, chambers last; and the inverse
  std::vector<int> main_stretch_;  ///< of each chamber
  std::vector<double> reference_, rest_pressure_, rest_flow_;
  std::vector<std::size_t> passed_;  ///< stretches that are no dead ends: those of flow_share
  StarMesh mesh_;

  // State.
  std::vector<double> pressure_;  ///< of all nodes, Pa
  std::vector<double> yielding_, tear_area_, tear_flow_;
  std::vector<char> sealed_;
  std::vector<double> mean_flow_, beat_flow_;
  double beat_share_ = 0, since_dye_ = -1;

  // Of this step.
  double arterial_ = 0, arterial_flow_ = 0;
  std::vector<double> solved_, inflow_, inflow_dye_, tear_conductance_;
  std::vector<int> part_;
};

}  // namespace insula
