// SPDX-License-Identifier: GPL-3.0-or-later
// The part of the OpenHaptics HD interface (libHD.so) that the driver uses: names, signatures and numbers of
// OpenHaptics 3.4.
#pragma once
#include <memory>
#include <mutex>

#include "haptic_server/devices/shared_library.h"

namespace insula::hd {

using Handle = unsigned int;            // HHD
using Enum = unsigned int;              // HDenum
using Boolean = unsigned char;          // HDboolean
using CallbackCode = unsigned int;      // HDCallbackCode
using SchedulerHandle = unsigned long;  // HDSchedulerHandle
using Callback = CallbackCode (*)(void*);

struct ErrorInfo {  // HDErrorInfo
  unsigned int code;
  int internal_code;
  Handle device;
};

inline constexpr Handle invalid_handle = 0xFFFFFFFF;       // HD_INVALID_HANDLE
inline constexpr unsigned int success = 0x0000;            // HD_SUCCESS
inline constexpr unsigned int device_fault = 0x0300;       // HD_DEVICE_FAULT and up to HD_TIMER_ERROR: the device
inline constexpr unsigned int last_device_error = 0x0304;  // HD_TIMER_ERROR
inline constexpr Enum current_buttons = 0x2000;            // HD_CURRENT_BUTTONS
inline constexpr Enum current_velocity = 0x2051;           // HD_CURRENT_VELOCITY, mm/s
inline constexpr Enum current_transform = 0x2052;          // HD_CURRENT_TRANSFORM, column by column, mm
inline constexpr Enum device_model_type = 0x2501;          // HD_DEVICE_MODEL_TYPE
inline constexpr Enum device_serial_number = 0x2504;       // HD_DEVICE_SERIAL_NUMBER
inline constexpr Enum usable_workspace = 0x2551;           // HD_USABLE_WORKSPACE_DIMENSIONS, mm, low corner and high
inline constexpr Enum output_dof = 0x2554;                 // HD_OUTPUT_DOF
inline constexpr Enum calibration_style = 0x2555;          // HD_CALIBRATION_STYLE
inline constexpr Enum nominal_max_force = 0x2603;          // HD_NOMINAL_MAX_FORCE, N
inline constexpr Enum current_force = 0x2700;              // HD_CURRENT_FORCE, N
inline constexpr Enum force_output = 0x4000;               // HD_FORCE_OUTPUT
inline constexpr Enum max_force_clamping = 0x4001;         // HD_MAX_FORCE_CLAMPING
inline constexpr CallbackCode callback_done = 0;           // HD_CALLBACK_DONE
inline constexpr CallbackCode callback_continue = 1;       // HD_CALLBACK_CONTINUE
inline constexpr unsigned short default_priority = 65535 / 2;   // HD_DEFAULT_SCHEDULER_PRIORITY
inline constexpr Enum calibration_ok = 0x5000;                  // HD_CALIBRATION_OK
inline constexpr Enum calibration_needs_update = 0x5001;        // HD_CALIBRATION_NEEDS_UPDATE
inline constexpr Enum calibration_needs_manual_input = 0x5002;  // HD_CALIBRATION_NEEDS_MANUAL_INPUT
inline constexpr int button_1 = 1 << 0, button_2 = 1 << 1;      // HD_DEVICE_BUTTON_1, HD_DEVICE_BUTTON_2

/// One for each process, since the library has one scheduler for all devices.
struct Api {
  Api();

  SharedLibrary library;
  Handle (*init_device)(const char* name);
  void (*disable_device)(Handle);
  void (*make_current)(Handle);
  void (*begin_frame)(Handle);
  void (*end_frame)(Handle);
  void (*get_integers)(Enum, int*);
  void (*get_doubles)(Enum, double*);
  const char* (*get_string)(Enum);
  void (*set_doubles)(Enum, const double*);
  void (*enable)(Enum);
  ErrorInfo (*get_error)();
  const char* (*error_string)(unsigned int);
  Enum (*check_calibration)();
  void (*update_calibration)(Enum style);
  void (*start_scheduler)();
  void (*stop_scheduler)();
  SchedulerHandle (*schedule)(Callback, void*, unsigned short priority);
  void (*unschedule)(SchedulerHandle);

  /// The scheduler runs from the first device's start to the last one's end.
  void use_scheduler();
  void leave_scheduler();

  /// Shared by all devices of the process while any of them exists. Its library may be missing: check library.loaded().
  static std::shared_ptr<Api> shared();

 private:
  std::mutex mutex_;
  int users_ = 0;
};

/// Instructions to install the library.
const char* how_to_get();

}  // namespace insula::hd
