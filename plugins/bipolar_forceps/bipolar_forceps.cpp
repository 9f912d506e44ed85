// SPDX-License-Identifier: GPL-3.0-or-later
/*
# bipolar_forceps

Bipolar forceps. While the device's first button is held, a current between the two tips heats the tissue there. Heat
closes vessels: the stumps of parted veins of `bridging_veins`, whole veins, and a tear of `bleeding` that is not under
pressure.

    <bipolar_forceps id="bipolar" model="../../meshes/instruments/bipolar_forceps/bipolar_forceps.urdf" hand="right"
                     home="12 0 1 mm" shaft="1 0 0" spare="artery_wall"/>

The tissue between the tips is a sphere of `heated_volume` V and radius r at one temperature, T above the body's 37
degrees Celsius:

    rho c V dT/dt = P - (4 pi k r + rho_b c_b Q) T          heat capacity, conduction into what is around it, blood
    100 degrees:  L w V d(dried)/dt = P - (4 pi k r + rho_b c_b Q) T
    dose = integral of A exp(-E / (R (310 K + T))) dt       a vessel is closed at 1

P is `power`. Each step solves the first equation exactly for the power and the flow of that step; the dose is
integrated by five points of Gauss. At 70 degrees a vessel closes in a minute, at 80 degrees in a second. Three things
keep heat away, as in an operation:

- Under blood the current goes past the tissue: only `power_under_blood` of P heats it. Suck the blood away first.
- Blood Q that jets out of a tear carries heat away. Stop the flow before (a temporary clip). A vein between the tips
  is pressed shut, so nothing flows there.
- Dry tissue conducts no current. When `stick_at` of the water has boiled off, the tissue sticks to the tips, and the
  current ends until the button is released.

Without tissue or a vessel within `reach` of the tips nothing is heated. Tissue that the tips leave by more than
`reach` is replaced by fresh tissue. Surfaces in `spare` must not be heated: their vertices within `reach` get the same
dose, and `burn` tells when it is 1. Other tissue within reach of the tips bears the heat without harm.

Sources: k, rho c of tissue and blood from Hasgall et al., IT'IS database (0.5 W/(m K), 3.7 and 3.8 MJ/(m3 K)); A
= 5.6e63 1/s and E = 430 kJ/mol for arterial collagen from Agah, Pearce, Welch, Motamedi 1994.
*/
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/mechanics/instrument.h"
#include "core/mechanics/surface.h"
#include "core/registry/registry.h"
#include "core/sim/events.h"
#include "core/sim/simulation.h"
#include "plugins/bipolar_forceps/coagulable.h"
#include "plugins/bipolar_forceps/heated_tissue.h"

namespace insula {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

class BipolarForceps final : public Instrument {
 public:
  Param<Power> power{this,
                     {.name = "power",
                      .fallback = "0.8 W",
                      .min = "0 W",
                      .max = "50 W",
                      .doc = "that heats the tissue between the tips, less what leads and tips lose"}};
  Param<Volume> heated_volume{
      this,
      {.name = "heated_volume", .fallback = "3 mm3", .min = "0.1 mm3", .max = "100 mm3", .doc = "between the tips"}};
  Param<Length> reach{this,
                      {.name = "reach",
                       .fallback = "1.2 mm",
                       .min = "0.1 mm",
                       .max = "10 mm",
                       .doc = "from the middle between the tips to what they heat"}};
  Param<Scalar> power_under_blood{this,
                                  {.name = "power_under_blood",
                                   .fallback = "0.2",
                                   .min = "0",
                                   .max = "1",
                                   .doc = "share of the power that heats tissue while blood covers the tips"}};
  Param<Scalar> stick_at{this,
                         {.name = "stick_at",
                          .fallback = "0.3",
                          .min = "0.01",
                          .max = "1",
                          .doc = "share of the water boiled off at which tissue sticks to the tips"}};
  RefList<Surface> spare{
      this,
      {.name = "spare", .fallback = "", .doc = "surfaces that must not be coagulated, such as the artery's wall"}};

  Channel<TemperatureRise> rise{this,
                                {.name = "temperature_rise",
                                 .doc = "of the tissue between the tips, above the body's 37 degrees Celsius; unknown: "
                                        "the forceps is not in the hand",
                                 .min = "0 K",
                                 .max = "63 K",
                                 .shown = Shown::vital,
                                 .digits = 0}};
  Channel<Scalar> dried{this,
                        {.name = "dried",
                         .doc = "share of the water between the tips that has boiled off",
                         .min = "0",
                         .max = "1",
                         .shown = Shown::none,
                         .display = "%",
                         .digits = 0}};
  Channel<Scalar> closing{this,
                          {.name = "dose",
                           .doc = "largest dose of the vessels between the tips; at 100 % a vessel is closed",
                           .min = "0",
                           .max = "1",
                           .shown = Shown::none,
                           .display = "%",
                           .digits = 0}};
  EventKind coagulated{this,
                       {.name = "coagulated", .doc = "heat closed a vessel or a tear", .value = "temperature rise, K"}};
  EventKind stuck{this,
                  {.name = "stuck",
                   .doc = "dry tissue sticks to the tips: the current lasted too long",
                   .value = "share of the water boiled off",
                   .bad = true}};
  EventKind burn{this,
                 {.name = "burn",
                  .doc = "a surface that must be spared was coagulated",
                  .value = "temperature rise, K",
                  .bad = true}};

  void prepare(PrepareContext& context) override {
    Instrument::prepare(context);
    tissue_ = HeatedTissue(heated_volume());
    spared_dose_.assign(spare().size(), 0);
  }
  void join(PrepareContext&, Simulation& simulation) override {
    vessels_ = simulation.scene().all<Coagulable>();
    for (Surface* s : simulation.surfaces())
      if (s->body().blocks() > 0) surfaces_.push_back(s);
    std::size_t most = 0;
    for (const Coagulable* v : vessels_) most += std::size_t(v->site_count());
    held_.reserve(most);
  }
  bool cutting() const override { return false; }
  double activity() const override { return current_ ? 1 : 0; }

  void finish(const StepContext& context, const ConstraintSolution&) override {
    const Vec3 tip = pose().p;
    if ((tip - heated_at_).norm() > reach()) tissue_.reset();
    heated_at_ = tip;
    if (!state().button1) stuck_ = false;
    const bool vessels = find_vessels(tip);
    current_ = state().button1 && !stuck_ && (vessels || touches_tissue(tip));
    const double share = under_blood(tip) ? power_under_blood() : 1;
    const double dose = tissue_.heat(context.h, current_ ? share * power() : 0, washing_);
    give(context, dose);
    if (current_ && tissue_.dried() >= stick_at()) {
      stuck_ = true;
      emit(context, stuck, id, tissue_.dried());
    }
  }

  void publish() override {
    rise.set(active() ? tissue_.rise() : unknown);
    dried.set(tissue_.dried());
    double most = 0;
    for (const Held& v : held_) most = std::max(most, v.vessel->dose(v.site));
    closing.set(std::min(1.0, most));
  }

  void lay_down() override {
    Instrument::lay_down();
    cool();
  }
  void reset() override {
    Instrument::reset();
    cool();
    spared_dose_.assign(spare().size(), 0);
  }
  void append_state(std::vector<double>& out) const override {
    Instrument::append_state(out);
    out.insert(out.end(), {tissue_.rise(), tissue_.dried(), double(current_), double(stuck_)});
    out.insert(out.end(), heated_at_.data(), heated_at_.data() + 3);
    out.insert(out.end(), spared_dose_.begin(), spared_dose_.end());
  }

 private:
  struct Held {
    Coagulable* vessel;
    int site;
  };

  /// Whether a vessel's place lies between the tips; keeps all that do, and the blood that flows past them.
  bool find_vessels(const Vec3& tip) {
    held_.clear();
    washing_ = 0;
    for (Coagulable* v : vessels_)
      for (int i = 0; i < v->site_count(); ++i) {
        const auto site = v->site(i);
        if (!site || (site->position - tip).norm() > reach()) continue;
        held_.push_back({v, i});
        washing_ = std::max(washing_, site->washing);
      }
    return !held_.empty();
  }
  bool near(const Surface& s, const Vec3& tip) const {
    const double far = reach() * reach();
    return std::any_of(s.positions().begin(), s.positions().end(),
                       [&](const Vec3& p) { return (p - tip).squaredNorm() < far; });
  }
  bool touches_tissue(const Vec3& tip) const {
    return std::any_of(surfaces_.begin(), surfaces_.end(), [&](const Surface* s) { return near(*s, tip); });
  }
  bool under_blood(const Vec3& tip) const {
    return std::any_of(vessels_.begin(), vessels_.end(), [&](const Coagulable* v) { return v->covers(tip); });
  }
  void give(const StepContext& context, double dose) {
    for (const Held& v : held_)
      if (v.vessel->add_dose(context, v.site, dose)) {
        const auto* component = dynamic_cast<const Component*>(v.vessel);
        emit(context, coagulated, component ? component->id : id, tissue_.rise());
      }
    if (dose < least_dose) return;
    for (std::size_t i = 0; i < spared_dose_.size(); ++i) {
      if (spared_dose_[i] >= 1 || !near(*spare()[i], heated_at_)) continue;
      spared_dose_[i] += dose;
      if (spared_dose_[i] >= 1) emit(context, burn, spare()[i]->id, tissue_.rise());
    }
  }
  void emit(const StepContext& context, const EventKind& what, const std::string& text, double value) const {
    if (context.events) context.events->emit({what.name(), id, text, value, context.time + context.h, hand_index()});
  }
  void cool() {
    tissue_.reset();
    heated_at_.setZero();
    current_ = stuck_ = false;
    held_.clear();
  }

  static constexpr double least_dose = 1e-9;  ///< of a step; at the body's temperature it is far less

  std::vector<Coagulable*> vessels_;
  std::vector<const Surface*> surfaces_;  ///< of bodies that deform
  std::vector<Held> held_;                ///< between the tips in this step
  double washing_ = 0;                    ///< m3/s
  HeatedTissue tissue_{3e-9};
  Vec3 heated_at_ = Vec3::Zero();
  bool current_ = false, stuck_ = false;
  std::vector<double> spared_dose_;
};

}  // namespace
}  // namespace insula

INSULA_PLUGIN(bipolar_forceps) {
  registry.add<insula::BipolarForceps>("bipolar_forceps", insula::Kind::instrument,
                                       "bipolar forceps that close vessels by heat while a button is pressed");
}
