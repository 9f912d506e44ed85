// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of a message's content beyond its structure: finite numbers, unit quaternions, known hands, realistic
// magnitudes. A message that is not plausible is dropped.
#pragma once
#include <insula_lcm/device_state_t.hpp>
#include <insula_lcm/hand_input_t.hpp>
#include <insula_lcm/haptic_status_t.hpp>
#include <insula_lcm/metrics_t.hpp>
#include <insula_lcm/render_frame_t.hpp>
#include <insula_lcm/scene_info_t.hpp>
#include <insula_lcm/servo_ticks_t.hpp>
#include <insula_lcm/session_step_t.hpp>
#include <insula_lcm/sim_event_t.hpp>
#include <insula_lcm/soft_guide_t.hpp>
#include <insula_lcm/user_command_t.hpp>
#include <string>

namespace insula {

/// False with the reason in `why`, which otherwise stays unchanged.
bool plausible(const insula_lcm::device_state_t& message, std::string& why);
bool plausible(const insula_lcm::hand_input_t& message, std::string& why);
bool plausible(const insula_lcm::haptic_status_t& message, std::string& why);
bool plausible(const insula_lcm::metrics_t& message, std::string& why);
bool plausible(const insula_lcm::render_frame_t& message, std::string& why);
bool plausible(const insula_lcm::scene_info_t& message, std::string& why);
bool plausible(const insula_lcm::servo_ticks_t& message, std::string& why);
bool plausible(const insula_lcm::session_step_t& message, std::string& why);
bool plausible(const insula_lcm::sim_event_t& message, std::string& why);
bool plausible(const insula_lcm::soft_guide_t& message, std::string& why);
bool plausible(const insula_lcm::user_command_t& message, std::string& why);

/// Whether each count equals the size of its vector, so that the generated encoder stays within them.
bool consistent(const insula_lcm::device_state_t& message);
bool consistent(const insula_lcm::render_frame_t& message);
bool consistent(const insula_lcm::servo_ticks_t& message);
bool consistent(const insula_lcm::session_step_t& message);
template <class Message>
bool consistent(const Message&) {
  return true;  // types without counts
}

/// Numbers of a tick in servo_ticks_t: position, quaternion and force of each hand.
inline constexpr int numbers_of_tick = 20;

/// Shared with the haptic problem's decoder.
namespace limits {
inline constexpr double position_m = 10;        ///< of any coordinate in the scene frame
inline constexpr double unit_tolerance = 1e-4;  ///< of a quaternion's norm
inline constexpr double force_N = 1e4;
inline constexpr double speed_m_s = 1e3;  ///< of a device
inline constexpr double spin_rad_s = 1e5;
inline constexpr double guide_N = 0.5;           ///< largest force of a soft guide
inline constexpr double guide_s[] = {0.6, 1.5};  ///< shortest and longest soft guide
inline constexpr double opening_rad = 3.2;       ///< of an articulated tool, in either direction
}  // namespace limits

/// |v_i| <= most for all; false for NaN.
bool within(const double* values, int count, double most);
bool within(const float* values, int count, double most);
/// A finite quaternion of norm 1.
bool unit_quaternion(const double* wxyz);

}  // namespace insula
