// SPDX-License-Identifier: GPL-3.0-or-later
// Choice of triangles, and the rows of their vertices.
#include "core/haptics/surface_patch_builder.h"

#include <algorithm>

#include "core/constraint/problem_fields.h"
#include "core/haptics/condense.h"
#include "core/haptics/patch_collider.h"
#include "core/linalg/body_solver.h"
#include "core/mechanics/deformable_body.h"

namespace insula {
namespace {

constexpr std::size_t most_offers = 600;  // that are looked at
constexpr int rows_for_modes = 8;         // whose place in the message a reduced model and the laws of failure take

bool moves(const Surface& s) { return s.body().blocks() > 0; }

int tool_index(const ConstraintProblem& p, const RigidBody* tool) {
  const auto* instrument = dynamic_cast<const Instrument*>(tool);
  for (std::size_t t = 0; instrument && t < p.tools.size(); ++t)
    if (p.tools[t].hand == instrument->hand_index()) return int(t);
  return -1;
}

}  // namespace

bool SurfacePatchBuilder::usable(const PatchCandidate& c) const {
  if (!moves(*c.surface)) return true;
  auto* body = dynamic_cast<DeformableBody*>(&c.surface->body());
  return body && body->solver() && body->solver()->has_second_rows();
}

int SurfacePatchBuilder::index_of(const Surface& surface, int vertex) const {
  for (std::size_t i = 0; i < vertices_.size(); ++i)
    if (vertices_[i].vertex == vertex && vertices_[i].surface == &surface) return int(i);
  return -1;
}

// Takes triangles by distance, as long as there is room for their vertices.
void SurfacePatchBuilder::choose(int moving_vertices) {
  order_.clear();
  for (std::size_t c = 0; c < candidates_.size(); ++c)
    for (const PatchCandidate::Triangle& t : candidates_[c].triangles) order_.push_back({c, t.triangle, t.clear_m});
  const auto nearer = [](const Chosen& a, const Chosen& b) {
    if (a.clear_m != b.clear_m) return a.clear_m < b.clear_m;
    return a.candidate != b.candidate ? a.candidate < b.candidate : a.triangle < b.triangle;
  };
  if (order_.size() > most_offers) {
    std::nth_element(order_.begin(), order_.begin() + most_offers, order_.end(), nearer);
    order_.resize(most_offers);
  }
  std::sort(order_.begin(), order_.end(), nearer);
  chosen_.clear();
  vertices_.clear();
  int moving = 0, fixed = 0;
  std::vector<std::size_t> count(candidates_.size(), 0);
  for (const Chosen& o : order_) {
    const Surface& surface = *candidates_[o.candidate].surface;
    const bool taken = std::any_of(chosen_.begin(), chosen_.end(), [&](const Chosen& k) {
      return k.candidate == o.candidate && k.triangle == o.triangle;
    });
    if (taken || count[o.candidate] == PatchCollider::most_triangles || chosen_.size() == SurfacePatches::max_triangles)
      continue;
    const auto& corner = surface.triangles()[std::size_t(o.triangle)];
    const auto fresh =
        int(std::count_if(corner.begin(), corner.end(), [&](int v) { return index_of(surface, v) < 0; }));
    int& used = moves(surface) ? moving : fixed;
    if (used + fresh > (moves(surface) ? moving_vertices : most_fixed_vertices)) continue;
    used += fresh;
    for (int v : corner)
      if (index_of(surface, v) < 0) vertices_.push_back({&surface, v});
    ++count[o.candidate];
    chosen_.push_back(o);
  }
  std::sort(chosen_.begin(), chosen_.end(), [](const Chosen& a, const Chosen& b) {
    return a.candidate != b.candidate ? a.candidate < b.candidate : a.triangle < b.triangle;
  });
}

void SurfacePatchBuilder::add_vertices(int row) {
  for (const Vertex& v : vertices_) {
    PatchVertex& to = patches_.vertices.emplace_back();
    to.position = moves(*v.surface) ? v.surface->body().position(v.surface->points()[std::size_t(v.vertex)])
                                    : v.surface->positions()[std::size_t(v.vertex)];
    const bool curved = std::any_of(candidates_.begin(), candidates_.end(), [&](const PatchCandidate& c) {
      return c.surface == v.surface && c.law.curved != 0;
    });
    if (curved) to.weighted_normal = v.surface->collision().weighted_normal(v.vertex);
    if (!v.surface->body().can_move(v.surface->points()[std::size_t(v.vertex)])) continue;
    to.row = row;
    row += 3;
  }
}

void SurfacePatchBuilder::add_patch(const ConstraintProblem& step, std::size_t candidate) {
  const PatchCandidate& c = candidates_[candidate];
  const Surface& surface = *c.surface;
  const auto of_patch = [&](const Chosen& k) { return k.candidate == candidate; };
  const auto first = std::find_if(chosen_.begin(), chosen_.end(), of_patch);
  if (first == chosen_.end() || patches_.patches.size() == SurfacePatches::max_patches ||
      patches_.pieces.size() + c.pieces.size() > SurfacePatches::max_pieces ||
      patches_.core.size() + c.core.size() > SurfacePatches::max_core)
    return;
  const auto last = std::find_if_not(first, chosen_.end(), of_patch);
  SurfacePatch patch = c.law;
  patch.tool = tool_index(step, c.tool);
  patch.first_triangle = int(patches_.triangles.size());
  patch.triangles = int(last - first);
  const auto place_of = [&](int triangle) {
    const auto at = std::lower_bound(first, last, triangle, [](const Chosen& k, int t) { return k.triangle < t; });
    return at != last && at->triangle == triangle ? int(at - first) : -1;
  };
  for (auto k = first; k != last; ++k) {
    PatchTriangle& to = patches_.triangles.emplace_back();
    for (std::size_t i = 0; i < 3; ++i) {
      to.corner[i] = std::int16_t(index_of(surface, surface.triangles()[std::size_t(k->triangle)][i]));
      const int across = surface.collision().across(k->triangle, int(i));
      if (across >= 0 && place_of(across) < 0) to.open |= std::uint8_t(1u << i);
    }
  }
  patch.first_piece = int(patches_.pieces.size());
  patch.pieces = int(c.pieces.size());
  for (PatchPiece piece : c.pieces) {
    piece.first_core += int(patches_.core.size());
    patches_.pieces.push_back(piece);
  }
  patches_.core.insert(patches_.core.end(), c.core.begin(), c.core.end());
  patch.first_replaced = int(patches_.replaced.size());
  for (const PatchCandidate::Contact& x : c.contacts) {
    const int place = place_of(x.triangle);
    if (place < 0 || patches_.replaced.size() == SurfacePatches::max_replaced) continue;
    patches_.replaced.push_back({x.row, x.piece, patch.first_triangle + place, x.bary});
    ++patch.replaced;
  }
  patches_.patches.push_back(patch);
}

/// Copies the step's problem and adds the vertices' rows, without their W.
void SurfacePatchBuilder::extend(const ConstraintProblem& step) {
  int rows = step.rows;
  for (const PatchVertex& v : patches_.vertices) rows += v.row >= 0 ? 3 : 0;
  ConstraintProblem& p = extended_;
  p.resize(rows);
  copy_scalars(step, p);
  for (int i = 0; i < step.rows; ++i) {
    copy_row(step, std::size_t(i), p, std::size_t(i));
    std::copy_n(step.w.begin() + std::ptrdiff_t(i) * step.stride, step.rows,
                p.w.begin() + std::ptrdiff_t(i) * p.stride);
  }
  p.blocks.assign(step.blocks.begin(), step.blocks.end());
  p.tools.resize(step.tools.size());
  for (std::size_t t = 0; t < step.tools.size(); ++t) {
    p.tools[t].coupling() = step.tools[t];
    p.tools[t].jacobian.setZero(rows, 6);
    p.tools[t].jacobian.topRows(step.rows) = step.tools[t].jacobian;
  }
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    const int row = patches_.vertices[i].row;
    if (row < 0) continue;
    const Surface& s = *vertices_[i].surface;
    const double time = s.body().retardation_time(s.points()[std::size_t(vertices_[i].vertex)]);
    for (int k = 0; k < 3; ++k) {
      Block b;
      b.id = row_id(s, std::uint64_t(1) << 43 | std::uint64_t(3 * vertices_[i].vertex + k));
      b.owner = s.order;
      b.role = BlockRole::surface;
      b.row = row + k;
      b.lower = b.upper = 0;
      p.blocks.push_back(b);
      p.retardation_time[std::size_t(row + k)] = time;
    }
  }
  p.patches = patches_;
}

void SurfacePatchBuilder::add_compliance(const ConstraintProblem& step) {
  ConstraintProblem& p = extended_;
  const std::size_t n = std::size_t(p.rows), f = std::size_t(step.rows), stride = std::size_t(p.stride);
  w_.assign(n * stride, 0.0);
  own_.assign(n, 0.0);
  for (std::size_t i = 0; i < vertices_.size(); ++i) {
    auto* body = dynamic_cast<DeformableBody*>(&vertices_[i].surface->body());
    if (patches_.vertices[i].row >= 0 && std::find(bodies_.begin(), bodies_.end(), body) == bodies_.end())
      bodies_.push_back(body);
  }
  for (DeformableBody* body : bodies_) {
    body_rows_ = body->rows;
    vertex_rows_.clear();
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      const Surface& s = *vertices_[i].surface;
      if (&s.body() != body || patches_.vertices[i].row < 0) continue;
      for (int k = 0; k < 3; ++k)
        for (BodyRows* rows : {&body_rows_, &vertex_rows_}) {
          rows->open(patches_.vertices[i].row + k);
          body->add_row(*rows, s.points()[std::size_t(vertices_[i].vertex)], Vec3::Unit(k));
        }
    }
    BodySolver& solver = *body->solver();
    solver.exchange_rows();
    body->begin_compliance(body_rows_);
    solver.compute_parts();
    for (std::size_t i = 0; i < n; ++i) own_[i] = -w_[i * stride + i];
    solver.add_compliance(body_rows_, w_.data(), p.stride);
    for (std::size_t i = 0; i < n; ++i) own_[i] += w_[i * stride + i];
    solver.exchange_rows();
    body->add_rate(vertex_rows_, p.rate.data());
    reduced_.add(*body, body_rows_, own_, p);
  }
  for (std::size_t i = f; i < n; ++i)
    for (std::size_t j = 0; j < n; ++j) {
      p.w[i * stride + j] = w_[i * stride + j];
      p.w[j * stride + i] = w_[i * stride + j];
      if (j < f) p.delta_free[i] -= w_[i * stride + j] * step.lambda[j];
    }
}

void SurfacePatchBuilder::compute_modes() {
  for (DeformableBody* body : bodies_) {
    loaded_.clear();
    for (const SurfacePatch& patch : patches_.patches)
      for (int t = patch.first_triangle; t < patch.first_triangle + patch.triangles; ++t)
        for (const int k : patches_.triangles[std::size_t(t)].corner) {
          const PatchVertex& v = patches_.vertices[std::size_t(k)];
          const Surface& s = *vertices_[std::size_t(k)].surface;
          const auto known = [&](const ReducedBasis::Loaded& l) { return l.row == v.row && l.tool == patch.tool; };
          if (v.row >= 0 && &s.body() == body && std::none_of(loaded_.begin(), loaded_.end(), known))
            loaded_.push_back({s.points()[std::size_t(vertices_[std::size_t(k)].vertex)], v.row, patch.tool});
        }
    reduced_.compute(*body, *body->solver(), loaded_, w_.data(), extended_.stride);
  }
}

const ConstraintProblem& SurfacePatchBuilder::operator()(const Simulation& simulation, int max_rows) {
  const ConstraintProblem& step = simulation.problem();
  reduced_.begin(simulation.steps());
  bodies_.clear();
  candidates_.clear();
  for (const Constraint* c : simulation.constraints()) c->find_patches(candidates_);
  std::erase_if(candidates_, [&](const PatchCandidate& c) { return tool_index(step, c.tool) < 0 || !usable(c); });
  if (candidates_.empty() || step.tools.empty()) return step;
  // Rows at the tools stay when the problem is condensed, and so do those of the vertices.
  Condenser::find_rows_at_tools(step, at_tool_);
  const auto at_tools = int(std::count(at_tool_.begin(), at_tool_.end(), char(1)));
  max_rows -= rows_for_modes;
  const int room = (max_rows - at_tools) / 3, free = std::max((max_rows - step.rows) / 3, least_vertices);
  choose(std::clamp(std::min(free, room), 0, most_vertices));
  patches_.clear();
  add_vertices(step.rows);
  for (std::size_t c = 0; c < candidates_.size(); ++c) add_patch(step, c);
  if (patches_.empty()) return step;
  extend(step);
  add_compliance(step);
  return extended_;
}

}  // namespace insula
