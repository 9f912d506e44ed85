// SPDX-License-Identifier: GPL-3.0-or-later
// Inventory of a scene for `insula view`: name, size with unit, and position of each part.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/sim/simulation.h"

namespace insula {

struct InventoryItem {
  std::string group;    ///< "body", "surface", "region", "anchor", "drawable", "contact pair", "constraint", "tool"
  std::string name;     ///< id; of a pair "a - b", of a region "artery: neck"
  std::string element;  ///< element of the scene file
  std::string size;     ///< measured, with units: "532 nodes, 61.2 x 40.0 x 33.1 mm, 54.1 g"
  std::vector<std::pair<std::string, std::string>> values;  ///< parameters as written in the scene, with their units
  std::string file;                                         ///< file and line: "scenes/a.xml:12"
  std::vector<Vec3> lines;   ///< pairs of points, scene frame, m: its shape, with fewer lines if it is large
  std::vector<Vec3> points;  ///< fixed nodes, m
};

/// The items in the groups above, each in document order, in the present state of the simulation.
std::vector<InventoryItem> inventory(const Simulation& simulation);

/// inventory.json of a bundle (docs/scene-bundle.md). Throws InputError if it cannot be written.
void write_inventory(const std::vector<InventoryItem>& items, const std::filesystem::path& file);

}  // namespace insula
