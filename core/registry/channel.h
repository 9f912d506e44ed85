// SPDX-License-Identifier: GPL-3.0-or-later
// A component's channels: named numbers that it publishes each step, declared as parameters are. The frame, the report,
// the instructor's curves, the rules and the reference pages read only these.
//
//   class Suture final : public Constraint {
//     Channel<Force> tension{this, {.name = "tension", .doc = "of the thread", .min = "0 N", .max = "5 N"}};
//     void publish() override { tension.set(pull_); }
//   };
//
// Values are SI. An unknown value is NaN. This is also the value before the first `publish`.
#pragma once
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/math.h"
#include "core/params/param.h"
#include "core/registry/displayed_quantity.h"

namespace insula {

class Component;

/// Where the page shows a channel: nowhere, as a curve, or among the vital signs and as a curve.
enum class Shown { none, curve, vital };
std::string_view shown_name(Shown shown);

/// How the channel changes the drawing of its subject: not at all, as the shade of the region with the group's name
/// (0..1), or as the phase of its pulse (0..1).
enum class Role { none, shade, pulse };

/// A range with bounds written with units. An empty bound is open. If both are empty, there is no band.
struct Band {
  std::string_view from = {}, to = {};
};

struct ChannelSpec {
  std::string_view name;
  std::string_view doc;       ///< one line
  std::string_view min = {};  ///< expected range, written with units; empty: open
  std::string_view max = {};
  Shown shown = Shown::curve;
  std::string_view display = {};  ///< unit shown, one of the quantity's; "%" for a plain number; empty: SI
  int digits = 2;                 ///< decimals in that unit
  Band good = {};                 ///< shown in green inside
  Band high = {};                 ///< shown in amber inside; in red outside of both bands
  Role role = Role::none;
  bool measure = false;  ///< a measure of the exercise: the report, the page and the end of a session show it
};

/// Base of every channel, with the data for frame, report and reference.
class ChannelBase {
 public:
  using Quantity = DisplayedQuantity::Quantity;
  /// Throws std::logic_error for a wrong declaration. `single`: one channel. Otherwise there is one for each name of
  /// declare().
  ChannelBase(Component* owner, ChannelSpec spec, Quantity quantity, int size, bool single);
  ChannelBase(const ChannelBase&) = delete;
  ChannelBase& operator=(const ChannelBase&) = delete;

  const ChannelSpec& spec() const { return spec_; }
  const Quantity& quantity() const { return displayed_.quantity(); }
  int size() const { return size_; }  ///< numbers of a value: 1, or 3 for a vector
  bool single() const { return single_; }
  /// Names of the group's items. A single channel has one item with an empty name.
  const std::vector<std::string>& groups() const { return groups_; }
  /// "flow", or "superior.flow" for the item "superior" of a group.
  std::string name(std::size_t item) const;
  const double* values(std::size_t item) const { return values_.data() + item * std::size_t(size_); }
  /// The body that the numbers describe, for its drawing; null: none.
  const Component* subject() const { return subject_; }
  void set_subject(const Component* body) { subject_ = body; }
  /// Makes every value unknown.
  void reset();

  std::optional<double> min() const { return min_; }  ///< SI
  std::optional<double> max() const { return max_; }
  void set_max(double si) { max_ = si; }  ///< for bounds that are known only after loading, such as a count
  using Bounds = std::array<std::optional<double>, 2>;
  const Bounds& good() const { return good_; }  ///< SI
  const Bounds& high() const { return high_; }
  /// Bands that are known only after loading, such as a parameter's limit, SI.
  void set_bands(const Bounds& good, const Bounds& high = {}) {
    good_ = good;
    high_ = high;
  }
  /// 1 within the good band, 0 within the high band or without bands, -1 outside of both.
  int judged(double si) const;
  std::string_view display_unit() const { return displayed_.unit(); }  ///< as shown; may be empty
  double display_scale() const { return displayed_.scale(); }          ///< shown number = SI value * scale
  /// A value as it is shown, with its unit.
  std::string text(double si) const { return displayed_.text(si); }

 protected:
  void set_groups(std::vector<std::string> names);
  double& at(std::size_t i) { return values_[i]; }
  double at(std::size_t i) const { return values_[i]; }

 private:
  ChannelSpec spec_;
  DisplayedQuantity displayed_;
  int size_;
  bool single_;
  std::vector<std::string> groups_;
  std::vector<double> values_;
  std::optional<double> min_, max_;
  Bounds good_, high_;
  const Component* subject_ = nullptr;
};

/// One number for each step.
template <class Q>
class Channel : public ChannelBase {
 public:
  Channel(Component* owner, ChannelSpec spec)
      : ChannelBase(owner, spec, DisplayedQuantity::quantity_of<Q>(), 1, true) {}
  void set(double si) { at(0) = si; }
  double operator()() const { return at(0); }
};

/// Three numbers for each step, scene frame.
template <class Q>
class Channel<Vec<Q>> : public ChannelBase {
 public:
  Channel(Component* owner, ChannelSpec spec)
      : ChannelBase(owner, spec, DisplayedQuantity::quantity_of<Q>(), 3, true) {}
  void set(const Vec3& si) {
    for (int k = 0; k < 3; ++k) at(std::size_t(k)) = si[k];
  }
  Vec3 operator()() const { return {at(0), at(1), at(2)}; }
};

/// The same number for several similar things, such as the branches of a network. Their names are declared by
/// declare(), in connect() at the latest.
template <class Q>
class ChannelGroup : public ChannelBase {
 public:
  ChannelGroup(Component* owner, ChannelSpec spec)
      : ChannelBase(owner, spec, DisplayedQuantity::quantity_of<Q>(), 1, false) {}
  void declare(std::vector<std::string> names) { set_groups(std::move(names)); }
  void set(std::size_t item, double si) { at(item) = si; }
  double operator()(std::size_t item) const { return at(item); }
};

}  // namespace insula
