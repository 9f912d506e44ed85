// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a shell's surface and separates its wall from its caps.
#include "core/mechanics/shell_body.h"

#include <algorithm>

#include "core/base/input_error.h"

namespace insula {

void ShellBody::set_mesh(TriMesh m) {
  WallModel model;
  model.wall = std::move(m);
  set_model(std::move(model));
}

void ShellBody::set_model(WallModel m) {
  model_ = std::move(m);
  given_ = true;
}

void ShellBody::prepare(PrepareContext& context) {
  if (!given_) {
    if (wall.empty() == mesh.empty()) return error(context, "a shell needs a wall or a mesh, one of the two");
    try {
      if (!wall.empty()) model_ = read_wall(wall());
      else model_.wall = read_surface(mesh(), mesh_unit());
    } catch (const InputError& e) {
      return wall.empty() ? error(context, mesh, e.what()) : error(context, wall, e.what());
    }
  }
  finish_model();
  start_at_rest();
}

void ShellBody::finish_model() {
  if (model_.regions.empty()) {
    model_.regions = {"wall"};
    model_.vertex_region.assign(model_.wall.vertices.size(), 0);
  }
  std::vector<char> cap(model_.wall.triangles.size(), 0);
  for (const auto& c : model_.caps)
    for (int t : c.triangles) cap[std::size_t(t)] = 1;
  wall_.clear();
  for (std::size_t t = 0; t < cap.size(); ++t)
    if (!cap[t]) wall_.push_back(model_.wall.triangles[t]);
}

void ShellBody::fix_own_nodes(std::vector<char>& fixed) const {
  for (const auto& c : model_.caps)
    for (int t : c.triangles)
      for (int v : model_.wall.triangles[std::size_t(t)]) fixed[std::size_t(v)] = 1;
}

int ShellBody::region(std::string_view name) const {
  for (std::size_t i = 0; i < model_.regions.size(); ++i)
    if (model_.regions[i] == name) return int(i);
  return -1;
}

int ShellBody::region_of_triangle(const std::array<int, 3>& t) const {
  const auto r = [&](int k) { return model_.vertex_region[std::size_t(t[std::size_t(k)])]; };
  if (r(0) == r(1) || r(0) == r(2)) return r(0);
  if (r(1) == r(2)) return r(1);
  return std::min({r(0), r(1), r(2)});
}

}  // namespace insula
