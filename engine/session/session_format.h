// SPDX-License-Identifier: GPL-3.0-or-later
// Names and texts of session files, for those who write and those who read them.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

namespace insula::session {

inline constexpr const char* profile = "insula";
inline constexpr const char* extension = ".insula";
inline constexpr const char* step_topic = "STEP";  ///< session_step_t; a second one of a number only adds the hash

/// The program that writes, with its version.
std::string library();
/// The declaration of a message type, as in lcm_types/. Throws std::out_of_range if there is none.
std::string schema_of(std::string_view type);
/// That which this run's kernels use: "sse2", "avx2", "avx512". Others give other bits.
std::string instruction_set();
/// 16 hexadecimal digits.
std::string hex(std::uint64_t value);
/// The shortest text that reads back as the same number.
std::string exact(double value);

}  // namespace insula::session
