// SPDX-License-Identifier: GPL-3.0-or-later
// A stand-in for Force Dimension's libdhd.so: the functions that the driver uses. An arm that is not open answers -1.
#include "tests/devices/stub_board.h"

namespace {

using insula::testing::board;
using insula::testing::StubArm;

StubArm* arm(char id) {
  if (id < 0 || id > 3) return nullptr;
  StubArm& a = board().arm[int(id)];
  return a.plugged != 0 && a.open != 0 ? &a : nullptr;
}

}  // namespace

extern "C" {

int dhdGetDeviceCount() {
  int n = 0;
  for (int i = 0; i < 4; ++i)
    if (board().arm[i].plugged != 0) n = i + 1;
  return n;
}
int dhdOpenID(char id) {
  if (id < 0 || id > 3) return -1;
  StubArm& a = board().arm[int(id)];
  return a.plugged != 0 && a.open.exchange(1) == 0 ? id : -1;
}
int dhdOpenSerial(int serial) {
  for (int i = 0; i < 4; ++i)
    if (board().arm[i].serial == serial) return dhdOpenID(char(i));
  return -1;
}
int dhdClose(char id) {
  if (id < 0 || id > 3) return -1;
  board().arm[int(id)].open = 0;
  return 0;
}
int dhdGetSerialNumber(unsigned short* serial, char id) {
  if (arm(id) == nullptr) return -1;
  *serial = static_cast<unsigned short>(arm(id)->serial);
  return 0;
}
int dhdGetSystemType(char id) { return arm(id) != nullptr ? arm(id)->type.load() : -1; }
const char* dhdGetSystemName(char id) { return arm(id) != nullptr ? arm(id)->model : nullptr; }
int dhdGetEffectorMass(double* mass, char id) {
  *mass = 0.19;
  return arm(id) != nullptr ? 0 : -1;
}
int dhdEnableForce(unsigned char, char id) { return arm(id) != nullptr ? 0 : -1; }
int dhdSetGravityCompensation(int, char id) { return arm(id) != nullptr ? 0 : -1; }
int dhdGetButton(int index, char id) { return arm(id) != nullptr ? (arm(id)->buttons >> index) & 1 : -1; }
int dhdGetPositionAndOrientationFrame(double* px, double* py, double* pz, double m[3][3], char id) {
  StubArm* a = arm(id);
  if (a == nullptr) return -1;
  a->frames++;
  *px = a->p[0], *py = a->p[1], *pz = a->p[2];
  const double w = a->q[0], x = a->q[1], y = a->q[2], z = a->q[3];
  const double rows[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                             {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                             {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
  std::memcpy(m, rows, sizeof rows);
  return 0;
}
int dhdGetLinearVelocity(double* vx, double* vy, double* vz, char id) {
  StubArm* a = arm(id);
  if (a == nullptr) return -1;
  *vx = a->v[0], *vy = a->v[1], *vz = a->v[2];
  return 1;  // DHD_TIMEGUARD: no error
}
int dhdSetForceAndTorqueAndGripperForce(double fx, double fy, double fz, double tx, double ty, double tz, double,
                                        char id) {
  StubArm* a = arm(id);
  if (a == nullptr) return -1;
  const double f[3] = {fx, fy, fz}, t[3] = {tx, ty, tz};
  for (int i = 0; i < 3; ++i) {
    a->force[i] = f[i];
    a->torque[i] = t[i];
  }
  return 0;
}
const char* dhdErrorGetLastStr() { return "device not found"; }
bool dhdHasActiveWrist(char id) { return arm(id) != nullptr && arm(id)->type >= 104; }

}  // extern "C"
