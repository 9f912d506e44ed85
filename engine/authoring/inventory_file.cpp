// SPDX-License-Identifier: GPL-3.0-or-later
// The inventory in the form that the page reads.
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/base/input_error.h"
#include "engine/authoring/inventory.h"

namespace insula {
namespace {

using Json = nlohmann::ordered_json;

/// A resolution of 0.01 mm is enough for a highlight.
Json flat(const std::vector<Vec3>& points) {
  Json out = Json::array();
  for (const Vec3& p : points)
    for (int k = 0; k < 3; ++k) out.push_back(double(std::lround(p[k] * 1e5)) / 1e5);
  return out;
}

}  // namespace

void write_inventory(const std::vector<InventoryItem>& items, const std::filesystem::path& file) {
  Json json = Json::array();
  for (const InventoryItem& item : items) {
    Json values = Json::array();
    for (const auto& [name, text] : item.values) values.push_back({name, text});
    json.push_back({{"group", item.group},
                    {"name", item.name},
                    {"element", item.element},
                    {"size", item.size},
                    {"values", values},
                    {"file", item.file},
                    {"lines_m", flat(item.lines)},
                    {"points_m", flat(item.points)}});
  }
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out << Json{{"items", json}}.dump(-1, ' ', false, Json::error_handler_t::replace) << '\n';
  out.close();
  if (!out) throw InputError(file.string() + ": cannot be written");
}

}  // namespace insula
