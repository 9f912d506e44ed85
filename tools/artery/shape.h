// SPDX-License-Identifier: GPL-3.0-or-later
// The artery as an implicit function: tubes along curves, the sac (an ellipsoid on a funnel) and the bleb (a sphere),
// joined smoothly. Negative inside; near the surface about the distance in mm.
#pragma once
#include "case_table.h"
#include "curve.h"

namespace insula::artery {

enum class Part { parent, superior, inferior, sac, bleb };

class Shape {
 public:
  /// The funnel and the ellipsoid are tuned until section and height over the neck's plane are those of the table.
  explicit Shape(const CaseSpec& spec);

  double value(const Vec3& p) const;
  Vec3 gradient(const Vec3& p) const;
  /// The point of the surface that steepest descent reaches from p.
  Vec3 on_surface(Vec3 p) const;
  /// Which part makes the surface here.
  Part part(const Vec3& p) const;
  double height(const Vec3& p) const { return (p - neck_centre_).dot(axis_); }  ///< over the plane of the neck

  const Curve& tube(int i) const { return tubes_[i]; }  ///< parent, superior, inferior; end at the caps
  Vec3 neck_centre() const { return neck_centre_; }
  Vec3 axis() const { return axis_; }
  double neck_radius() const { return neck_radius_; }
  double dome_height() const { return dome_height_; }
  double sac_radius() const { return a_; }
  Vec3 bleb_centre() const { return bleb_centre_; }
  double bleb_radius() const { return bleb_radius_; }
  Vec3 sac_centre() const { return sac_centre_; }

 private:
  double tube_value(int i, const Vec3& p) const;
  double tubes_value(const Vec3& p) const;
  double sac_value(const Vec3& p) const;
  double bleb_value(const Vec3& p) const { return (p - bleb_centre_).norm() - bleb_radius_; }
  void place_sac(double funnel_radius);
  double neck_section_diameter() const;

  Curve tubes_[3], extended_[3];  ///< the extended ones reach past the caps
  Vec3 axis_, neck_centre_, sac_centre_, bleb_centre_;
  double neck_radius_ = 0, dome_height_ = 0, a_ = 0, c_ = 0, funnel_ = 0, bleb_radius_ = 0;
  bool has_bleb_ = false;
};

}  // namespace insula::artery
