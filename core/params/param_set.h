// SPDX-License-Identifier: GPL-3.0-or-later
// The parameters that one object declares as members. Each registers itself here, in order of declaration.
#pragma once
#include <string_view>
#include <vector>

namespace insula {

class ParamBase;

class ParamSet {
 public:
  ParamSet() = default;
  virtual ~ParamSet() = default;  ///< polymorphic, so that references can check the type of their targets
  ParamSet(const ParamSet&) = delete;
  ParamSet& operator=(const ParamSet&) = delete;

  const std::vector<ParamBase*>& params() const { return params_; }  ///< in order of declaration
  /// The parameter of that name; null when there is none.
  ParamBase* find_param(std::string_view name) const;
  /// The parameter that had this name in older scenes (ParamSpec::formerly); null when there is none.
  const ParamBase* find_renamed_param(std::string_view former_name) const;

 private:
  friend class ParamBase;
  std::vector<ParamBase*> params_;
};

}  // namespace insula
