// SPDX-License-Identifier: GPL-3.0-or-later
/*
Parts a lobe as a retractor would: the elastic shape at rest that keeps clear of the wall,

    min 1/2 u^T K u   with   C u >= d          u: displacement of the tetrahedra's nodes, mm; fixed nodes stay

K is that of linear elasticity (only its ratios matter). Rows of C are points of the lobe that are too near to
something, each along the direction out; they are found anew a few times as the lobe moves. Through K^-1 C^T the
conditions meet in W = C K^-1 C^T, solved by projected Gauss-Seidel like a step's contacts.
*/
#include <fmt/format.h>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <deque>

#include "tools/case_builder/place.h"
#include "tools/case_builder/solid.h"

namespace insula::case_builder {
namespace {

using Sparse = Eigen::SparseMatrix<double>;
constexpr double margin =
    0.5;  // points so much farther than they must be are conditions too, so that they do not come back
constexpr double deepest = 6;  // mm
constexpr int rounds = 10;
constexpr std::size_t most_conditions = 1200;  // at a time, the most wanting ones: a round later come the others

constexpr double least_volume = 0.02;  // of an element, over what it was
constexpr double farthest = 15;        // mm: no lobe is parted so far
constexpr double least_room = 0.05;    // mm: with less, wall and lobe touch

struct Condition {
  std::array<int, 12> node{};
  std::array<double, 12> weight{};
  int count = 0;
  Vec3 direction;
  double least = 0;  ///< of direction . u
};

class ElasticLobe {
 public:
  explicit ElasticLobe(Lobe& lobe) : lobe_(lobe), start_(lobe.tets.nodes) {
    of_.assign(start_.size(), -1);
    for (std::size_t i = 0; i < start_.size(); ++i)
      if (!lobe.fixed[i]) of_[i] = free_++;
    std::vector<Eigen::Triplet<double>> entries;
    for (const auto& t : lobe.tets.tets) add(t, entries);
    Sparse k(3 * free_, 3 * free_);
    k.setFromTriplets(entries.begin(), entries.end());
    factor_.compute(k);
    u_ = VecX::Zero(3 * free_);
  }
  /// Displacement of a mix of nodes.
  Vec3 at(const Condition& c) const {
    Vec3 sum = Vec3::Zero();
    for (int k = 0; k < c.count; ++k)
      if (const int f = of_[std::size_t(c.node[std::size_t(k)])]; f >= 0)
        sum += c.weight[std::size_t(k)] * u_.segment<3>(3 * f);
    return sum;
  }
  void solve(const std::vector<Condition>& all) {
    std::vector<const Condition*> rows;
    for (const Condition& c : all) rows.push_back(&c);
    const Eigen::Index n = Eigen::Index(rows.size());
    if (n == 0) {
      u_.setZero();
      return;
    }
    Eigen::MatrixXd ct = Eigen::MatrixXd::Zero(3 * free_, n);
    VecX d(n);
    for (Eigen::Index r = 0; r < n; ++r) {
      const Condition& c = *rows[std::size_t(r)];
      d[r] = c.least;
      for (int k = 0; k < c.count; ++k)
        if (const int f = of_[std::size_t(c.node[std::size_t(k)])]; f >= 0)
          ct.block<3, 1>(3 * f, r) += c.weight[std::size_t(k)] * c.direction;
    }
    const Eigen::MatrixXd back = factor_.solve(ct), w = ct.transpose() * back;
    VecX lambda = VecX::Zero(n);
    for (int sweep = 0; sweep < 300; ++sweep) {
      double most = 0;
      for (Eigen::Index r = 0; r < n; ++r) {
        if (!(w(r, r) > 1e-12)) continue;
        const double now = std::max(0.0, lambda[r] + (d[r] - w.row(r).dot(lambda)) / (1.001 * w(r, r)));
        most = std::max(most, std::abs(now - lambda[r]) * w(r, r));
        lambda[r] = now;
      }
      if (most < 1e-4) break;
    }
    u_ = back * lambda;
  }
  double write_back() {
    double most = 0;
    for (std::size_t i = 0; i < start_.size(); ++i) {
      lobe_.tets.nodes[i] = start_[i];
      if (of_[i] >= 0)
        lobe_.tets.nodes[i] += u_.segment<3>(3 * of_[i]), most = std::max(most, u_.segment<3>(3 * of_[i]).norm());
    }
    for (std::size_t v = 0; v < lobe_.embedded_vertices.size(); ++v) {
      const Lobe::EmbeddedVertex& r = lobe_.embedded_vertices[v];
      Vec3 p = r.offset;
      for (int k = 0; k < r.count; ++k)
        p += r.weight[std::size_t(k)] * lobe_.tets.nodes[std::size_t(r.node[std::size_t(k)])];
      lobe_.surface.vertices[v] = p;
    }
    return most;
  }
  /// Least volume of a tetrahedron over what it was.
  double min_volume() const {
    double least = 1e300;
    const auto volume = [](const std::vector<Vec3>& x, const std::array<int, 4>& t) {
      const Vec3& a = x[std::size_t(t[0])];
      return (x[std::size_t(t[1])] - a).cross(x[std::size_t(t[2])] - a).dot(x[std::size_t(t[3])] - a);
    };
    for (const auto& t : lobe_.tets.tets) least = std::min(least, volume(lobe_.tets.nodes, t) / volume(start_, t));
    return least;
  }
  /// A condition on a surface point, a mix of up to three vertices.
  Condition condition(const std::array<int, 3>& vertices, const Vec3& bary, const Vec3& direction,
                      double missing) const {
    Condition c;
    c.direction = direction;
    for (std::size_t k = 0; k < 3; ++k) {
      if (bary[Eigen::Index(k)] < 1e-9) continue;
      const Lobe::EmbeddedVertex& r = lobe_.embedded_vertices[std::size_t(vertices[k])];
      for (std::size_t j = 0; j < std::size_t(r.count); ++j)
        c.node[std::size_t(c.count)] = r.node[j],
        c.weight[std::size_t(c.count++)] = bary[Eigen::Index(k)] * r.weight[j];
    }
    c.least = missing + direction.dot(at(c));
    return c;
  }

 private:
  void add(const std::array<int, 4>& t, std::vector<Eigen::Triplet<double>>& entries) {
    const Vec3 &a = start_[std::size_t(t[0])], &b = start_[std::size_t(t[1])], &c = start_[std::size_t(t[2])],
               &d = start_[std::size_t(t[3])];
    Mat3 m;
    m << b - a, c - a, d - a;
    const double volume = m.determinant() / 6;
    const Mat3 inverse = m.inverse();
    Vec3 g[4];
    for (int k = 0; k < 3; ++k) g[k + 1] = inverse.row(k).transpose();
    g[0] = -g[1] - g[2] - g[3];
    constexpr double nu = 0.4, mu = 1 / (2 * (1 + nu)), lambda = nu / ((1 + nu) * (1 - 2 * nu));
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) {
        const int fi = of_[std::size_t(t[std::size_t(i)])], fj = of_[std::size_t(t[std::size_t(j)])];
        if (fi < 0 || fj < 0) continue;
        const Mat3 block = volume * (lambda * g[i] * g[j].transpose() + mu * g[j] * g[i].transpose() +
                                     mu * g[i].dot(g[j]) * Mat3::Identity());
        for (int r = 0; r < 3; ++r)
          for (int s = 0; s < 3; ++s) entries.emplace_back(3 * fi + r, 3 * fj + s, block(r, s));
      }
  }
  Lobe& lobe_;
  std::vector<Vec3> start_;
  std::vector<int> of_;
  int free_ = 0;
  Eigen::SimplicialLDLT<Sparse> factor_;
  VecX u_;
};

/// Conditions that keep the lobe's vertices from a solid; each no nearer than `gap`, or than it was at the start.
void keep_from(const ElasticLobe& lobe, const Solid& own, const Solid& other, double gap,
               const std::vector<double>* at_start, std::vector<Condition>& out) {
  for (std::size_t v = 0; v < own.mesh().vertices.size(); ++v) {
    const double wanted = at_start ? std::min(gap, (*at_start)[v]) : gap;
    const Nearest n = other.nearest(own.mesh().vertices[v], deepest);
    if (n.found && n.distance < wanted + margin)
      out.push_back(lobe.condition({int(v), int(v), int(v)}, {1, 0, 0}, n.outward, wanted - n.distance));
  }
}

std::vector<double> distances(const Solid& own, const Solid& other) {
  std::vector<double> out;
  for (const Vec3& p : own.mesh().vertices) {
    const Nearest n = other.nearest(p, deepest);
    out.push_back(n.found ? n.distance : deepest);
  }
  return out;
}

/// The rigid floor is lowered where the wall intersects it, with a smooth transition.
double lower_floor(Solid& floor, const Solid& wall, double gap) {
  const TriMesh m = floor.mesh();
  std::vector<std::vector<int>> next(m.vertices.size());
  for (const auto& t : m.triangles)
    for (std::size_t k = 0; k < 3; ++k) next[std::size_t(t[k])].push_back(t[(k + 1) % 3]);
  double most = 0;
  for (int round = 0; round < 12; ++round) {
    std::vector<Vec3> push(m.vertices.size(), Vec3::Zero());
    std::vector<char> pushed(m.vertices.size(), 0);
    bool any = false;
    const auto need = [&](int v, const Vec3& by) {
      if (by.norm() > push[std::size_t(v)].norm()) push[std::size_t(v)] = by, pushed[std::size_t(v)] = 1, any = true;
    };
    for (std::size_t v = 0; v < m.vertices.size(); ++v)
      if (const Nearest n = wall.nearest(floor.mesh().vertices[v], deepest); n.found && n.distance < gap - 1e-3)
        need(int(v), (gap - n.distance) * n.outward);
    for (const Vec3& p : wall.mesh().vertices)
      if (const Nearest n = floor.nearest(p, deepest); n.found && n.distance < gap - 1e-3)
        for (const int v : floor.mesh().triangles[std::size_t(n.triangle)]) need(v, -(gap - n.distance) * n.outward);
    if (!any) break;
    for (int sweep = 0; sweep < 30; ++sweep) {
      const std::vector<Vec3> old = push;
      for (std::size_t v = 0; v < push.size(); ++v) {
        if (pushed[v] || next[v].empty()) continue;
        Vec3 mean = Vec3::Zero();
        for (const int w : next[v]) mean += old[std::size_t(w)] / double(next[v].size());
        push[v] = 0.97 * mean;
      }
    }
    std::vector<Vec3> to = floor.mesh().vertices;
    for (std::size_t v = 0; v < to.size(); ++v) to[v] += push[v], most = std::max(most, (to[v] - m.vertices[v]).norm());
    floor.move(std::move(to));
  }
  return most;
}

/// Lowers the floor where the wall needs clearance.
Room clear_floor(Solid& floor, Fissure& fissure, const Solid& wall, double gap) {
  Room out{fissure.approach.floor, room_beside(floor, wall), 0, 0};
  if (out.before < gap) {
    out.moved = lower_floor(floor, wall, gap + wall_half);
    fissure.floor = floor.mesh();
  }
  out.after = room_beside(floor, wall);
  return out;
}

/// The two lobes while they are moved apart.
class PartedLobes {
 public:
  PartedLobes(Fissure& fissure, const Solid& wall, const Solid& floor, double wanted)
      : fissure_(fissure), wall_(wall), floor_(floor), wanted_(wanted + 0.05) {
    for (Lobe& l : fissure.lobes) {
      solid_.emplace_back(l.surface), lobe_.emplace_back(l);
      rooms.push_back({l.name, room_beside(solid_.back(), wall), 0, 0});
    }
    for (std::size_t i = 0; i < 2; ++i)
      to_floor_.push_back(distances(solid_[i], floor)), to_other_.push_back(distances(solid_[i], solid_[1 - i]));
  }
  std::vector<Room> rooms;

  void part(Progress& progress) {
    for (int round = 0; round < rounds; ++round) {
      progress.share(double(round) / rounds);
      for (std::size_t i = 0; i < 2; ++i) {
        lobe_[i].solve(conditions(i));
        rooms[i].moved = lobe_[i].write_back();
        if (!(rooms[i].moved < farthest)) return;
        solid_[i].move(fissure_.lobes[i].surface.vertices);
      }
    }
  }
  void judge(std::vector<Note>& notes) {
    for (std::size_t i = 0; i < 2; ++i) {
      rooms[i].after = room_beside(solid_[i], wall_);
      const double least = rooms[i].least_volume = lobe_[i].min_volume();
      if (least < 0.15)
        notes.push_back(
            problem("lobe_squeezed",
                    fmt::format("The {} lobe had to be parted so far that an element has {:.0f} % of its volume left.",
                                rooms[i].what, 100 * least),
                    "Keep less of the vessel (--keep), or turn it (--spin), so that it needs less room."));
    }
  }

 private:
  /// The clearance conditions of lobe i in its present shape.
  std::vector<Condition> conditions(std::size_t i) const {
    std::vector<Condition> out;
    keep_from(lobe_[i], solid_[i], wall_, wanted_, nullptr, out);
    for (const Vec3& p : wall_.mesh().vertices)
      if (const Nearest n = solid_[i].nearest(p, deepest); n.found && n.distance < wanted_ + margin)
        out.push_back(lobe_[i].condition(solid_[i].mesh().triangles[std::size_t(n.triangle)], n.bary, -n.outward,
                                         wanted_ - n.distance));
    keep_from(lobe_[i], solid_[i], floor_, 0.3, &to_floor_[i], out);
    keep_from(lobe_[i], solid_[i], solid_[1 - i], 0.6, &to_other_[i], out);
    if (out.size() > most_conditions) {
      const auto wanting = [&](const Condition& c) { return c.least - c.direction.dot(lobe_[i].at(c)); };
      std::stable_sort(out.begin(), out.end(),
                       [&](const Condition& a, const Condition& b) { return wanting(a) > wanting(b); });
      out.resize(most_conditions);
    }
    return out;
  }

  Fissure& fissure_;
  const Solid &wall_, &floor_;
  double wanted_;
  std::vector<Solid> solid_;
  std::deque<ElasticLobe> lobe_;  // ElasticLobe is not movable
  std::vector<std::vector<double>> to_floor_, to_other_;
};

void tell_room(const Room& r, std::vector<Note>& notes) {
  if (r.moved > 0.01)
    notes.push_back(
        {Note::Kind::repair,
         fmt::format(
             "The {} was parted by up to {:.1f} mm, so that it keeps {:.2f} mm from the wall (before: {:.2f} mm).",
             r.what, r.moved, r.after, r.before),
         ""});
  if (r.after < least_room)
    notes.push_back(problem("overlap",
                            fmt::format("The {} still overlaps the wall or touches it ({:.2f} mm).", r.what, r.after),
                            "Keep less of the vessel (--keep), or turn it (--spin)."));
}

}  // namespace

/// Vertices of either against the other; negative when one is inside of the other.
double room_beside(const Solid& surface, const Solid& wall) {
  double least = 10;
  for (const auto& [from, to] : {std::pair(&surface, &wall), std::pair(&wall, &surface)})
    for (const Vec3& p : from->mesh().vertices)
      if (const Nearest n = to->nearest(p, std::max(least, deepest)); n.found) least = std::min(least, n.distance);
  return least - wall_half;
}

bool is_sound(const std::vector<Room>& rooms) {
  return std::all_of(rooms.begin(), rooms.end(),
                     [](const Room& r) { return r.least_volume > least_volume && r.moved < farthest; });
}

bool is_clear(const std::vector<Room>& rooms) {
  return std::all_of(rooms.begin(), rooms.end(), [](const Room& r) { return r.after >= least_room; });
}

std::vector<Room> part_lobes(Fissure& fissure, const TriMesh& wall_mesh, double gap, std::vector<Note>& notes,
                             Progress& progress) {
  const Solid wall(wall_mesh);
  Solid floor(fissure.floor);
  const Room floor_room = clear_floor(floor, fissure, wall, gap);
  PartedLobes lobes(fissure, wall, floor, gap + wall_half);
  if (lobes.rooms[0].before < gap || lobes.rooms[1].before < gap || floor_room.moved > 0) lobes.part(progress);
  lobes.judge(notes);
  std::vector<Room> out = lobes.rooms;
  out.push_back(floor_room);
  for (const Room& r : out) tell_room(r, notes);
  return out;
}

}  // namespace insula::case_builder
