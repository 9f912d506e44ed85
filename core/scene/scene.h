// SPDX-License-Identifier: GPL-3.0-or-later
// The root of a loaded scene. Every component is checked, prepared and owned; references are resolved.
#pragma once
#include <filesystem>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "core/params/param.h"
#include "core/registry/component.h"
#include "core/registry/material.h"

namespace insula {

class Registry;

class Scene final : public Component {
 public:
  static constexpr std::string_view kind_name = "scene";

  Param<std::string> title{this,
                           {.name = "title", .fallback = "", .doc = "what the window and the reports call the scene"}};
  Param<Duration> time_step{this,
                            {.name = "time_step",
                             .fallback = "16.6667 ms",
                             .min = "1 ms",
                             .max = "50 ms",
                             .doc = "length of one step; the default is a 60th of a second"}};
  Param<Vec<Acceleration>> gravity{
      this,
      {.name = "gravity",
       .fallback = "0 0 0 m/s2",
       .min = "-100 m/s2",
       .max = "100 m/s2",
       .doc = "acceleration of every body; none by default, as the brain floats in its fluid"}};
  Param<int> seed{this,
                  {.name = "seed",
                   .fallback = "1",
                   .min = "0",
                   .max = "2147483647",
                   .doc = "start of every random choice; the same seed gives the same run"}};

  /// Components of C++ type T of the whole tree, in document order.
  template <class T>
  std::vector<T*> all() const {
    std::vector<T*> out;
    for (Component* c : in_order_)
      if (auto* t = dynamic_cast<T*>(c)) out.push_back(t);
    return out;
  }
  /// Every component below the scene, in document order.
  const std::vector<Component*>& components() const { return in_order_; }
  /// The component of that id (for parts included with a prefix: prefix and id); null when there is none.
  Component* find(std::string_view id) const;
  template <class T>
  T* find_as(std::string_view wanted) const {
    return dynamic_cast<T*>(find(wanted));
  }

  /// The materials of the registry, then those of the scene's <material> elements.
  const std::vector<Material>& materials() const { return materials_; }

  const std::filesystem::path& file() const { return file_; }                ///< as it was given to the loader
  const std::filesystem::path& root_folder() const { return root_folder_; }  ///< a scene may name no file outside of it
  /// FNV-1a over the scene file, the included files and every file that a parameter names, in the order read.
  unsigned long long content_hash() const { return content_hash_; }

 private:
  friend class SceneBuilder;
  std::vector<Component*> in_order_;
  std::map<std::string, Component*, std::less<>> by_id_;
  std::vector<Material> materials_;
  std::filesystem::path file_, root_folder_;
  unsigned long long content_hash_ = 0;
};

/// Adds <scene> to the registry, so that list, describe, schema and docs know it.
void register_scene(Registry& registry);

}  // namespace insula
