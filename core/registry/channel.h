// SPDX-License-Identifier: GPL-3.0-or-later
// A component's channels: named numbers that it publishes each step, declared as parameters are. The frame, the report,
// the instructor's curves, the rules and the reference pages read channels and nothing else of a component.
//
//   class Suture final : public Constraint {
//     Channel<Force> tension{this, {.name = "tension", .doc = "of the thread", .min = "0 N", .max = "5 N"}};
//     void publish() override { tension.set(pull_); }
//   };
//
// Values are SI. A value that is not known now is NaN, which is also the value before the first `publish`.
#pragma once
#include <array>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/math.h"
#include "core/params/param.h"

namespace insula {

class Component;

/// Where people see a channel: nowhere, as a curve, or among the vital signs (and as a curve).
enum class Shown { none, curve, vital };
std::string_view shown_name(Shown shown);

/// What a picture of the channel's subject does with it: nothing; shade the region of the group's name by it (0..1);
/// beat with it as its phase (0..1).
enum class Role { none, shade, pulse };

/// From and to, written with units; an empty bound is open. Both empty: no band.
struct Band {
  std::string_view from = {}, to = {};
};

struct ChannelSpec {
  std::string_view name;
  std::string_view doc;       ///< one line
  std::string_view min = {};  ///< expected range, written with units; empty: open
  std::string_view max = {};
  Shown shown = Shown::curve;
  std::string_view display = {};  ///< unit that people read, one of the quantity's; "%" for a plain number; empty: SI
  int digits = 2;                 ///< behind the point, in that unit
  Band good = {};                 ///< shown green inside
  Band high = {};                 ///< shown amber inside; outside of both: red
  Role role = Role::none;
};

/// Base of every channel: what frame, report and reference read.
class ChannelBase {
 public:
  struct Quantity {
    std::string_view name, si;
    std::span<const Unit> units;
  };
  /// Throws std::logic_error for a wrong declaration. `single`: one channel; else one for each name of declare().
  ChannelBase(Component* owner, ChannelSpec spec, Quantity quantity, int size, bool single);
  ChannelBase(const ChannelBase&) = delete;
  ChannelBase& operator=(const ChannelBase&) = delete;

  const ChannelSpec& spec() const { return spec_; }
  const Quantity& quantity() const { return quantity_; }
  int size() const { return size_; }  ///< numbers of a value: 1, or 3 for a vector
  bool single() const { return single_; }
  /// The things it belongs to; one with an empty name for a single channel.
  const std::vector<std::string>& groups() const { return groups_; }
  /// "flow", or "superior.flow" of the group "superior".
  std::string name(std::size_t item) const;
  const double* values(std::size_t item) const { return values_.data() + item * std::size_t(size_); }
  /// The body that the numbers are about, for its picture; null: none in particular.
  const Component* subject() const { return subject_; }
  void set_subject(const Component* body) { subject_ = body; }
  /// Makes every value unknown.
  void reset();

  std::optional<double> min() const { return min_; }  ///< SI
  std::optional<double> max() const { return max_; }
  void set_max(double si) { max_ = si; }  ///< for what is only known once the scene is there, such as a count
  using Bounds = std::array<std::optional<double>, 2>;
  const Bounds& good() const { return good_; }  ///< SI
  const Bounds& high() const { return high_; }
  std::string_view display_unit() const;           ///< as people read it, may be empty
  double display_scale() const { return scale_; }  ///< shown number = SI value * scale
  /// A value as people read it, with its unit.
  std::string text(double si) const;

 protected:
  void set_groups(std::vector<std::string> names);
  double& at(std::size_t i) { return values_[i]; }
  double at(std::size_t i) const { return values_[i]; }

 private:
  ChannelSpec spec_;
  Quantity quantity_;
  int size_;
  bool single_;
  std::vector<std::string> groups_;
  std::vector<double> values_;
  std::optional<double> min_, max_;
  Bounds good_, high_;
  double scale_ = 1;
  const Component* subject_ = nullptr;
};

/// One number a step.
template <class Q>
class Channel : public ChannelBase {
 public:
  Channel(Component* owner, ChannelSpec spec)
      : ChannelBase(owner, std::move(spec), {Q::name, Q::si, Q::units()}, 1, true) {}
  void set(double si) { at(0) = si; }
  double operator()() const { return at(0); }
};

/// Three numbers a step, scene frame.
template <class Q>
class Channel<Vec<Q>> : public ChannelBase {
 public:
  Channel(Component* owner, ChannelSpec spec)
      : ChannelBase(owner, std::move(spec), {Q::name, Q::si, Q::units()}, 3, true) {}
  void set(const Vec3& si) {
    for (int k = 0; k < 3; ++k) at(std::size_t(k)) = si[k];
  }
  Vec3 operator()() const { return {at(0), at(1), at(2)}; }
};

/// The same number of several like things, such as the branches of a network. Their names are known once the component
/// is connected: declare() them there, at the latest in connect().
template <class Q>
class ChannelGroup : public ChannelBase {
 public:
  ChannelGroup(Component* owner, ChannelSpec spec)
      : ChannelBase(owner, std::move(spec), {Q::name, Q::si, Q::units()}, 1, false) {}
  void declare(std::vector<std::string> names) { set_groups(std::move(names)); }
  void set(std::size_t item, double si) { at(item) = si; }
  double operator()(std::size_t item) const { return at(item); }
};

}  // namespace insula
