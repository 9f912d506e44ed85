// SPDX-License-Identifier: GPL-3.0-or-later
// Wall against wall of one surface.
#include "core/collision/colliders/self_collider.h"

#include <algorithm>
#include <cmath>

#include "core/collision/colliders/tissue_collider.h"

namespace insula {
namespace {

constexpr double facing = 0.1;       ///< normals of a pair must be opposed by this cosine
constexpr double along_wall = 0.92;  ///< normals that agree by this cosine at rest belong to one part of the wall ...
constexpr double bent = 0.8;  ///< ... those that agree by this are tested only when the wall between them is bent
constexpr double look_ahead = 0.5e-3;  ///< the search goes farther by this, to be valid for some steps, m
constexpr double skin = 0.4e-3;        ///< motion after which a list of partners is made again, m
constexpr double yields = 0.3;  ///< part of the wanted rotation that the normal of a pressing contact takes in a step
constexpr double min_turn = 1e-3;          ///< smaller rotations are ignored, rad
constexpr int swings_for_good = 120;       ///< reached after one or two seconds of oscillation
constexpr std::size_t longest_list = 192;  ///< partners of a sample; with more, the tree is searched in every step

/// Where the ray from `from` along the unit vector `along` goes out through triangle pqr; -1 if it does not.
double exit_through(const Vec3& from, const Vec3& along, const Vec3& p, const Vec3& q, const Vec3& r, Vec3& bary) {
  const Vec3 n = (q - p).cross(r - p);
  const double rate = n.dot(along);
  if (!(rate > facing * n.norm())) return -1;
  const double t = n.dot(p - from) / rate;
  const Vec3 x = from + t * along;
  const Vec3 w(n.dot((r - q).cross(x - q)), n.dot((p - r).cross(x - r)), n.dot((q - p).cross(x - p)));
  // A ray through an edge or a vertex must not pass between the triangles there.
  if (w.minCoeff() < -1e-9 * n.squaredNorm()) return -1;
  bary = w.cwiseMax(0.0) / w.cwiseMax(0.0).sum();
  return t;
}

}  // namespace

SelfCollider::SelfCollider(std::span<const Vec3> rest, std::span<const std::array<int, 3>> triangles, double spacing,
                           double thickness)
    : samples_(sample_vertices(rest, triangles, spacing)), neighbour_(2 * thickness) {
  for (const auto& t : triangles) {
    const Vec3 &a = rest[std::size_t(t[0])], &b = rest[std::size_t(t[1])], &c = rest[std::size_t(t[2])];
    const Vec3 middle = (a + b + c) / 3;
    face_position_.push_back(middle);
    corners_.push_back({a, b, c});
    extent2_.push_back(std::max({(a - middle).squaredNorm(), (b - middle).squaredNorm(), (c - middle).squaredNorm()}));
    face_normal_.push_back((b - a).cross(c - a).normalized());
  }
  CollisionMesh mesh;
  mesh.build(rest, triangles);
  mesh.update(rest, {});
  for (int v : samples_) {
    position_.push_back(rest[std::size_t(v)]);
    normal_.push_back(mesh.vertex_normal(v));
    // A few lumens: across an ellipse, a neck or a bifurcation, but not through one vessel into the next.
    reach_.push_back(2.5 * lumen(mesh, v));
  }
  for (int v : samples_) own_.push_back(mesh.region_of(v));
  for (auto& p : partners_) p.assign(samples_.size(), 0);
  for (std::size_t i = 0; i < samples_.size(); ++i)
    for (std::size_t t = 0; t < triangles.size(); ++t)
      if (const int side = kind(i, int(t)); side >= 0) partners_[side][i] |= mesh.regions_of(int(t));
  found_.resize((samples_.size() + piece - 1) / piece);
  for (auto& f : found_) f.reserve(2 * piece);
  for (auto& side : lists_) {
    side.resize(samples_.size());
    for (auto& list : side) list.reserve(longest_list + 1);
  }
  outward_.resize(samples_.size());
  outward_known_.resize(samples_.size());
  reset();
}

void SelfCollider::reset() {
  for (auto& c : close_) c.assign(samples_.size(), 0);
  for (auto& d : direction_) d.assign(samples_.size(), Vec3::Zero());
  for (auto& s : swing_) s.assign(samples_.size(), Swing());
  for (auto& c : clear_) c.assign(samples_.size(), 0.0);
  for (auto& c : covered_) c.assign(samples_.size(), -1.0);
}

// A large force on a sharp fold makes even a slow normal oscillate, and the wall with it: force times change of normal,
// N/m, acts against the wall's own stiffness. Such an oscillation reverses in every few steps for a second or two. A
// pulse or a hand does not cause this.
double SelfCollider::Swing::share(const Vec3& wanted) {
  constexpr int back = 2, on = 1;
  const bool turned_back =
      wanted.dot(turn) < 0 && wanted.squaredNorm() > min_turn * min_turn && turn.squaredNorm() > min_turn * min_turn;
  turn = wanted;
  if (count < swings_for_good) count = turned_back ? std::min(count + back, swings_for_good) : std::max(0, count - on);
  return count < swings_for_good ? yields : 0.1 * yields;
}

// Distance from a vertex inward along the normal to the opposite wall, m; 0 if there is none.
double SelfCollider::lumen(const CollisionMesh& rest, int vertex) const {
  const Vec3 from = rest.vertex(vertex), along = -rest.vertex_normal(vertex);
  double least = 1e300;
  Aabb box;
  box.add(from);
  box.add(Vec3(from + 0.03 * along));  // no lumen is wider
  rest.tree().overlapping(box, [&](int tri) {
    const auto& v = rest.triangle(tri);
    if (v[0] == vertex || v[1] == vertex || v[2] == vertex) return;
    Vec3 bary;
    const double t = exit_through(from, along, rest.vertex(v[0]), rest.vertex(v[1]), rest.vertex(v[2]), bary);
    if (t > 0) least = std::min(least, t);
  });
  return least < 0.03 ? least : 0.0;
}

int SelfCollider::kind(std::size_t sample, int triangle) const {
  const Vec3 d = face_position_[std::size_t(triangle)] - position_[sample];
  const double d2 = d.squaredNorm();
  if (d2 < neighbour_ * neighbour_ || normal_[sample].dot(face_normal_[std::size_t(triangle)]) > along_wall) return -1;
  const double leaves = normal_[sample].dot(d), ends = face_normal_[std::size_t(triangle)].dot(d);
  const int side = leaves < 0 && ends > 0 && d2 < reach_[sample] * reach_[sample] ? inner
                   : leaves > 0 && ends < 0                                       ? outer
                                                                                  : -1;
  if (side < 0 || d2 > neighbour_ * neighbour_ + extent2_[std::size_t(triangle)] +
                           2 * neighbour_ * std::sqrt(extent2_[std::size_t(triangle)]))
    return side;
  // A large triangle may be near although its middle is not.
  const auto& c = corners_[std::size_t(triangle)];
  const Vec3 w = closest_on_triangle(position_[sample], c[0], c[1], c[2]);
  return (w[0] * c[0] + w[1] * c[1] + w[2] * c[2] - position_[sample]).squaredNorm() < neighbour_ * neighbour_ ? -1
                                                                                                               : side;
}

// Whether motion since the last test of the sample may have brought a partner within range.
bool SelfCollider::may_be_near(const CollisionMesh& mesh, std::size_t sample, int side, double range) {
  const std::uint64_t partners = partners_[side][sample];
  const double went = mesh.moved(own_[sample]) + mesh.moved(partners);
  clear_[side][sample] -= went;
  covered_[side][sample] -= went;
  return clear_[side][sample] <=
         range + std::min(mesh.free(samples_[sample]).norm() + mesh.may_move(partners), look_ahead);
}

// Lists all possible partners within `far`, and those that may come there before the list is made again.
void SelfCollider::list_partners(const CollisionMesh& mesh, std::size_t sample, int side, double far) {
  auto& list = lists_[side][sample];
  list.clear();
  const Vec3 x = mesh.vertex(samples_[sample]);
  Aabb box;
  box.add(x);
  box.inflate(far + skin);
  mesh.tree().overlapping(box, [&](int tri) {
    if (list.size() > longest_list || kind(sample, tri) != side) return;
    const auto& t = mesh.triangle(tri);
    const Vec3 p = mesh.vertex(t[0]), q = mesh.vertex(t[1]), r = mesh.vertex(t[2]);
    const Vec3 w = closest_on_triangle(x, p, q, r);
    const double d = (w[0] * p + w[1] * q + w[2] * r - x).norm();
    if (d <= far + skin) list.push_back({d, tri});
  });
  std::sort(list.begin(), list.end(), [](const Partner& a, const Partner& b) {
    return a.was != b.was ? a.was < b.was : a.triangle < b.triangle;
  });
  covered_[side][sample] = list.size() > longest_list ? -1.0 : skin;
}

// Search for the nearest partner of a sample. It also finds the distance to triangles that are not partners.
struct SelfCollider::Search {
  const SelfCollider& of;
  const CollisionMesh& mesh;
  std::size_t sample;
  Vec3 x;  ///< the sample's position
  double any2;
  double least2 = 1e300;
  int best = -1;
  Vec3 bary = Vec3::Zero(), point = Vec3::Zero();

  void test(int tri, double& limit2) {
    const auto& t = mesh.triangle(tri);
    const Vec3 p = mesh.vertex(t[0]), q = mesh.vertex(t[1]), r = mesh.vertex(t[2]);
    const Vec3 n = (q - p).cross(r - p);
    const double h = n.dot(x - p), nn = n.squaredNorm();
    if (h * h > limit2 * nn) return;  // its plane is farther than the best triangle
    const double agree = of.outward_[sample].dot(n) / std::sqrt(nn);
    if (agree > 0.5 && of.normal_[sample].dot(of.face_normal_[std::size_t(tri)]) > bent) return;
    const Vec3 w = closest_on_triangle(x, p, q, r);
    const Vec3 c = w[0] * p + w[1] * q + w[2] * r;
    const double d2 = (x - c).squaredNorm();
    any2 = std::min(any2, d2);
    if (agree > -facing || d2 > limit2 || (d2 == limit2 && best >= 0 && tri > best)) return;
    // The sample is beside the triangle, and a nearer triangle was not a partner.
    const double over = n.dot(x - c);
    if (d2 > 1e-12 && over * over < 0.36 * d2 * nn) return;
    limit2 = d2;
    best = tri;
    bary = w;
    point = c;
  }
};

// Tests all possible partners within `reach`. It uses the list of partners if this covers `reach`, else the tree.
void SelfCollider::test_partners(Search& search, int side, double reach, double far) {
  const std::size_t sample = search.sample;
  if (reach <= far && covered_[side][sample] < 0) list_partners(search.mesh, sample, side, far);
  if (reach <= far && covered_[side][sample] >= 0) {
    const double went = skin - covered_[side][sample];
    for (const Partner& p : lists_[side][sample]) {
      const double at_least = std::max(0.0, p.was - went);
      if (at_least * at_least > search.least2) {  // nor does any later one
        search.any2 = std::min(search.any2, at_least * at_least);
        break;
      }
      search.test(p.triangle, search.least2);
    }
    return;
  }
  Aabb box;
  box.add(search.x);
  box.inflate(std::max(reach, far));
  search.mesh.tree().nearest(search.x, &box, search.least2, [&](int tri, double& limit2) {
    if (kind(sample, tri) == side) search.test(tri, limit2);
  });
}

// Finds the contact of a sample with its nearest partner. Returns 0 without a contact, 1 with one, 2 if the sample has
// crossed. `before` is the result of the last step.
int SelfCollider::contact_with(const Search& nearest, const SelfContactSettings& settings, int side, int before,
                               Proximity& c) const {
  const CollisionMesh& mesh = nearest.mesh;
  const int v = samples_[nearest.sample];
  const bool was = before != 0;
  const TriangleFeature f = feature_of(nearest.bary);
  const Vec3 free_side = (side == inner ? -1.0 : 1.0) * mesh.pseudo_normal(nearest.best, f);
  const Vec3 d = nearest.x - nearest.point;
  const double distance = d.norm();
  const bool crossed = d.dot(free_side) < 0;
  c.vertex = v;
  c.side = side;
  c.triangle = nearest.best;
  c.bary = nearest.bary;
  c.point = nearest.point;
  if (distance > 1e-6) {
    c.normal = (crossed ? Vec3(-d) : d) / distance;
  } else {
    c.normal = free_side;
  }
  // On the outside, two neighbouring vessels and two that have crossed look alike, so only samples that touched before
  // can have crossed. A crossing begins with a small depth. A fold of the wall that faces the other direction is not a
  // crossing.
  if (crossed && (distance > settings.max_depth || (side == outer && !was))) return 0;
  if (crossed && before != 2 && distance > settings.thickness + settings.alarm) return 0;
  c.gap = (crossed ? -distance : distance) - settings.thickness;
  const double approach = c.normal.dot(mesh.free(v) - mesh.free_at(nearest.best, nearest.bary));
  // An existing contact is kept a little longer, so that rows do not flicker while nothing moves.
  const double alarm = was ? 1.2 * settings.alarm : settings.alarm;
  if (c.gap > alarm && c.gap + approach > alarm) return 0;
  return crossed ? 2 : 1;
}

// On a fold, the smallest motion of the wall changes the direction to the nearest point, and so light a wall would
// oscillate. So the normal of a pressing contact changes slowly, except for hard walls, whose gap changes its sign.
void SelfCollider::under_relax_normal(Proximity& c, std::size_t sample, bool may_slow) {
  Vec3& direction = direction_[c.side][sample];
  Swing& swing = swing_[c.side][sample];
  if (may_slow && c.gap < 0 && direction.dot(c.normal) > 0.5)
    c.normal = (direction + swing.share(c.normal - direction) * (c.normal - direction)).normalized();
  else swing = {};
  direction = c.normal;
}

void SelfCollider::near(const CollisionMesh& mesh, const SelfContactSettings& settings, std::size_t sample, int side,
                        std::vector<Proximity>& out) {
  const int v = samples_[sample];
  const int before = close_[side][sample];
  const bool was = before != 0;
  // Samples with a contact search farther. Samples that have crossed search as deep as crossings are corrected.
  const double range = (was ? 1.2 * settings.alarm + look_ahead : settings.alarm) + settings.thickness;
  const double reach = before == 2 ? std::max(range, settings.max_depth) : range;
  if (!may_be_near(mesh, sample, side, range) && !was) return;
  close_[side][sample] = 0;
  if (!outward_known_[sample]) {
    outward_[sample] = mesh.rough_normal(v);
    outward_known_[sample] = 1;
  }
  Search search{*this, mesh, sample, mesh.vertex(v), (range + look_ahead) * (range + look_ahead)};
  // What the free motion may bring is within the search range.
  test_partners(search, side, reach, settings.thickness + 1.2 * settings.alarm + look_ahead);
  clear_[side][sample] = was ? 0.0 : std::sqrt(search.any2);
  if (search.best < 0) return;
  Proximity c;
  const int state = contact_with(search, settings, side, before, c);
  if (state == 0) return;
  under_relax_normal(c, sample, settings.normal_under_relaxation && was);
  close_[side][sample] = char(state);
  c.start_gap = std::max(c.gap, -settings.max_correction);
  out.push_back(c);
}

Opposite SelfCollider::opposite(const CollisionMesh& mesh, int triangle, const Vec3& bary, const Vec3& along,
                                double far) const {
  Opposite best;
  best.distance = far;
  const Vec3 from = mesh.point(triangle, bary);
  Aabb swept;
  swept.add(from);
  swept.add(Vec3(from + far * along));
  const auto& own = mesh.triangle(triangle);
  mesh.tree().overlapping(swept, [&](int tri) {
    const auto& t = mesh.triangle(tri);
    for (int v : t)
      if (v == own[0] || v == own[1] || v == own[2]) return;
    // Inner according to the rest shape, as for samples.
    const Vec3 d = face_position_[std::size_t(tri)] - face_position_[std::size_t(triangle)];
    if (d.squaredNorm() < neighbour_ * neighbour_ || face_normal_[std::size_t(triangle)].dot(d) >= 0 ||
        face_normal_[std::size_t(tri)].dot(d) <= 0)
      return;
    Vec3 w;
    const double s = exit_through(from, along, mesh.vertex(t[0]), mesh.vertex(t[1]), mesh.vertex(t[2]), w);
    if (s < 0 || s > best.distance || (s == best.distance && best.triangle >= 0 && tri > best.triangle)) return;
    best = {tri, w, s};
  });
  return best;
}

void SelfCollider::detect(const CollisionMesh& mesh, const SelfContactSettings& settings, std::vector<Proximity>& out,
                          Workers& workers) {
  if (mesh.tree().empty()) return;
  std::fill(outward_known_.begin(), outward_known_.end(), char(0));
  if (mesh.updates() - updates_ > 1) {  // unknown motion in between may have brought any partner
    for (auto& c : clear_) std::fill(c.begin(), c.end(), 0.0);
    for (auto& c : covered_) std::fill(c.begin(), c.end(), -1.0);
  }
  updates_ = mesh.updates();
  workers.run(int(found_.size()), [&](int task) {
    auto& found = found_[std::size_t(task)];
    found.clear();
    const std::size_t first = std::size_t(task) * piece, last = std::min(first + piece, samples_.size());
    for (std::size_t i = first; i < last; ++i) {
      if (settings.inner && reach_[i] > 0) near(mesh, settings, i, inner, found);
      if (settings.outer) near(mesh, settings, i, outer, found);
    }
  });
  for (const auto& found : found_) out.insert(out.end(), found.begin(), found.end());
}

}  // namespace insula
