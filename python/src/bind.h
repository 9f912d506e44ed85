// SPDX-License-Identifier: GPL-3.0-or-later
// What the files of the module share: the parts that they bind, and arrays.
#pragma once
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/vector.h>

#include <array>
#include <initializer_list>
#include <memory>
#include <utility>

#include "python/src/run.h"

namespace insula::python {

namespace nb = nanobind;
using namespace nb::literals;

/// The class that others add their part to.
using RunClass = nb::class_<Run>;

void bind_errors(nb::module_& m);
void bind_xml(nb::module_& m);
void bind_load(nb::module_& m, RunClass& run);
void bind_stepping(nb::module_& m, RunClass& run);
void bind_hands(nb::module_& m, RunClass& run);
void bind_channels(nb::module_& m, RunClass& run);
void bind_contacts(nb::module_& m, RunClass& run);
void bind_problem(nb::module_& m, RunClass& run);
void bind_bodies(nb::module_& m, RunClass& run);
void bind_state(nb::module_& m, RunClass& run);
void bind_geometry(nb::module_& m, RunClass& run);
void bind_exercise(nb::module_& m, RunClass& run);
void bind_picture(nb::module_& m, RunClass& run);

/// For properties that return an array, which has an owner of its own.
inline constexpr auto as_array = nb::rv_policy::automatic;

template <class T>
using Array = nb::ndarray<nb::numpy, T>;

/// A read-only view of memory that lives as long as `owner`.
template <class T>
Array<const T> view(const T* data, std::initializer_list<std::size_t> shape, nb::handle owner) {
  return Array<const T>(data, shape, owner);
}

/// An array with memory of its own, filled with zeros.
template <class T>
Array<T> array(std::initializer_list<std::size_t> shape) {
  std::size_t n = 1;
  for (const std::size_t s : shape) n *= s;
  auto memory = std::make_unique<T[]>(std::max<std::size_t>(n, 1));
  nb::capsule owner(memory.get(), [](void* p) noexcept { delete[] static_cast<T*>(p); });
  return Array<T>(memory.release(), shape, owner);
}

/// Rows of three numbers.
inline Array<double> rows_of(const std::vector<Vec3>& points) {
  Array<double> out = array<double>({points.size(), 3});
  for (std::size_t i = 0; i < points.size(); ++i)
    for (int k = 0; k < 3; ++k) out.data()[3 * i + std::size_t(k)] = points[i][k];
  return out;
}
template <std::size_t n>
Array<const int> rows_of(const std::vector<std::array<int, n>>& elements, nb::handle owner) {
  static_assert(sizeof(std::array<int, n>) == n * sizeof(int));
  return view(elements.empty() ? nullptr : elements.front().data(), {elements.size(), n}, owner);
}
template <class Vector>
Array<double> numbers_of(const Vector& v) {
  Array<double> out = array<double>({std::size_t(v.size())});
  for (std::size_t i = 0; i < std::size_t(v.size()); ++i) out.data()[i] = v.data()[i];
  return out;
}

/// Position (m) and orientation as a quaternion w x y z.
using PoseTuple = std::pair<std::array<double, 3>, std::array<double, 4>>;
inline PoseTuple tuple_of(const Pose& p) { return {{p.p.x(), p.p.y(), p.p.z()}, {p.q.w(), p.q.x(), p.q.y(), p.q.z()}}; }
/// Throws std::invalid_argument if a number is not finite or the quaternion is zero. Makes its length one.
Pose pose_of(const std::array<double, 3>& position, const std::array<double, 4>& orientation);
/// "left" or "right" to 0 or 1. Throws std::invalid_argument for anything else.
int hand_of(const std::string& name);

}  // namespace insula::python
