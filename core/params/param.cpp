// SPDX-License-Identifier: GPL-3.0-or-later
// Reads and checks the value of each kind of parameter.
#include "core/params/param.h"

#include <algorithm>
#include <charconv>
#include <stdexcept>

#include "core/base/text.h"
#include "core/params/number.h"

namespace insula {
namespace {

[[noreturn]] void bad_declaration(std::string_view param, const std::string& why) {
  throw std::logic_error("parameter \"" + std::string(param) + "\" is declared wrongly: " + why);
}

std::string out_of_range(std::string_view text, const std::optional<double>& min, const std::optional<double>& max,
                         const Unit* unit) {
  if (min && max)
    return shown(text) + " is outside the allowed range " + written(*min, unit) + " to " + written(*max, unit);
  if (min) return shown(text) + " is below the allowed minimum " + written(*min, unit);
  return shown(text) + " is above the allowed maximum " + written(*max, unit);
}

/// Moves `value` into [min, max] if it is outside by at most the rounding of its unit's factor.
bool within(double& value, const std::optional<double>& min, const std::optional<double>& max) {
  const auto slack = [](double bound) { return 1e-12 * std::abs(bound); };
  if (min && value < *min - slack(*min)) return false;
  if (max && value > *max + slack(*max)) return false;
  if (min) value = std::max(value, *min);
  if (max) value = std::min(value, *max);
  return true;
}

std::optional<double> declared_bound(const ParamSpec& spec, std::string_view bound, std::span<const Unit> units,
                                     std::string_view quantity) {
  if (bound.empty()) return std::nullopt;
  std::string error;
  const auto value = parse_quantity(bound, units, quantity, error);
  if (!value) bad_declaration(spec.name, error);
  return value;
}

}  // namespace

ParamBase* ParamSet::find_param(std::string_view name) const {
  for (ParamBase* p : params_)
    if (p->spec().name == name) return p;
  return nullptr;
}

const ParamBase* ParamSet::find_renamed_param(std::string_view former_name) const {
  for (const ParamBase* p : params_)
    if (!former_name.empty() && p->spec().formerly == former_name) return p;
  return nullptr;
}

ParamBase::ParamBase(ParamSet* owner, ParamSpec spec) : spec_(std::move(spec)) {
  if (spec_.name.empty() || spec_.name == "id") bad_declaration(spec_.name, "it needs a name other than \"id\"");
  if (!owner) bad_declaration(spec_.name, "it has no owner");
  if (owner->find_param(spec_.name)) bad_declaration(spec_.name, "the component has it twice");
  owner->params_.push_back(this);
}

std::string ParamBase::assign(std::string_view text, const SourcePos& pos) {
  given_ = true;
  pos_ = pos;
  text_ = text;
  return parse(trim(text));
}

bool ParamBase::assign_fallback() {
  if (!spec_.fallback) return false;
  text_ = *spec_.fallback;
  given_ = false;
  if (text_.empty()) return true;  // optional without a default: stays as constructed
  if (const std::string error = parse(trim(text_)); !error.empty())
    bad_declaration(spec_.name, "its default: " + error);
  return true;
}

QuantityParam::QuantityParam(ParamSet* owner, ParamSpec spec, std::string_view quantity, std::string_view si,
                             std::span<const Unit> units)
    : ParamBase(owner, std::move(spec)), quantity_(quantity), si_(si), units_(units) {
  min_ = declared_bound(this->spec(), this->spec().min, units, quantity);
  max_ = declared_bound(this->spec(), this->spec().max, units, quantity);
  if (min_ && max_ && *min_ > *max_) bad_declaration(this->spec().name, "its minimum is above its maximum");
}

std::string QuantityParam::parse(std::string_view text) {
  std::string error;
  const auto parsed = read_quantity(text, units_, quantity_, error);
  if (!parsed) return error;
  double value = parsed->si;
  if (!within(value, min_, max_)) return out_of_range(text, min_, max_, parsed->unit);
  value_ = value;
  return {};
}

VectorParam::VectorParam(ParamSet* owner, ParamSpec spec, std::string_view quantity, std::string_view si,
                         std::span<const Unit> units)
    : ParamBase(owner, std::move(spec)), quantity_(quantity), si_(si), units_(units) {
  declared_bound(this->spec(), this->spec().min, units, quantity);
  declared_bound(this->spec(), this->spec().max, units, quantity);
}

std::string VectorParam::parse(std::string_view text) {
  std::string error;
  const Unit* unit = nullptr;
  auto value = read_vector(text, units_, quantity_, unit, error);
  if (!value) return error;
  const auto min = declared_bound(spec(), spec().min, units_, quantity_);
  const auto max = declared_bound(spec(), spec().max, units_, quantity_);
  for (double& component : *value)
    if (!within(component, min, max)) return "each of " + out_of_range(text, min, max, unit);
  value_ = *value;
  return {};
}

std::string Param<bool>::parse(std::string_view text) {
  if (text != "true" && text != "false") return in_quotes(text) + " is neither \"true\" nor \"false\"";
  value_ = text == "true";
  return {};
}

std::string Param<int>::parse(std::string_view text) {
  const auto read = [](std::string_view t, int& out) {
    if (t.size() > 1 && t.front() == '+' && t[1] != '-') t.remove_prefix(1);
    return std::from_chars(t.data(), t.data() + t.size(), out);
  };
  int value = 0;
  const auto [end, code] = read(text, value);
  if (text.empty()) return "the value is empty";
  if (end != text.data() + text.size()) return in_quotes(text) + " is not a whole number";
  if (code == std::errc::result_out_of_range) return in_quotes(text) + " is too large a number";
  if (code != std::errc()) return in_quotes(text) + " is not a whole number";
  std::optional<double> min, max;
  for (const bool lower : {true, false}) {
    const std::string_view bound = lower ? spec().min : spec().max;
    if (bound.empty()) continue;
    int b = 0;
    const auto result = read(bound, b);
    if (result.ec != std::errc() || result.ptr != bound.data() + bound.size())
      bad_declaration(spec().name, "its bound \"" + std::string(bound) + "\" is not a whole number");
    (lower ? min : max) = b;
  }
  const auto plain = [](double bound) { return std::to_string(static_cast<int>(bound)); };
  if ((min && value < *min) || (max && value > *max)) {
    if (min && max) return shown(text) + " is outside the allowed range " + plain(*min) + " to " + plain(*max);
    if (min) return shown(text) + " is below the allowed minimum " + plain(*min);
    return shown(text) + " is above the allowed maximum " + plain(*max);
  }
  value_ = value;
  return {};
}

std::string Param<std::string>::parse(std::string_view text) {
  value_ = text;
  return {};
}

std::string Param<MaterialName>::parse(std::string_view text) {
  if (text.empty() && required()) return "the value is empty; it must name a material";
  value_ = text;
  return {};
}

std::string Param<Choice>::parse(std::string_view text) {
  const auto& choices = spec().choices;
  if (std::find(choices.begin(), choices.end(), text) == choices.end()) {
    const std::vector<std::string> names(choices.begin(), choices.end());
    const std::string near = nearest_name(text, names);
    const bool shown = text.size() <= 64;
    return in_quotes(text) + " is not a choice" + did_you_mean(shown ? near : "") + " (use one of " + joined(names) +
           ")";
  }
  value_ = text;
  return {};
}

std::string Param<File>::parse(std::string_view text) {
  if (text.empty() && required()) return "the value is empty; it must name a file";
  path_ = std::filesystem::path(std::string(text));
  return {};
}

std::string Param<LengthUnit>::parse(std::string_view text) {
  for (const auto& unit : Length::units()) {
    if (unit.symbol != text) continue;
    value_ = unit.to_si;
    return {};
  }
  return in_quotes(text) + " is not a unit of length (use one of " + unit_list(Length::units()) + ")";
}

RefParamBase::RefParamBase(ParamSet* owner, ParamSpec spec, std::string_view kind, bool list)
    : ParamBase(owner, std::move(spec)), kind_(kind), list_(list) {}

std::string RefParamBase::type_name() const {
  return (list_ ? "references to any number of " : "reference to ") +
         (list_ ? std::string(kind_) + " components" : with_article(kind_));
}

std::string RefParamBase::parse(std::string_view text) {
  const auto words = split_blanks(text);
  if (words.empty() && required()) return "the value is empty; it must name " + with_article(kind_);
  if (words.size() > 1 && !list_)
    return in_quotes(text) + " names " + std::to_string(words.size()) + " components; only one is allowed here";
  ids_.assign(words.begin(), words.end());
  return {};
}

}  // namespace insula
