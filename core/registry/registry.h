// SPDX-License-Identifier: GPL-3.0-or-later
// All elements. Plugins register themselves in an explicit function. Nothing registers as a side effect of linking.
#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "core/registry/component.h"
#include "core/registry/material.h"
#ifdef INSULA_PLUGIN_SHARED
#include "core/registry/abi.h"
#endif

namespace insula {

struct ComponentInfo {
  std::string element;  ///< unique element name
  Kind kind = Kind::constraint;
  std::string doc;            ///< one line
  std::vector<Kind> parents;  ///< kinds of component that may contain it
  std::string plugin;         ///< folder name of the plugin that registered it, or "core"
  std::function<std::unique_ptr<Component>()> create;
};

class Registry {
 public:
  /// Adds T as <element>. Its kind determines its parents: body, constraint, instrument, settings and exercise in the
  /// scene; force_model, support and surface in a body; rules, metrics and motions in an exercise;
  /// conditions in a support. Throws std::logic_error when the element name is taken.
  template <class T>
  void add(std::string_view element, Kind kind, std::string_view doc) {
    add_info({std::string(element), kind, std::string(doc), {}, current_plugin_, [] { return std::make_unique<T>(); }});
  }
  void add_info(ComponentInfo info);

  /// Adds a material that scenes may name. Throws std::logic_error when the name is taken.
  void add_material(Material material);
  const std::vector<Material>& materials() const { return materials_; }  ///< in order of registration

  const ComponentInfo* find(std::string_view element) const;
  std::vector<const ComponentInfo*> all() const;                      ///< by kind, then name
  std::unique_ptr<Component> create(std::string_view element) const;  ///< with defaults in place; null when unknown

  void set_current_plugin(std::string_view name) { current_plugin_ = name; }

 private:
  std::map<std::string, ComponentInfo, std::less<>> infos_;
  std::vector<Material> materials_;
  std::string current_plugin_ = "core";
};

/// Registers the elements of core and of every built-in plugin, in alphabetical order.
void register_builtin(Registry& registry);

/// Loads a shared plugin. Checks its ABI string before any other call. Returns the error text, empty when loaded.
std::string load_plugin(Registry& registry, const std::filesystem::path& so);

/// ABI identity: the headers' text, compiler, C++ library, Eigen alignment. A plugin and a program with equal strings
/// are compatible.
const char* abi_string();

}  // namespace insula

/// At file scope of a plugin's .cpp: INSULA_PLUGIN(contact) { registry.add<Contact>("contact", ...); }
#ifdef INSULA_PLUGIN_SHARED
#define INSULA_PLUGIN(name)                                                                                       \
  static void insula_register_##name(::insula::Registry& registry);                                               \
  extern "C" __attribute__((visibility("default"))) const char* insula_plugin_abi() { return INSULA_ABI_STRING; } \
  extern "C" __attribute__((visibility("default"))) const char* insula_plugin_name() { return #name; }            \
  extern "C" __attribute__((visibility("default"))) void insula_plugin_register(::insula::Registry* r) {          \
    insula_register_##name(*r);                                                                                   \
  }                                                                                                               \
  static void insula_register_##name(::insula::Registry& registry)
#else
#define INSULA_PLUGIN(name) void insula_register_##name(::insula::Registry& registry)
#endif
