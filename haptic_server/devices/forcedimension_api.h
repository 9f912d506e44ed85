// SPDX-License-Identifier: GPL-3.0-or-later
// The part of Force Dimension's haptic SDK (libdhd.so) that the driver uses: names, signatures and numbers of SDK 3.7.
#pragma once
#include <memory>
#include <mutex>
#include <set>

#include "haptic_server/devices/shared_library.h"

namespace insula::dhd {

inline constexpr int on = 1;  // DHD_ON
/// Results below zero are errors; DHD_TIMEGUARD (1) and DHD_MOTOR_SATURATED (2) are not.
inline bool failed(int result) { return result < 0; }

enum SystemType {  // DHD_DEVICE_...
  omega3 = 33,
  omega6_right = 34,
  omega7_right = 35,
  omega6_left = 36,
  omega7_left = 37,
  falcon = 60,
  delta3 = 63,
  delta6 = 64,
  sigma7_right = 104,
  sigma7_left = 105,
  sigma6_right = 106,
  sigma6_left = 107,
};

struct Api {
  Api();

  SharedLibrary library;
  int (*device_count)();
  int (*open_id)(char id);
  int (*open_serial)(int serial);
  int (*close)(char id);
  int (*serial_number)(unsigned short* serial, char id);
  int (*system_type)(char id);
  const char* (*system_name)(char id);
  int (*effector_mass)(double* mass_kg, char id);
  int (*enable_force)(unsigned char on, char id);
  int (*gravity_compensation)(int on, char id);
  int (*button)(int index, char id);
  int (*pose)(double* x, double* y, double* z, double frame[3][3], char id);
  int (*linear_velocity)(double* x, double* y, double* z, char id);
  int (*set_force)(double fx, double fy, double fz, double tx, double ty, double tz, double gripper, char id);
  const char* (*last_error)();
  // Newer releases only.
  bool (*has_active_wrist)(char id);
  int (*angular_velocity)(double* x, double* y, double* z, char id);

  /// Devices that a hand of this process has open: the first free one must not be that of the other hand.
  std::mutex open_mutex;
  std::set<int> open;

  /// Shared by all devices of the process while any of them exists. Its library may be missing: check library.loaded().
  static std::shared_ptr<Api> shared();
};

const char* how_to_get();

}  // namespace insula::dhd
