// SPDX-License-Identifier: GPL-3.0-or-later
// The module insula._core.
#include <cmath>
#include <stdexcept>

#include "python/src/bind.h"

namespace insula::python {

Pose pose_of(const std::array<double, 3>& position, const std::array<double, 4>& orientation) {
  Pose pose{{position[0], position[1], position[2]}, {orientation[0], orientation[1], orientation[2], orientation[3]}};
  const double size = pose.q.norm();
  if (!pose.p.allFinite() || !std::isfinite(size))
    throw std::invalid_argument("a pose has a number that is not finite");
  if (size < 1e-9) throw std::invalid_argument("the quaternion of a pose is zero");
  if (std::abs(size - 1) > 1e-12) pose.q.coeffs() /= size;  // a unit quaternion keeps its bits
  return pose;
}

int hand_of(const std::string& name) {
  if (name == "left") return 0;
  if (name == "right") return 1;
  throw std::invalid_argument("a hand is \"left\" or \"right\", not \"" + name + "\"");
}

}  // namespace insula::python

NB_MODULE(_core, m) {
  using namespace insula::python;
  m.doc() = "The engine of Insula in this process.";
  m.attr("version") = INSULA_VERSION;
  bind_errors(m);
  bind_xml(m);
  RunClass run(m, "Simulation", "A loaded scene that can be stepped. Made by insula.load().");
  bind_load(m, run);
  bind_stepping(m, run);
  bind_hands(m, run);
  bind_channels(m, run);
  bind_contacts(m, run);
  bind_problem(m, run);
  bind_bodies(m, run);
  bind_state(m, run);
  bind_geometry(m, run);
  bind_exercise(m, run);
  bind_picture(m, run);
}
