// SPDX-License-Identifier: GPL-3.0-or-later
/*
# membrane

The wall of a shell. Plane-stress triangles in a frame that turns with each of them model its stretch (Comas, Duriez,
Cotin 2010). The curvature over each triangle models its bending. Both forces are the exact gradient of an energy.
They have no resultant force and no moment, and they are zero under rigid motion.

- Stretch: `stretch.h`. The step's tangent contains Hooke's law and the geometric stiffness of tension (its positive
  semidefinite part), which stabilises an inflated wall.
- Bending: `bend.h`, `slope.h`. This is Morley's triangle with slopes interpolated from the angles between triangles.
  It is exact for quadratic deflections on any mesh. Rest curvature gives no force. The step's tangent is the
  Gauss-Newton part.

The usual energy of hinges (a spring on the angle of each edge) is not used. The deflection of such a plate depends on
how the mesh is cut. It is a tenth too small on irregular meshes and a third too small on some regular ones.
Refinement does not improve it.

Several membranes share a shell by `regions`; every triangle has exactly one. A membrane with `spots` is a part of
those regions, such as a plaque: it lies in place of the membrane without spots that has the region. Each spot begins
at the triangle nearest to its point and grows over the wall as far as `spot_radius`. Of two membranes with spots, the
later one counts where both would lie.

Where two membranes meet, each bends its own triangles against the common slope, so the border is no hinge. A free rim
carries no moment. Fixed nodes keep their position, not their slope: fix two rows of them to clamp a rim. Caps carry no
wall.

With a prestrain, the wall is under tension in the imaged shape. The prestrain is a strain of each triangle and a
change of each rest angle. Both are linear in the displacement to the stress-free configuration.

A triangle that is compressed below a tenth of its rest area bends more softly than the law says, since the gradient
of its angle is bounded.

Sources: Comas, Duriez, Cotin 2010 (co-rotational membrane); Morley 1968; Onate, Cervera 1993 (rotation-free bending);
Grinspun et al. 2006 (convergence of discrete curvatures); Tamstorf, Grinspun 2013 (derivatives of the angle).
*/
#include <algorithm>

#include "core/base/text.h"
#include "core/mechanics/shell_body.h"
#include "core/registry/registry.h"
#include "plugins/membrane/bend.h"

namespace insula {
namespace {

class Membrane final : public ForceModel {
 public:
  Param<std::string> regions{
      this,
      {.name = "regions", .fallback = "", .doc = "regions of the wall it is, separated by blanks; none: all of them"}};
  Param<std::string> spots{this,
                           {.name = "spots",
                            .fallback = "",
                            .doc = "only parts of those regions, about points of the wall at rest separated by "
                                   "semicolons: \"12 3 4 mm; 12.5 3 4 mm\"; none: all of them"}};
  Param<Length> spot_radius{
      this,
      {.name = "spot_radius", .fallback = "1 mm", .min = "0.1 mm", .max = "20 mm", .doc = "how far each spot reaches"}};
  Param<Length> thickness{
      this, {.name = "thickness", .fallback = "0.3 mm", .min = "1 um", .max = "10 mm", .doc = "of the wall"}};
  Param<Pressure> young{
      this, {.name = "young", .fallback = "1 MPa", .min = "1 Pa", .max = "10 GPa", .doc = "Young's modulus"}};
  Param<Scalar> poisson{this,
                        {.name = "poisson", .fallback = "0.45", .min = "0", .max = "0.495", .doc = "Poisson's ratio"}};
  Param<Density> density{this,
                         {.name = "density",
                          .fallback = "1.1 g/cm3",
                          .min = "0.01 g/cm3",
                          .max = "25 g/cm3",
                          .doc = "mass density of the wall"}};
  Param<SurfaceMass> added_mass{this,
                                {.name = "added_mass",
                                 .fallback = "0 kg/m2",
                                 .min = "0 kg/m2",
                                 .max = "1000 kg/m2",
                                 .doc = "mass per area that moves with the wall: blood, fluid around it"}};
  Param<Rate> mass_damping{this,
                           {.name = "mass_damping",
                            .fallback = "1 1/s",
                            .min = "0 1/s",
                            .max = "1000 1/s",
                            .doc = "Rayleigh damping in proportion to mass"}};
  Param<Duration> stiffness_time{this,
                                 {.name = "stiffness_damping",
                                  .fallback = "2 ms",
                                  .min = "0 s",
                                  .max = "1 s",
                                  .doc = "Rayleigh damping in proportion to stiffness"}};
  Param<Choice> tangent{this,
                        {.name = "tangent",
                         .fallback = "hinges",
                         .choices = {"hinges", "patches"},
                         .doc = "bending in the system matrix: each hinge by itself, an upper bound that keeps the "
                                "factor small; or whole patches of twelve nodes, which settle in fewer steps"}};

  void attach(PrepareContext& context, DeformableBody& body) override;
  void couplings(std::vector<std::pair<int, int>>& pairs, Tangent which) const override;
  void bind(const BlockMatrix& a, const std::vector<int>& free_of_node) override;
  void add_mass(std::vector<double>& mass, std::vector<double>& damping) const override;
  void linearise(const double* x, double* force, BlockMatrix* stiffness, double h, Tangent which) override;
  double energy(const double* x) override { return stretch_.energy(x) + bend_.energy(x); }
  bool add_stress(const double* x, std::vector<Mat3>& stress) const override;
  bool prestrain(const double* u) override;
  double stiffness_damping() const override { return stiffness_time(); }
  double wall_thickness(int region) const override {
    return std::size_t(region) < own_.size() && owns(region) && !spotted() ? thickness() : 0;
  }
  void reset() override { bend_.reset(); }

 private:
  bool choose_regions(PrepareContext& context, const ShellBody& shell);
  void check_cover(PrepareContext& context, const ShellBody& shell) const;
  std::vector<char> own_triangles(const ShellBody& shell, const WallTopology& wall, std::string& wrong) const;
  std::vector<char> meant_triangles(const ShellBody& shell, const WallTopology& wall, std::string& wrong) const;
  bool spotted() const { return !spots().empty(); }
  bool owns(int region) const { return own_[std::size_t(region)] != 0; }

  const ShellBody* shell_ = nullptr;
  std::vector<char> own_;  // one a region of the shell
  StretchTriangles stretch_;
  BendPatches bend_;
  std::vector<std::array<int, 3>> triangles_;
  std::vector<int> of_wall_;  // number of each of them in the wall
  std::vector<double> area_;  // m2, one a triangle of its own
};

bool Membrane::choose_regions(PrepareContext& context, const ShellBody& shell) {
  const std::vector<std::string>& names = shell.model().regions;
  own_.assign(names.size(), 0);
  const auto words = split_blanks(regions());
  if (words.empty()) own_.assign(names.size(), 1);
  bool good = true;
  for (const std::string_view word : words) {
    const int r = shell.region(word);
    if (r >= 0) {
      own_[std::size_t(r)] = 1;
      continue;
    }
    const std::string near = nearest_name(word, names);
    error(context, regions,
          in_quotes(word) + " is no region of the wall" + did_you_mean(near) + " (it has " + joined(names) + ")");
    good = false;
  }
  return good;
}

/// Called by the last membrane of the shell: every triangle has exactly one membrane.
void Membrane::check_cover(PrepareContext& context, const ShellBody& shell) const {
  const std::vector<std::string>& names = shell.model().regions;
  const auto all = shell.children_of<Membrane>();
  if (all.back() != this) return;
  for (const Membrane* m : all)
    if (m->own_.size() != names.size()) return;
  std::vector<char> used(names.size(), 0);
  for (const auto& t : shell.wall_triangles()) used[std::size_t(shell.region_of_triangle(t))] = 1;
  std::vector<std::string> bare;
  for (std::size_t r = 0; r < names.size(); ++r) {
    const Membrane* owner = nullptr;
    for (const Membrane* m : all) {
      if (!m->own_[r] || m->spotted()) continue;
      if (owner)
        m->error(context, m->regions,
                 in_quotes(names[r]) + " is the wall of " + owner->id + " already; each region has one membrane");
      owner = m;
    }
    if (!owner && used[r]) bare.push_back(names[r]);
  }
  if (!bare.empty()) error(context, "no membrane of this shell is the wall of " + joined(bare));
}

/// One flag a triangle: it is of its regions, and of its spots if it has any.
std::vector<char> Membrane::meant_triangles(const ShellBody& shell, const WallTopology& wall,
                                            std::string& wrong) const {
  const auto words = split_blanks(regions());
  std::vector<char> regions_of(shell.model().regions.size(), words.empty());
  for (const std::string_view word : words)
    if (const int r = shell.region(word); r >= 0) regions_of[std::size_t(r)] = 1;
  std::vector<char> out(wall.triangles.size(), 1);
  if (spotted()) {
    const std::vector<Vec3> points = read_spots(spots(), wrong);
    if (!wrong.empty()) return out;
    out = spot_triangles(wall, shell.rest_nodes(), points, spot_radius(), wrong);
  }
  for (std::size_t t = 0; t < out.size(); ++t)
    if (!regions_of[std::size_t(shell.region_of_triangle(wall.triangles[t]))]) out[t] = 0;
  return out;
}

/// Without those that another membrane of the shell takes by its spots.
std::vector<char> Membrane::own_triangles(const ShellBody& shell, const WallTopology& wall, std::string& wrong) const {
  std::vector<char> out = meant_triangles(shell, wall, wrong);
  bool later = false;
  for (const Membrane* m : shell.children_of<Membrane>()) {
    if (m == this) later = true;
    else if (m->spotted() && (later || !spotted())) {
      std::string told_by_itself;
      const std::vector<char> taken = m->meant_triangles(shell, wall, told_by_itself);
      for (std::size_t t = 0; t < out.size(); ++t)
        if (taken[t] && told_by_itself.empty()) out[t] = 0;
    }
  }
  return out;
}

void Membrane::attach(PrepareContext& context, DeformableBody& body) {
  const auto* shell = dynamic_cast<const ShellBody*>(&body);
  if (!shell) return error(context, "needs a wall of triangles: it belongs in a <shell_body>");
  if (shell->model().regions.empty()) return;  // the body's own error is reported
  if (!choose_regions(context, *shell)) {
    own_.clear();
    return;
  }
  check_cover(context, *shell);
  const std::vector<Vec3>& rest = shell->rest_nodes();
  shell_ = shell;
  WallTopology wall;
  if (const std::string wrong = wall.build(rest, shell->wall_triangles()); !wrong.empty()) return error(context, wrong);
  std::string wrong_spots;
  const std::vector<char> mine = own_triangles(*shell, wall, wrong_spots);
  if (!wrong_spots.empty()) return error(context, spots, wrong_spots);
  const StretchTriangles::Material material{thickness(), young(), poisson()};
  std::vector<const StretchTriangles::Material*> of_triangle(wall.triangles.size(), nullptr);
  stretch_.clear();
  triangles_.clear();
  of_wall_.clear();
  area_.clear();
  for (std::size_t t = 0; t < wall.triangles.size(); ++t) {
    const auto& v = wall.triangles[t];
    if (!mine[t]) continue;
    of_triangle[t] = &material;
    triangles_.push_back(v);
    of_wall_.push_back(int(t));
    area_.push_back(0.5 * (rest[std::size_t(v[1])] - rest[std::size_t(v[0])])
                              .cross(rest[std::size_t(v[2])] - rest[std::size_t(v[0])])
                              .norm());
    stretch_.add(rest, v, material);
  }
  bend_.build(wall, rest, of_triangle);
}

void Membrane::couplings(std::vector<std::pair<int, int>>& pairs, Tangent which) const {
  stretch_.couplings(pairs);
  bend_.couplings(pairs, which, tangent.is("patches"));
}

void Membrane::bind(const BlockMatrix& a, const std::vector<int>& free_of_node) {
  stretch_.bind(a, free_of_node);
  bend_.bind(a, free_of_node);
}

void Membrane::add_mass(std::vector<double>& mass, std::vector<double>& damping) const {
  for (std::size_t t = 0; t < triangles_.size(); ++t)
    for (int n : triangles_[t]) {
      const double m = (density() * thickness() + added_mass()) * area_[t] / 3;
      mass[std::size_t(n)] += m;
      damping[std::size_t(n)] += mass_damping() * m;
    }
}

void Membrane::linearise(const double* x, double* force, BlockMatrix* stiffness, double h, Tangent which) {
  const double scale = 1 + (h > 0 ? stiffness_time() / h : 0);
  stretch_.linearise(x, force, stiffness, scale, which);
  bend_.linearise(x, force, stiffness, scale, which, tangent.is("patches"));
}

bool Membrane::add_stress(const double* x, std::vector<Mat3>& stress) const {
  std::vector<double> volume = area_;
  for (double& v : volume) v *= thickness();
  stretch_.add_stress(x, of_wall_, volume, stress);
  return !triangles_.empty();
}

bool Membrane::prestrain(const double* u) {
  if (triangles_.empty()) return false;
  const double* rest = shell_->rest_nodes().front().data();
  stretch_.prestrain(rest, u);
  bend_.prestrain(rest, u);
  return true;
}

}  // namespace
}  // namespace insula

INSULA_PLUGIN(membrane) {
  registry.add_material({"vessel", "wall", {0.50, 0.10, 0.08, 1}, 0.46, 0, 0.3});
  registry.add<insula::Membrane>("membrane", insula::Kind::force_model,
                                 "wall of a shell that resists stretch and bending");
}
