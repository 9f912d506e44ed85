// SPDX-License-Identifier: GPL-3.0-or-later
// Names and texts of session files, for those who write and those who read them.
#pragma once
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace insula::session {

inline constexpr const char* profile = "insula";
inline constexpr const char* extension = ".insula";
inline constexpr const char* step_topic = "STEP";  ///< session_step_t; a second one of a number only adds the hash

inline constexpr const char* metrics_topic = "METRICS";    ///< JSON, once a second and at the end of a pass
inline constexpr const char* channels_topic = "CHANNELS";  ///< JSON, ten times a second
inline constexpr const char* channel_names = "channels";   ///< description: number in CHANNELS, name and unit

inline constexpr const char* metric_names = "metrics";     ///< description: id of each metric and its name
inline constexpr const char* review_topic = "REVIEW";      ///< JSON, after a pass: {pass, review} (reports/review.h)
inline constexpr const char* hands_topic = "HANDS";        ///< JSON, ten times a second
inline constexpr const char* frame_topic = "FRAME";        ///< render_frame_t without bodies and drawables
inline constexpr const char* geometry_topic = "GEOMETRY";  ///< bodies and drawables of a frame: picture_codec.h
inline constexpr const char* geometry_encoding = "insula-geometry";
inline constexpr const char* bundle_prefix = "bundle/";  ///< attachments with the viewer's scene bundle

/// In the description, before the names of what a person said of the session.
inline constexpr const char* field_prefix = "field.";
/// "level=expert" as name and value. Throws InputError that says what a field must look like.
std::pair<std::string, std::string> parse_field(const std::string& text);
/// All of them; the last one of a name counts.
std::map<std::string, std::string> parse_fields(const std::vector<std::string>& texts);

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
