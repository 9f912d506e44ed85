// SPDX-License-Identifier: GPL-3.0-or-later
// Metrics: figures on how a person works, such as the path of a hand or the force on tissue. A component of kind metric
// declares one or several of them once, as it declares parameters. It reads the reports of the steps while the exercise
// runs. Report, pages, sessions and reference read the declarations.
//
//   class PathLength final : public MetricSet {
//     Metric<Length> path{this, {.name = "path_length", .doc = "Path of the hand", .source = "Cotin et al. 2002",
//                                .better = Better::low}};
//     void observe(const StepReport& report) override { ... }
//     void evaluate() override { path.set(0, left_); path.set(1, right_); }
//   };
//
// Values are SI. An unknown value is NaN. A metric is a function of the reports alone, so a repeated run gives the same
// bits.
#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "core/registry/component.h"
#include "core/registry/displayed_quantity.h"
#include "core/sim/report.h"

namespace insula {

class MetricSet;
class Simulation;

/// Which direction shows more skill.
enum class Better { none, low, high };
std::string_view better_name(Better better);

/// Whether each hand has a value, or both together have one.
enum class Of { each_hand, both_hands };

/// Index of a value: a hand, or both together.
inline constexpr int left_hand = 0, right_hand = 1, both_hands = 2;
std::string_view hand_name(int hand);  ///< "left", "right", "both"

struct MetricSpec {
  std::string name;
  std::string doc;     ///< one line, for the trainee
  std::string source;  ///< who defines it: a publication, or "Insula"
  Better better = Better::none;
  Of of = Of::each_hand;
  std::string_view display = {};  ///< unit shown, one of the quantity's; "%" for a plain number; empty: SI
  int digits = 2;                 ///< decimals in that unit
};

/// Base of every metric, with the data for reports and the reference.
class MetricBase {
 public:
  /// `single`: one metric. Otherwise there is one for each name of declare_items(). Throws std::logic_error for a wrong
  /// declaration.
  MetricBase(MetricSet* owner, MetricSpec spec, DisplayedQuantity::Quantity quantity, bool single);
  MetricBase(const MetricBase&) = delete;
  MetricBase& operator=(const MetricBase&) = delete;

  const MetricSpec& spec() const { return spec_; }
  const DisplayedQuantity& displayed() const { return displayed_; }
  bool single() const { return single_; }
  /// Names of the group's items. A single metric has one item with an empty name.
  const std::vector<std::string>& items() const { return items_; }
  /// "path_length", or "force_peak.frontal" for the item "frontal" of a group.
  std::string id(std::size_t item) const;
  double value(std::size_t item, int hand) const { return values_[item][std::size_t(hand)]; }
  void set_value(std::size_t item, int hand, double si) { values_[item][std::size_t(hand)] = si; }
  /// Makes every value unknown.
  void reset();

 protected:
  void set_items(std::vector<std::string> names);

 private:
  MetricSpec spec_;
  DisplayedQuantity displayed_;
  bool single_;
  std::vector<std::string> items_;
  std::vector<std::array<double, 3>> values_;  ///< left, right, both
};

template <class Q>
class Metric : public MetricBase {
 public:
  Metric(MetricSet* owner, MetricSpec spec)
      : MetricBase(owner, std::move(spec), DisplayedQuantity::quantity_of<Q>(), true) {}
  void set(int hand, double si) { set_value(0, hand, si); }
  void set(double si) { set_value(0, both_hands, si); }
  double operator()(int hand = both_hands) const { return value(0, hand); }
};

/// The same metric for several similar things, such as tissues. Their names are declared in MetricSet::declare().
template <class Q>
class MetricGroup : public MetricBase {
 public:
  MetricGroup(MetricSet* owner, MetricSpec spec)
      : MetricBase(owner, std::move(spec), DisplayedQuantity::quantity_of<Q>(), false) {}
  void declare_items(std::vector<std::string> names) { set_items(std::move(names)); }
  void set(std::size_t item, int hand, double si) { set_value(item, hand, si); }
  double operator()(std::size_t item, int hand) const { return value(item, hand); }
};

/// A component that computes metrics. The exercise calls it while it runs.
class MetricSet : public Component {
 public:
  static constexpr std::string_view kind_name = "metric";
  /// Called once, after the rules of the exercise are declared: finds what it reads and names the items of groups.
  virtual void declare(PrepareContext&, const Simulation&) {}
  /// After each step in which the exercise ran. Must not allocate.
  virtual void observe(const StepReport& report) = 0;
  /// Sets the values from what has been observed so far. May be called between any two steps.
  virtual void evaluate() = 0;
  /// Forgets what has been observed.
  virtual void reset() = 0;
  const std::vector<MetricBase*>& metrics() const { return metrics_; }  ///< in order of declaration

 private:
  friend class MetricBase;
  std::vector<MetricBase*> metrics_;
};

/// One value of one metric, for reports and pages.
struct MetricValue {
  std::string id;    ///< unique among the metrics of an exercise
  std::string text;  ///< what it is, for the trainee
  std::string source;
  int hand = both_hands;
  bool known = false;
  double value = 0;  ///< in `unit`
  std::string unit;
  int digits = 2;
  Better better = Better::none;
};

}  // namespace insula
