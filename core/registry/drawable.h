// SPDX-License-Identifier: GPL-3.0-or-later
// A component's drawables: what the page draws of it. They are declared as parameters are, and filled in `publish`.
//
//   Polylines thread{this, {.name = "thread", .doc = "the thread", .material = "silk", .radius = "0.1 mm"}};
//   void publish() override { thread.resize(1); thread.set(0, 0, a, 1); thread.set(0, 1, b, 1); }
//
// Positions are in the scene frame, metres. Every element has a value. The declaration states its meaning.
#pragma once
#include <array>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/math.h"

namespace insula {

class Component;

enum class DrawableKind { points, polylines, patch, plane, label, links };
std::string_view drawable_kind_name(DrawableKind kind);

struct DrawableSpec {
  std::string_view name;
  std::string_view doc;                 ///< one line
  std::string_view material;            ///< name of a material of the registry or the scene
  std::string_view value = {};          ///< meaning of the value, one line; empty: it is not used
  std::string_view unit = {};           ///< SI unit of the value
  std::string_view radius = "0.15 mm";  ///< of points and polylines, a length with its unit
  int points_per_line = 2;              ///< of polylines
  std::string_view text = "{}";         ///< of labels; {} is replaced by the value
  std::string_view rate_channel = {};   ///< own channel with the speed of a fluid; may be empty
};

/// Base of every drawable, with the data for frames and bundles.
class DrawableBase {
 public:
  /// Throws std::logic_error for a wrong declaration.
  DrawableBase(Component* owner, DrawableSpec spec, DrawableKind kind);
  virtual ~DrawableBase() = default;
  DrawableBase(const DrawableBase&) = delete;
  DrawableBase& operator=(const DrawableBase&) = delete;

  const DrawableSpec& spec() const { return spec_; }
  DrawableKind kind() const { return kind_; }
  /// Its material: that of the declaration, unless prepare() has replaced it.
  const std::string& material() const { return material_; }
  void set_material(std::string name) { material_ = std::move(name); }
  double radius() const { return radius_; }  ///< m
  /// The numbers of a frame, in the layout of lcm_types/render_frame.lcm.
  const std::vector<float>& data() const { return data_; }
  int floats_per_element() const;  ///< of one point, line, vertex, plane, label or link
  int count() const { return int(data_.size()) / floats_per_element(); }

 protected:
  void put(std::size_t at, const Vec3& p) {
    for (int k = 0; k < 3; ++k) data_[at + std::size_t(k)] = float(p[k]);
  }
  void put(std::size_t at, const Vec3& p, double value) {
    put(at, p);
    data_[at + 3] = float(value);
  }
  void resize_elements(std::size_t n) { data_.resize(n * std::size_t(floats_per_element())); }
  std::vector<float> data_;

 private:
  DrawableSpec spec_;
  DrawableKind kind_;
  std::string material_;
  double radius_ = 0;
};

class Points final : public DrawableBase {
 public:
  Points(Component* owner, DrawableSpec spec) : DrawableBase(owner, spec, DrawableKind::points) {}
  void resize(std::size_t n) { resize_elements(n); }
  void set(std::size_t i, const Vec3& p, double value) { put(4 * i, p, value); }
};

/// Lines of a fixed number of points each. A line whose first value is negative is not drawn.
class Polylines final : public DrawableBase {
 public:
  Polylines(Component* owner, DrawableSpec spec) : DrawableBase(owner, spec, DrawableKind::polylines) {}
  void resize(std::size_t lines) { resize_elements(lines); }
  void set(std::size_t line, std::size_t point, const Vec3& p, double value) {
    put(4 * (line * std::size_t(spec().points_per_line) + point), p, value);
  }
};

/// A surface of fixed triangles whose vertices move.
class Patch final : public DrawableBase {
 public:
  Patch(Component* owner, DrawableSpec spec) : DrawableBase(owner, spec, DrawableKind::patch) {}
  /// Called once, in connect() at the latest. Throws std::logic_error if a triangle has an invalid vertex.
  void set_triangles(std::vector<std::array<int, 3>> triangles, std::size_t vertices);
  const std::vector<std::array<int, 3>>& triangles() const { return triangles_; }
  void set(std::size_t vertex, const Vec3& p, double value) { put(4 * vertex, p, value); }

 private:
  std::vector<std::array<int, 3>> triangles_;
};

/// A round plane area, such as the surface of a fluid.
class Plane final : public DrawableBase {
 public:
  Plane(Component* owner, DrawableSpec spec) : DrawableBase(owner, spec, DrawableKind::plane) { resize_elements(1); }
  void set(const Vec3& origin, const Vec3& normal, double radius, double value) {
    put(0, origin);
    put(3, normal);
    data_[6] = float(radius);
    data_[7] = float(value);
  }
};

/// Text at a position.
class Label final : public DrawableBase {
 public:
  Label(Component* owner, DrawableSpec spec) : DrawableBase(owner, spec, DrawableKind::label) { resize_elements(1); }
  void set(const Vec3& p, double value) { put(0, p, value); }
};

/// Rigid parts, each with a mesh in its own frame. Further links use the last part's mesh.
class Links final : public DrawableBase {
 public:
  struct Part {
    std::vector<Vec3> vertices;
    std::vector<std::array<int, 3>> triangles;
  };
  Links(Component* owner, DrawableSpec spec) : DrawableBase(owner, spec, DrawableKind::links) {}
  /// Called once, in connect() at the latest.
  void set_parts(std::vector<Part> parts) { parts_ = std::move(parts); }
  const std::vector<Part>& parts() const { return parts_; }
  void resize(std::size_t n) { resize_elements(n); }
  void set(std::size_t i, const Pose& pose, double value);

 private:
  std::vector<Part> parts_;
};

}  // namespace insula
