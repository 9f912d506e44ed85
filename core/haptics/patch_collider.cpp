// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts on a patch.
#include "core/haptics/patch_collider.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/collision/shapes/core_triangle.h"
#include "core/collision/shapes/placed_piece.h"

namespace insula {
namespace {

constexpr double farthest_beside_m = 1e-3;

}  // namespace

PatchCollider::PatchCollider() : collider_(most_pieces, int(most_triangles)) {
  mesh_.reserve_few(SurfacePatches::max_vertices, most_triangles);
  selection_.reserve(most_found, most_contacts);
  triangles_.reserve(most_triangles);
  weighted_normals_.reserve(SurfacePatches::max_vertices);
  open_.reserve(most_triangles);
  piece_index_.reserve(most_pieces);
  touched_.reserve(most_pieces);
}

bool PatchCollider::same_pieces(const SurfacePatches& all, const SurfacePatch& patch) const {
  if (piece_index_.size() != std::size_t(patch.pieces)) return false;
  for (int i = 0; i < patch.pieces; ++i)
    if (piece_index_[std::size_t(i)] != all.pieces[std::size_t(patch.first_piece + i)].index) return false;
  return true;
}

void PatchCollider::set(const SurfacePatches& all, const SurfacePatch& patch) {
  const bool same = id_ == patch.id && same_pieces(all, patch);
  if (id_ != patch.id) selection_.reset();
  id_ = patch.id;
  patch_ = patch;
  fresh_ = true;
  triangles_.clear();
  open_.clear();
  weighted_normals_.clear();
  if (patch.curved != 0)
    for (const PatchVertex& v : all.vertices) weighted_normals_.push_back(v.weighted_normal);
  for (int i = 0; i < patch.triangles && triangles_.size() < most_triangles; ++i) {
    const PatchTriangle& t = all.triangles[std::size_t(patch.first_triangle + i)];
    triangles_.push_back({t.corner[0], t.corner[1], t.corner[2]});
    open_.push_back(t.open);
  }
  if (same) return;
  collider_.clear_pieces();
  piece_index_.clear();
  for (int i = 0; i < patch.pieces && i < int(most_pieces); ++i) {
    const PatchPiece& from = all.pieces[std::size_t(patch.first_piece + i)];
    RoundedPiece& to = collider_.add_piece();
    for (int k = 0; k < from.cores && k < int(RoundedPiece::max_core); ++k)
      to.core.push_back(all.core[std::size_t(from.first_core + k)]);
    to.radius = from.radius;
    to.axis0 = from.axis0;
    to.axis1 = from.axis1;
    to.bound = from.bound;
    piece_index_.push_back(from.index);
  }
  touched_.assign(piece_index_.size(), 0);
}

// The plane of the triangle whose open edge is nearest to the piece.
void PatchCollider::add_beside(const Pose& tool, int piece, std::vector<Proximity>& out) const {
  const PlacedPiece at(collider_.pieces()[std::size_t(piece)], piece, tool, tool, 0, Vec3::Zero(),
                       patch_.half_thickness_m);
  double least = farthest_beside_m;
  Proximity x;
  for (int t = 0; t < int(triangles_.size()); ++t) {
    if (open_[std::size_t(t)] == 0) continue;
    const auto& v = triangles_[std::size_t(t)];
    const CoreDistance d = core_triangle(at.core(), {mesh_.vertex(v[0]), mesh_.vertex(v[1]), mesh_.vertex(v[2])},
                                         at.radius + farthest_beside_m);
    const TriangleFeature f = feature_of(d.bary);
    const int before = (f.corner + 2) % 3;
    const int edges = f.kind == FeatureKind::face   ? 0
                      : f.kind == FeatureKind::edge ? 1 << f.corner
                                                    : 1 << f.corner | 1 << before;
    if ((open_[std::size_t(t)] & edges) == 0) continue;
    const Vec3 n = mesh_.face_normal(t);
    const double height = n.dot(d.p - d.c), beside = (d.p - d.c - height * n).norm();
    if (height < 0 || height - at.radius > patch_.alarm_m || beside >= least) continue;
    least = beside;
    x.piece = piece;
    x.triangle = t;
    x.bary = d.bary;
    x.normal = n;
    x.point = d.p - height * n;
    x.gap = x.start_gap = height - at.radius;
    x.local = tool.q.conjugate() * (x.point - tool.p);
  }
  if (x.triangle >= 0) out.push_back(x);
}

void PatchCollider::detect(const Pose& tool, std::span<const Vec3> vertices, std::vector<Proximity>& out,
                           std::uint64_t& next_key) {
  out.clear();
  if (std::exchange(fresh_, false)) mesh_.build_few(vertices, triangles_, weighted_normals_);
  else mesh_.move_few(vertices);
  ToolContactSettings settings;
  settings.alarm = patch_.alarm_m;
  settings.max_correction = patch_.max_correction_m;
  settings.offset = patch_.half_thickness_m;
  settings.curved = patch_.curved != 0;
  collider_.detect_at(mesh_, tool, settings, out);
  for (int i = 0; i < int(piece_index_.size()); ++i) {
    if (!touched_[std::size_t(i)]) continue;
    if (std::any_of(out.begin(), out.end(), [&](const Proximity& x) { return x.piece == i; })) continue;
    add_beside(tool, i, out);
  }
  std::fill(touched_.begin(), touched_.end(), char(0));
  for (Proximity& x : out) {
    touched_[std::size_t(x.piece)] = 1;
    x.piece = piece_index_[std::size_t(x.piece)];
    x.triangle += patch_.first_triangle;
  }
  SelectionSettings choice;
  choice.spacing = patch_.spacing_m;
  choice.advantage = 0.2 * patch_.alarm_m;
  choice.max_contacts = std::min(patch_.max_contacts, int(most_contacts));
  choice.max_per_piece = patch_.max_per_piece;
  selection_.select(out, choice, next_key);
}

}  // namespace insula
