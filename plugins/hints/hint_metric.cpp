// SPDX-License-Identifier: GPL-3.0-or-later
// A hint when a metric leaves its band: the middle half of a group of sessions, as `insula bands --json` writes it. The
// file is one of the scene's, so a recording has it.
//
// The metric is evaluated here ten times a second, although publisher and recorder evaluate all metrics too. Those do
// so only where somebody listens, and at other times: a run without processes evaluates none before its end. A hint on
// their values would depend on who listens, and a rerun would not give its cues. An evaluation is cheap: it sums up
// what was observed, and changes nothing but the values.
#include <algorithm>

#include "core/base/input_error.h"
#include "core/base/text.h"
#include "core/sim/reference_bands.h"
#include "plugins/hints/hint.h"
#include "plugins/hints/register.h"

namespace insula {
namespace {

constexpr double interval_s = 0.1;

class HintMetric final : public Hint {
 public:
  Param<std::string> metric{this, {.name = "metric", .doc = "id of a metric of the exercise: \"path_length\""}};
  Param<Choice> of{this,
                   {.name = "of",
                    .fallback = "both",
                    .choices = {"left", "right", "both"},
                    .doc = "the hand whose value it is; both: of both together"}};
  Param<File> bands{this, {.name = "bands", .doc = "what insula bands --json wrote: the bands of groups of sessions"}};
  Param<std::string> group{
      this, {.name = "group", .fallback = "", .doc = "group whose band it is; empty: the only one of the file"}};
  Param<Duration> after{this,
                        {.name = "after",
                         .fallback = "0 s",
                         .min = "0 s",
                         .max = "3600 s",
                         .doc = "time of the exercise before which nothing is judged"}};
  Param<Scalar> margin{this,
                       {.name = "margin",
                        .fallback = "0",
                        .min = "0",
                        .max = "100",
                        .doc = "widths of the band beyond its edge that are still well; bands of few sessions, or of "
                               "scripted hands, are narrow"}};

  void prepare(PrepareContext& context) override {
    try {
      all_ = ReferenceBands(bands(), group());
    } catch (const InputError& e) {
      error(context, bands, e.what());
      return;
    }
    const auto found = all_.of(metric(), of());
    if (found) band_ = *found;
    else error(context, metric, "the file of bands has none of it for " + of());
  }
  void reset() override {
    Hint::reset();
    last_ = {};
    due_s_ = 0;
  }
  bool urgent() const override { return false; }
  std::string watched() const override { return metric() + (of.is("both") ? "" : " " + of()); }
  std::string worded(double value) const override { return found_ ? found_->displayed().text(value) : std::string(); }

 protected:
  void find(PrepareContext& context, const Simulation& simulation) override {
    std::vector<std::string> known;
    for (MetricSet* set : simulation.exercise()->children_of<MetricSet>()) {
      // The metric of an author is made later, and has the id of its element.
      if (set->metrics().empty()) known.push_back(set->id);
      for (const MetricBase* m : set->metrics())
        if (m->single()) known.push_back(m->spec().name);
      if (!known.empty() && std::find(known.begin(), known.end(), metric()) != known.end()) {
        set_ = set;
        return;
      }
    }
    const std::string near = nearest_name(metric(), known);
    error(context, metric, "the exercise has no single metric " + in_quotes(metric()) + did_you_mean(near));
  }
  HintReading read(const StepReport& report) override {
    due_s_ -= report.h;
    if (due_s_ > 1e-9 || report.time < after()) return last_;
    due_s_ = interval_s;
    set_->evaluate();
    for (const MetricBase* m : set_->metrics())
      if (m->single() && m->spec().name == metric()) found_ = m;
    return last_ = judged();
  }

 private:
  HintReading judged() const {
    HintReading out;
    if (!found_ || found_->displayed().unit() != band_.unit) return out;
    const int hand = of.is("left") ? left_hand : of.is("right") ? right_hand : both_hands;
    const double scale = found_->displayed().scale(), value = found_->value(0, hand) * scale;
    const Better better = found_->spec().better;
    const double width = band_width(band_), top = band_.high + margin() * width, bottom = band_.low - margin() * width;
    const double high = 1 + (value - top) / width, low = 1 + (bottom - value) / width;
    const bool above = better == Better::low || (better == Better::none && high >= low);
    out.share = above ? high : low;
    out.value = value / scale;
    out.limit = (above ? top : bottom) / scale;
    out.hand = hand == both_hands ? -1 : hand;
    return out;
  }

  ReferenceBands all_;
  ReferenceBand band_;
  MetricSet* set_ = nullptr;
  const MetricBase* found_ = nullptr;
  HintReading last_;
  double due_s_ = 0;
};

}  // namespace

void register_hint_metric(Registry& registry) {
  registry.add<HintMetric>("hint_metric", Kind::exercise_rule, "a hint when a metric leaves its band");
}

}  // namespace insula
