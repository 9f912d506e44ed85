// SPDX-License-Identifier: GPL-3.0-or-later
// The channels of the bus and the message type of each.
#pragma once
#include <cstddef>
#include <string_view>

namespace insula::channel {

inline constexpr std::string_view haptic_problem = "HAPTIC_PROBLEM";  ///< haptic_problem_t, engine -> haptic server
inline constexpr std::string_view device_state = "DEVICE_STATE";      ///< device_state_t, haptic server -> all
inline constexpr std::string_view haptic_status = "HAPTIC_STATUS";    ///< haptic_status_t, haptic server -> all
inline constexpr std::string_view render_frame = "RENDER_FRAME";      ///< render_frame_t, engine -> viewers
inline constexpr std::string_view metrics = "METRICS";                ///< metrics_t, engine -> viewers
inline constexpr std::string_view scene_info = "SCENE_INFO";          ///< scene_info_t, engine -> all
inline constexpr std::string_view servo_ticks = "SERVO_TICKS";        ///< servo_ticks_t, haptic server -> recorder
inline constexpr std::string_view soft_guide = "SOFT_GUIDE";          ///< soft_guide_t, engine -> haptic server
inline constexpr std::string_view sim_event = "SIM_EVENT";            ///< sim_event_t, engine -> all
inline constexpr std::string_view user_command = "USER_COMMAND";      ///< user_command_t, viewer -> engine
inline constexpr std::string_view hand_input = "HAND_INPUT";          ///< hand_input_t, viewer -> haptic server

}  // namespace insula::channel

namespace insula {

/// Larger messages are refused by every decoder. LCM loses messages over about 120 KB with the default socket buffers
/// of the kernel. Senders stay below that if possible.
inline constexpr std::size_t max_message_bytes = 512 * 1024;

}  // namespace insula
