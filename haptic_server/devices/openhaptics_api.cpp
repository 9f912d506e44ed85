// SPDX-License-Identifier: GPL-3.0-or-later
// Finding the functions of libHD.so.
#include "haptic_server/devices/openhaptics_api.h"

namespace insula::hd {

Api::Api()
    : library("INSULA_LIBHD", {"libHD.so", "libHD.so.3.4", "/usr/lib/libHD.so", "/opt/OpenHaptics/lib/libHD.so"}) {
  library.find(init_device, "hdInitDevice");
  library.find(disable_device, "hdDisableDevice");
  library.find(make_current, "hdMakeCurrentDevice");
  library.find(begin_frame, "hdBeginFrame");
  library.find(end_frame, "hdEndFrame");
  library.find(get_integers, "hdGetIntegerv");
  library.find(get_doubles, "hdGetDoublev");
  library.find(get_string, "hdGetString");
  library.find(set_doubles, "hdSetDoublev");
  library.find(enable, "hdEnable");
  library.find(get_error, "hdGetError");
  library.find(error_string, "hdGetErrorString");
  library.find(check_calibration, "hdCheckCalibration");
  library.find(update_calibration, "hdUpdateCalibration");
  library.find(start_scheduler, "hdStartScheduler");
  library.find(stop_scheduler, "hdStopScheduler");
  library.find(schedule, "hdScheduleAsynchronous");
  library.find(unschedule, "hdUnschedule");
}

std::shared_ptr<Api> Api::shared() { return shared_while_used<Api>(); }

void Api::use_scheduler() {
  std::lock_guard lock(mutex_);
  if (users_++ == 0) start_scheduler();
}

void Api::leave_scheduler() {
  std::lock_guard lock(mutex_);
  if (--users_ == 0) stop_scheduler();
}

const char* how_to_get() {
  return "install 3D Systems' OpenHaptics for Linux and the Touch driver (support.3dsystems.com), name each arm with "
         "the "
         "driver's setup program; a library in an unusual place: INSULA_LIBHD=/path/libHD.so";
}

}  // namespace insula::hd
