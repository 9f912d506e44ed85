// SPDX-License-Identifier: GPL-3.0-or-later
// Parameters that are lists of numbers: "1 3 7 day" with one unit at the end, as three numbers have it, or whole
// numbers "11 12 13". The range is that of each number.
#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/params/param.h"

namespace insula {

class QuantityListParam : public ParamBase {
 public:
  QuantityListParam(ParamSet* owner, ParamSpec spec, std::string_view quantity, std::string_view si,
                    std::span<const Unit> units);
  const std::vector<double>& operator()() const { return values_; }  ///< SI
  std::string type_name() const override { return "numbers (" + std::string(quantity_) + ")"; }
  std::string_view quantity() const { return quantity_; }
  std::string_view si() const override { return si_; }
  std::span<const Unit> units() const override { return units_; }
  bool is_list() const override { return true; }

 protected:
  std::string parse(std::string_view text) override;

 private:
  std::string_view quantity_, si_;
  std::span<const Unit> units_;
  std::vector<double> values_;
};

template <class T>
struct List {};
template <class Q>
class Param<List<Q>> : public QuantityListParam {
 public:
  Param(ParamSet* owner, ParamSpec spec) : QuantityListParam(owner, std::move(spec), Q::name, Q::si, Q::units()) {}
};

template <>
class Param<List<int>> : public ParamBase {  // min/max as plain numbers
 public:
  using ParamBase::ParamBase;
  const std::vector<int>& operator()() const { return values_; }
  std::string type_name() const override { return "whole numbers"; }
  bool is_list() const override { return true; }

 protected:
  std::string parse(std::string_view text) override;

 private:
  std::vector<int> values_;
};

}  // namespace insula
