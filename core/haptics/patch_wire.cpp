// SPDX-License-Identifier: GPL-3.0-or-later
// The fields of patches are listed once, for writing, reading and skipping. Lists come in an order in which each refers
// to earlier ones only.
#include "core/haptics/patch_wire.h"

#include <algorithm>
#include <cmath>

#include "core/bus/plausible.h"
#include "core/haptics/haptic_layout.h"
#include "core/haptics/haptic_update.h"

namespace insula::wire {
namespace {

constexpr double max_length_m = 0.1, max_friction = 10, max_contact_compliance = 1e6;
constexpr int max_contacts = 100;

class Writing {
 public:
  explicit Writing(ByteWriter& out) : out_(out) {}
  template <class Wire, class T>
  void number(T& x) {
    out_.number(Wire(x));
  }
  template <class Wire>
  void vector(const Vec3& x) {
    for (int k = 0; k < 3; ++k) out_.number(Wire(x[k]));
  }

 private:
  ByteWriter& out_;
};

class Reading {
 public:
  explicit Reading(ByteReader& in) : in_(in) {}
  template <class Wire, class T>
  void number(T& x) {
    const std::uint8_t* at = in_.take(sizeof(Wire));
    x = at ? T(load<Wire>(at)) : T();
  }
  template <class Wire>
  void vector(Vec3& x) {
    for (int k = 0; k < 3; ++k) number<Wire>(x[k]);
  }

 private:
  ByteReader& in_;
};

template <class Io, class V>
requires std::same_as<std::remove_const_t<V>, PatchVertex>
void fields(Io& io, V& v) {
  io.template number<std::int16_t>(v.row);
  io.template vector<double>(v.position);
  io.template vector<double>(v.weighted_normal);
}
template <class Io, class T>
requires std::same_as<std::remove_const_t<T>, PatchTriangle>
void fields(Io& io, T& t) {
  for (auto& c : t.corner) io.template number<std::int16_t>(c);
  io.template number<std::int8_t>(t.open);
}
template <class Io, class V>
requires std::same_as<std::remove_const_t<V>, Vec3>
void fields(Io& io, V& v) { io.template vector<double>(v); }
template <class Io, class P>
requires std::same_as<std::remove_const_t<P>, PatchPiece>
void fields(Io& io, P& p) {
  io.template number<std::int16_t>(p.index);
  io.template number<std::int16_t>(p.first_core);
  io.template number<std::int16_t>(p.cores);
  io.template number<double>(p.radius);
  io.template vector<double>(p.axis0);
  io.template vector<double>(p.axis1);
  io.template number<double>(p.bound);
}
template <class Io, class R>
requires std::same_as<std::remove_const_t<R>, ReplacedContact>
void fields(Io& io, R& r) {
  io.template number<std::int16_t>(r.row);
  io.template number<std::int16_t>(r.piece);
  io.template number<std::int16_t>(r.triangle);
  io.template vector<double>(r.bary);
}
template <class Io, class P>
requires std::same_as<std::remove_const_t<P>, SurfacePatch>
void fields(Io& io, P& p) {
  io.template number<std::int64_t>(p.id);
  io.template number<std::int8_t>(p.tool);
  io.template number<std::int8_t>(p.curved);
  for (auto* x :
       {&p.friction, &p.compliance_m_per_N, &p.alarm_m, &p.spacing_m, &p.half_thickness_m, &p.max_correction_m})
    io.template number<double>(*x);
  for (auto* x : {&p.max_contacts, &p.max_per_piece, &p.first_triangle, &p.triangles, &p.first_piece, &p.pieces,
                  &p.first_replaced, &p.replaced})
    io.template number<std::int16_t>(*x);
}

/// visit(list, its largest size) for each list, in the order of the message.
template <class Patches, class Visit>
bool each_list(Patches& p, Visit&& visit) {
  return visit(p.vertices, SurfacePatches::max_vertices) && visit(p.triangles, SurfacePatches::max_triangles) &&
         visit(p.core, SurfacePatches::max_core) && visit(p.pieces, SurfacePatches::max_pieces) &&
         visit(p.replaced, SurfacePatches::max_replaced) && visit(p.patches, SurfacePatches::max_patches);
}

/// Types of the lists without their memory.
struct Lists {
  struct {
    using value_type = PatchVertex;
  } vertices;
  struct {
    using value_type = PatchTriangle;
  } triangles;
  struct {
    using value_type = Vec3;
  } core;
  struct {
    using value_type = PatchPiece;
  } pieces;
  struct {
    using value_type = ReplacedContact;
  } replaced;
  struct {
    using value_type = SurfacePatch;
  } patches;
};

bool length_ok(double x, double least = 0) { return x >= least && x <= max_length_m; }
bool vector_ok(const Vec3& v, double most) { return v.allFinite() && v.cwiseAbs().maxCoeff() <= most; }
bool range_ok(int first, int count, std::size_t size) {
  return first >= 0 && count >= 0 && std::size_t(first) + std::size_t(count) <= size;
}

/// Checks elements one by one. Sizes of the lists that were read before are known.
struct Check {
  const ProblemLayout& layout;
  std::array<char, max_problem_rows + 3> surface{}, friction{};  ///< by row: in a vertex's block; first of a contact
  std::size_t vertices = 0, triangles = 0, core = 0, pieces = 0, replaced = 0, patches = 0;
  std::array<std::uint64_t, SurfacePatches::max_patches> ids{};

  explicit Check(const ProblemLayout& l) : layout(l) {
    for (int k = 0; k < l.blocks; ++k) {
      const Block b = l.block_at(k);
      if (b.role == BlockRole::surface && b.law == LawKind::box) surface[std::size_t(b.row)] = 1;
      if (b.law == LawKind::friction) friction[std::size_t(b.row)] = 1;
    }
  }
  bool operator()(const PatchVertex& v) {
    ++vertices;
    const auto row = std::size_t(std::max(0, v.row));
    const bool moves = v.row >= 0 && v.row + 3 <= layout.rows && surface[row] && surface[row + 1] && surface[row + 2];
    return vector_ok(v.position, limits::position_m) && v.weighted_normal.allFinite() &&
           v.weighted_normal.norm() < 1 + 1e-9 && (v.row == -1 || moves);
  }
  bool operator()(const PatchTriangle& t) {
    ++triangles;
    return t.open < 8 &&
           std::all_of(t.corner.begin(), t.corner.end(), [&](int v) { return v >= 0 && std::size_t(v) < vertices; }) &&
           t.corner[0] != t.corner[1] && t.corner[1] != t.corner[2] && t.corner[2] != t.corner[0];
  }
  bool operator()(const Vec3& p) {
    ++core;
    return vector_ok(p, 1);
  }
  bool operator()(const PatchPiece& p) {
    ++pieces;
    return p.index >= 0 && p.cores >= 1 && range_ok(p.first_core, p.cores, core) && length_ok(p.radius, 1e-6) &&
           length_ok(p.bound) && vector_ok(p.axis0, 1) && vector_ok(p.axis1, 1);
  }
  bool operator()(const ReplacedContact& r) {
    ++replaced;
    return r.row >= 0 && r.row + 3 <= layout.rows && friction[std::size_t(r.row)] && r.piece >= 0 && r.triangle >= 0 &&
           std::size_t(r.triangle) < triangles && r.bary.minCoeff() >= -1e-6 && std::abs(r.bary.sum() - 1) < 1e-6;
  }
  bool operator()(const SurfacePatch& p) {
    const auto known = ids.begin() + std::ptrdiff_t(patches);
    if (std::find(ids.begin(), known, p.id) != known) return false;
    ids[patches++] = p.id;
    return p.tool >= 0 && p.tool < layout.tools && (p.curved == 0 || p.curved == 1) && p.friction > 0 &&
           p.friction <= max_friction && p.compliance_m_per_N >= 0 && p.compliance_m_per_N <= max_contact_compliance &&
           length_ok(p.alarm_m, 1e-6) && length_ok(p.spacing_m) && length_ok(p.half_thickness_m) &&
           length_ok(p.max_correction_m) && p.max_contacts >= 1 && p.max_contacts <= max_contacts &&
           p.max_per_piece >= 1 && p.max_per_piece <= max_contacts &&
           range_ok(p.first_triangle, p.triangles, triangles) && range_ok(p.first_piece, p.pieces, pieces) &&
           range_ok(p.first_replaced, p.replaced, replaced);
  }
};

}  // namespace

bool patches_fit(const SurfacePatches& p) {
  return each_list(p, [](const auto& list, std::size_t most) { return list.size() <= most; });
}

void write_patches(ByteWriter& out, const SurfacePatches& p, const std::array<int, 2>& tool_number) {
  Writing io(out);
  const auto number = [&](const SurfacePatch& x) {
    return x.tool >= 0 && x.tool < 2 ? tool_number[std::size_t(x.tool)] : -1;
  };
  each_list(p, [&]<class List>(const List& list, std::size_t) {
    if constexpr (std::same_as<typename List::value_type, SurfacePatch>) {
      out.i32(std::int32_t(std::count_if(list.begin(), list.end(), [&](const auto& x) { return number(x) >= 0; })));
      for (SurfacePatch x : list) {
        x.tool = number(x);
        if (x.tool >= 0) fields(io, x);
      }
    } else {
      out.i32(std::int32_t(list.size()));
      for (const auto& x : list) fields(io, x);
    }
    return true;
  });
}

bool skip_patches(ByteReader& in) {
  Reading io(in);
  Lists lists;
  return each_list(lists, [&]<class List>(const List&, std::size_t most) {
    const std::int32_t count = in.i32();
    if (count < 0 || std::size_t(count) > most) return false;
    typename List::value_type x{};
    for (std::int32_t k = 0; k < count && in.ok(); ++k) fields(io, x);
    return in.ok();
  });
}

bool plausible_patches(const ProblemLayout& l, const char*& why) {
  why = "a surface patch is out of range or refers to what is not there";
  ByteReader in(l.patches);
  Reading io(in);
  Check check(l);
  Lists lists;
  return each_list(lists, [&]<class List>(const List&, std::size_t) {
    const std::int32_t count = in.i32();
    typename List::value_type x{};
    for (std::int32_t k = 0; k < count; ++k) {
      fields(io, x);
      if (!check(x)) return false;
    }
    return true;
  });
}

void read_patches(const ProblemLayout& l, SurfacePatches& into) {
  ByteReader in(l.patches);
  Reading io(in);
  each_list(into, [&](auto& list, std::size_t) {
    list.resize(std::size_t(in.i32()));
    for (auto& x : list) fields(io, x);
    return true;
  });
}

}  // namespace insula::wire
