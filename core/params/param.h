// SPDX-License-Identifier: GPL-3.0-or-later
// A component's parameters. Each is declared once as a member. Its name, default, range, unit and doc serve reading,
// validation, the schema, the reference pages and the bounds tests.
//
//   class CorotationalFem final : public ForceModel {
//     Param<Pressure> young{this, {.name = "young", .fallback = "2100 Pa", .min = "1 Pa", .max = "1 GPa",
//                                  .doc = "Young's modulus of the tissue"}};
//   };  ... young() is then the value in SI.
//
// A parameter without a fallback is required. `min` and `max` are inclusive and written with units, as an author would
// write them.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/diagnostic.h"
#include "core/base/math.h"
#include "core/params/param_set.h"
#include "core/params/quantity.h"

namespace insula {

struct ParamSpec {
  std::string_view name;
  std::optional<std::string_view> fallback = std::nullopt;  ///< as written in a scene; none: required
  std::string_view min = {};
  std::string_view max = {};
  std::vector<std::string_view> choices = {};  ///< for Param<Choice>
  std::string_view doc;                        ///< one line
  std::string_view formerly = {};              ///< name in older scenes, which get a message with the new one
};

/// Base of every parameter, with the data for list, describe, schema and docs.
class ParamBase {
 public:
  ParamBase(ParamSet* owner, ParamSpec spec);
  virtual ~ParamBase() = default;
  ParamBase(const ParamBase&) = delete;
  ParamBase& operator=(const ParamBase&) = delete;

  const ParamSpec& spec() const { return spec_; }
  std::string name() const { return std::string(spec_.name); }
  bool required() const { return !spec_.fallback; }
  bool given() const { return given_; }              ///< written in the scene
  const SourcePos& pos() const { return pos_; }      ///< of the value in the scene
  const std::string& text() const { return text_; }  ///< as written (or the fallback)

  /// Parses and range-checks. Returns the error text, empty when the value was accepted.
  std::string assign(std::string_view text, const SourcePos& pos);
  /// Sets the default; returns false when there is none.
  bool assign_fallback();

  virtual std::string type_name() const = 0;          ///< "pressure", "text", "reference to body", ...
  virtual std::string_view si() const { return ""; }  ///< SI symbol, empty when none
  virtual std::span<const Unit> units() const { return {}; }
  virtual std::string_view ref_kind() const { return ""; }  ///< kind name when this names other components
  virtual bool is_list() const { return false; }

 protected:
  virtual std::string parse(std::string_view text) = 0;  ///< returns the error text or empty

 private:
  ParamSpec spec_;
  SourcePos pos_;
  std::string text_;
  bool given_ = false;
};

/// Reads "12.5 kPa" as a whole: no trailing characters, no decimal comma, finite. Returns none on failure, with the
/// error text in `error`.
std::optional<double> parse_quantity(std::string_view text, std::span<const Unit> units, std::string_view quantity_name,
                                     std::string& error);

class QuantityParam : public ParamBase {
 public:
  QuantityParam(ParamSet* owner, ParamSpec spec, std::string_view quantity, std::string_view si,
                std::span<const Unit> units);
  double operator()() const { return value_; }
  void set(double value) { value_ = value; }  ///< in SI; for tests and tools; the range is not checked
  std::string type_name() const override { return std::string(quantity_); }
  std::string_view si() const override { return si_; }
  std::span<const Unit> units() const override { return units_; }
  std::optional<double> min() const { return min_; }  ///< SI
  std::optional<double> max() const { return max_; }

 protected:
  std::string parse(std::string_view text) override;

 private:
  std::string_view quantity_, si_;
  std::span<const Unit> units_;
  std::optional<double> min_, max_;
  double value_ = 0;
};

template <class Q>
class Param : public QuantityParam {
 public:
  Param(ParamSet* owner, ParamSpec spec) : QuantityParam(owner, std::move(spec), Q::name, Q::si, Q::units()) {}
};

template <>
class Param<bool> : public ParamBase {  // "true" | "false"
 public:
  using ParamBase::ParamBase;
  bool operator()() const { return value_; }
  void set(bool v) { value_ = v; }
  std::string type_name() const override { return "true or false"; }

 protected:
  std::string parse(std::string_view text) override;

 private:
  bool value_ = false;
};

template <>
class Param<int> : public ParamBase {  // whole number, min/max as plain numbers
 public:
  using ParamBase::ParamBase;
  int operator()() const { return value_; }
  void set(int v) { value_ = v; }
  std::string type_name() const override { return "whole number"; }

 protected:
  std::string parse(std::string_view text) override;

 private:
  int value_ = 0;
};

template <>
class Param<std::string> : public ParamBase {  // free text
 public:
  using ParamBase::ParamBase;
  const std::string& operator()() const { return value_; }
  void set(std::string v) { value_ = std::move(v); }
  std::string type_name() const override { return "text"; }

 protected:
  std::string parse(std::string_view text) override;

 private:
  std::string value_;
};

struct Choice {};
template <>
class Param<Choice> : public ParamBase {  // one of spec.choices; compare with operator==
 public:
  using ParamBase::ParamBase;
  const std::string& operator()() const { return value_; }
  bool is(std::string_view v) const { return value_ == v; }
  void set(std::string v) { value_ = std::move(v); }
  std::string type_name() const override { return "choice"; }

 protected:
  std::string parse(std::string_view text) override;

 private:
  std::string value_;
};

/// Three numbers and one unit: "38 0 -15 mm". For Q = Scalar (a direction) no unit.
class VectorParam : public ParamBase {
 public:
  VectorParam(ParamSet* owner, ParamSpec spec, std::string_view quantity, std::string_view si,
              std::span<const Unit> units);
  const Vec3& operator()() const { return value_; }
  void set(const Vec3& v) { value_ = v; }
  std::string type_name() const override { return "three numbers (" + std::string(quantity_) + ")"; }
  std::string_view si() const override { return si_; }
  std::span<const Unit> units() const override { return units_; }

 protected:
  std::string parse(std::string_view text) override;

 private:
  std::string_view quantity_, si_;
  std::span<const Unit> units_;
  Vec3 value_ = Vec3::Zero();
};

template <class Q>
struct Vec {};
template <class Q>
class Param<Vec<Q>> : public VectorParam {
 public:
  Param(ParamSet* owner, ParamSpec spec) : VectorParam(owner, std::move(spec), Q::name, Q::si, Q::units()) {}
};

/// A file beside the scene, relative to the file that names it. It must exist, be a regular file and lie in the scene's
/// root folder. The loader checks this: absolute paths and paths that leave the root are errors.
struct File {};
template <>
class Param<File> : public ParamBase {
 public:
  using ParamBase::ParamBase;
  const std::filesystem::path& operator()() const { return path_; }  ///< resolved by the loader
  void set(std::filesystem::path p) { path_ = std::move(p); }
  bool empty() const { return path_.empty(); }
  std::string type_name() const override { return "file"; }

 protected:
  std::string parse(std::string_view text) override;

 private:
  std::filesystem::path path_;
};

/// The name of a material (core/registry/material.h); the loader checks that the registry or the scene has it.
struct MaterialName {};
template <>
class Param<MaterialName> : public ParamBase {
 public:
  using ParamBase::ParamBase;
  const std::string& operator()() const { return value_; }
  void set(std::string v) { value_ = std::move(v); }
  std::string type_name() const override { return "material"; }

 protected:
  std::string parse(std::string_view text) override;

 private:
  std::string value_;
};

/// A length unit for mesh files: "mm", "cm", "m". Value: metres per file unit.
struct LengthUnit {};
template <>
class Param<LengthUnit> : public ParamBase {
 public:
  using ParamBase::ParamBase;
  double operator()() const { return value_; }
  void set(double v) { value_ = v; }
  std::string type_name() const override { return "unit of length"; }

 protected:
  std::string parse(std::string_view text) override;

 private:
  double value_ = 0;
};

/// Names of other components, separated by blanks. The loader resolves them after everything is read.
class RefParamBase : public ParamBase {
 public:
  RefParamBase(ParamSet* owner, ParamSpec spec, std::string_view kind, bool list);
  std::string type_name() const override;
  std::string_view ref_kind() const override { return kind_; }
  bool is_list() const override { return list_; }
  const std::vector<std::string>& ids() const { return ids_; }
  /// Loader only: the component found for ids()[i]; a message when its type does not fit, else empty.
  virtual std::string resolve(std::size_t i, ParamSet* target) = 0;

 protected:
  std::string parse(std::string_view text) override;
  std::vector<std::string> ids_;

 private:
  std::string_view kind_;
  bool list_;
};

/// Reference to one component of C++ type T (T::kind_name is its name in messages). Null when optional and not given.
template <class T>
class Ref : public RefParamBase {
 public:
  Ref(ParamSet* owner, ParamSpec spec) : RefParamBase(owner, std::move(spec), T::kind_name, false) {}
  T* get() const { return target_; }
  T* operator->() const { return target_; }
  T& operator*() const { return *target_; }
  explicit operator bool() const { return target_ != nullptr; }
  void set(T* t) { target_ = t; }
  std::string resolve(std::size_t, ParamSet* target) override {
    target_ = dynamic_cast<T*>(target);
    return target_ ? "" : std::string("is not a ") + std::string(T::kind_name);
  }

 private:
  T* target_ = nullptr;
};

/// Reference to several components of type T, in the order written.
template <class T>
class RefList : public RefParamBase {
 public:
  RefList(ParamSet* owner, ParamSpec spec) : RefParamBase(owner, std::move(spec), T::kind_name, true) {}
  const std::vector<T*>& operator()() const { return targets_; }
  void set(std::vector<T*> t) { targets_ = std::move(t); }
  std::string resolve(std::size_t i, ParamSet* target) override {
    T* t = dynamic_cast<T*>(target);
    if (!t) return std::string("is not a ") + std::string(T::kind_name);
    if (targets_.size() <= i) targets_.resize(i + 1, nullptr);
    targets_[i] = t;
    return "";
  }

 private:
  std::vector<T*> targets_;
};

}  // namespace insula
