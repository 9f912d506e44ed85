// SPDX-License-Identifier: GPL-3.0-or-later
// Meshing of level functions with CGAL.
#include "meshing.h"

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Labeled_mesh_domain_3.h>
#include <CGAL/Mesh_complex_3_in_triangulation_3.h>
#include <CGAL/Mesh_criteria_3.h>
#include <CGAL/Mesh_triangulation_3.h>
#include <CGAL/Random.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/facets_in_complex_3_to_triangle_mesh.h>
#include <CGAL/make_mesh_3.h>

#include <algorithm>
#include <map>
#include <stdexcept>

#include "grid_ops.h"

namespace insula::mesh_tool {
namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Point = Kernel::Point_3;
using BaseDomain = CGAL::Labeled_mesh_domain_3<Kernel>;

Vec3 to_vec(const Point& p) { return {p.x(), p.y(), p.z()}; }

// The library's first points come from random rays out of the middle of the box, which may lie outside the part; these
// start in the part's deepest point.
class LevelDomain : public BaseDomain {
 public:
  template <class Function>
  LevelDomain(Function f, const CGAL::Bbox_3& box, CGAL::Random& random, Vec3 deepest)
#if CGAL_VERSION_NR >= 1060000000
      : BaseDomain(f, box, CGAL::parameters::relative_error_bound(1e-5).p_rng(&random)),
#else
      : BaseDomain(f, box, 1e-5, CGAL::Null_subdomain_index(), &random),
#endif
        deepest_(deepest),
        reach_(box.xmax() - box.xmin() + box.ymax() - box.ymin() + box.zmax() - box.zmin()) {
  }

  struct Construct_initial_points {
    const LevelDomain& domain;
    template <class Output>
    Output operator()(Output out, int = 0) const {
      const Vec3& c = domain.deepest_;
      for (int i = -1; i <= 1; ++i)
        for (int j = -1; j <= 1; ++j)
          for (int k = -1; k <= 1; ++k) {
            if (!i && !j && !k) continue;
            const double s = domain.reach_;
            const Kernel::Segment_3 ray(Point(c[0], c[1], c[2]), Point(c[0] + s * i, c[1] + s * j, c[2] + s * k));
            if (!domain.do_intersect_surface_object()(ray)) continue;
            const auto hit = domain.construct_intersection_object()(ray);
            if (std::get<2>(hit) == 2) *out++ = std::make_pair(std::get<0>(hit), std::get<1>(hit));
          }
      return out;
    }
  };
  Construct_initial_points construct_initial_points_object() const { return {*this}; }

 private:
  Vec3 deepest_;
  double reach_;
};

using Triangulation = CGAL::Mesh_triangulation_3<LevelDomain>::type;
using Complex = CGAL::Mesh_complex_3_in_triangulation_3<Triangulation>;
using Criteria = CGAL::Mesh_criteria_3<Triangulation>;

struct SizingField {
  using FT = double;
  using Point_3 = Point;
  using Index = LevelDomain::Index;
  const SizeField* field;
  template <class P>
  FT operator()(const P& p, int, const Index&) const {
    return (*field)({p.x(), p.y(), p.z()});
  }
};

CGAL::Bbox_3 box_of(const Grid& grid) {
  const Vec3 high = grid.point(grid.size[0] - 1, grid.size[1] - 1, grid.size[2] - 1);
  return {grid.origin[0], grid.origin[1], grid.origin[2], high[0], high[1], high[2]};
}

Vec3 deepest_point(const Grid& grid, const Field& level) {
  Mask outside(level.size());
  for (std::size_t i = 0; i < level.size(); ++i) outside[i] = !(level[i] > 0);
  const Field d = distance_to(grid, outside);
  const auto best = static_cast<int>(std::max_element(d.begin(), d.end()) - d.begin());
  return grid.point(best % grid.size[0], (best / grid.size[0]) % grid.size[1], best / (grid.size[0] * grid.size[1]));
}

}  // namespace

TriangleMesh mesh_surface(const Grid& grid, const Field& level, const SizeField& edge, double error) {
  CGAL::Random random(1);
  CGAL::get_default_random() = CGAL::Random(1);
  const auto inside = [&](const Point& p) { return sample(grid, level, to_vec(p)) > 0 ? 1 : 0; };
  LevelDomain domain(inside, box_of(grid), random, deepest_point(grid, level));
  namespace params = CGAL::parameters;
  Criteria criteria(params::facet_angle = 25, params::facet_size = SizingField{&edge}, params::facet_distance = error);
  const Complex complex =
      CGAL::make_mesh_3<Complex>(domain, criteria, params::no_perturb(), params::no_exude(), params::manifold());

  CGAL::Surface_mesh<Point> surface;
  CGAL::facets_in_complex_3_to_triangle_mesh(complex, surface);
  TriangleMesh out;
  for (const auto v : surface.vertices()) out.points.push_back(to_vec(surface.point(v)));
  for (const auto f : surface.faces()) {
    Triangle t{};
    std::size_t i = 0;
    for (const auto v : surface.vertices_around_face(surface.halfedge(f))) t[i++] = static_cast<int>(v.idx());
    out.triangles.push_back(t);
  }
  keep_largest_component(out);
  if (!is_closed(out.triangles)) throw std::runtime_error("the surface is not closed; take a smaller edge length");
  if (signed_volume(out) < 0)
    for (Triangle& t : out.triangles) std::swap(t[1], t[2]);
  return out;
}

TetMesh mesh_volume(const Grid& grid, const Field& level, const SizeField& edge, const SizeField& error) {
  CGAL::Random random(1);
  CGAL::get_default_random() = CGAL::Random(1);
  const auto inside = [&](const Point& p) { return sample(grid, level, to_vec(p)) > 0 ? 1 : 0; };
  LevelDomain domain(inside, box_of(grid), random, deepest_point(grid, level));
  namespace params = CGAL::parameters;
  const SizingField size{&edge}, distance{&error};
  Criteria criteria(params::facet_angle = 25, params::facet_size = size, params::facet_distance = distance,
                    params::cell_radius_edge_ratio = 2.0, params::cell_size = size);
  Complex complex =
      CGAL::make_mesh_3<Complex>(domain, criteria, params::no_perturb(), params::no_exude(), params::manifold());
  CGAL::odt_optimize_mesh_3(complex, domain, params::max_iteration_number = 30, params::convergence = 0.01,
                            params::freeze_bound = 0, params::do_freeze = false);
  CGAL::perturb_mesh_3(complex, domain, params::sliver_bound = 14, params::time_limit = 0);
  CGAL::exude_mesh_3(complex, params::sliver_bound = 14, params::time_limit = 0);

  TetMesh out;
  std::map<Complex::Vertex_handle, int> number;
  for (auto cell = complex.cells_in_complex_begin(); cell != complex.cells_in_complex_end(); ++cell) {
    Tet tet{};
    for (int i = 0; i < 4; ++i) {
      const auto [entry, fresh] = number.try_emplace(cell->vertex(i), static_cast<int>(out.points.size()));
      if (fresh) {
        const auto& p = cell->vertex(i)->point();
        out.points.push_back({CGAL::to_double(p.x()), CGAL::to_double(p.y()), CGAL::to_double(p.z())});
      }
      tet[static_cast<std::size_t>(i)] = entry->second;
    }
    const auto at = [&](std::size_t i) { return out.points[static_cast<std::size_t>(tet[i])]; };
    if (dot(cross(at(1) - at(0), at(2) - at(0)), at(3) - at(0)) < 0) std::swap(tet[2], tet[3]);
    out.tets.push_back(tet);
  }
  keep_largest_component(out);
  return out;
}

}  // namespace insula::mesh_tool
