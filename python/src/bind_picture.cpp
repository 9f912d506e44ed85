// SPDX-License-Identifier: GPL-3.0-or-later
// Pictures of the field as arrays.
#include "python/src/bind.h"
#include "python/src/picture.h"

namespace insula::python {
namespace {

Array<std::uint8_t> picture_of(Run& run, int height, int width) {
  if (height < 1 || width < 1 || height > 4096 || width > 4096)
    throw std::invalid_argument("a picture has 1 to 4096 pixels a side");
  const Run::Turn turn(run);
  Picture picture(height, width, camera_of(run.simulation()));
  {
    nb::gil_scoped_release free;
    picture.draw(run.simulation());
  }
  Array<std::uint8_t> out = array<std::uint8_t>({std::size_t(height), std::size_t(width), 3});
  std::copy(picture.pixels().begin(), picture.pixels().end(), out.data());
  return out;
}

}  // namespace

void bind_picture(nb::module_&, RunClass& run) {
  run.def("picture", &picture_of, "height"_a = 240, "width"_a = 320, as_array,
          "A plain picture of the field from the scene's view, for programs: height x width x 3 bytes.");
}

}  // namespace insula::python
