// SPDX-License-Identifier: GPL-3.0-or-later
// Finding the functions of libdhd.so.
#include "haptic_server/devices/forcedimension_api.h"

namespace insula::dhd {

Api::Api() : library("INSULA_LIBDHD", {"libdhd.so", "libdhd.so.3", "/usr/local/lib/libdhd.so"}) {
  library.find(device_count, "dhdGetDeviceCount");
  library.find(open_id, "dhdOpenID");
  library.find(open_serial, "dhdOpenSerial", false);
  library.find(close, "dhdClose");
  library.find(serial_number, "dhdGetSerialNumber", false);
  library.find(system_type, "dhdGetSystemType");
  library.find(system_name, "dhdGetSystemName");
  library.find(effector_mass, "dhdGetEffectorMass", false);
  library.find(enable_force, "dhdEnableForce");
  library.find(gravity_compensation, "dhdSetGravityCompensation");
  library.find(button, "dhdGetButton");
  library.find(pose, "dhdGetPositionAndOrientationFrame");
  library.find(linear_velocity, "dhdGetLinearVelocity");
  library.find(set_force, "dhdSetForceAndTorqueAndGripperForce");
  library.find(last_error, "dhdErrorGetLastStr");
  library.find(has_active_wrist, "dhdHasActiveWrist", false);
  library.find(angular_velocity, "dhdGetAngularVelocityRad", false);
}

std::shared_ptr<Api> Api::shared() { return shared_while_used<Api>(); }

const char* how_to_get() {
  return "install Force Dimension's Haptic SDK for Linux (forcedimension.com, Software) and its udev rule; a library "
         "in an "
         "unusual place: INSULA_LIBDHD=/path/libdhd.so";
}

}  // namespace insula::dhd
