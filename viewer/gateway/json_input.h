// SPDX-License-Identifier: GPL-3.0-or-later
// Values of JSON that comes from outside.
#pragma once
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

namespace insula::gateway {

/// Of a file; a discarded value if it cannot be read or is no JSON.
nlohmann::json read_json(const std::filesystem::path& file);
/// A member of an object; empty if it is missing or no text.
std::string text_of(const nlohmann::json& body, const char* name);

}  // namespace insula::gateway
