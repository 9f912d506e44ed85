// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/secrets.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "core/base/input_error.h"
#include "core/base/pin.h"
#include "core/base/private_file.h"
#include "core/base/system_random.h"

namespace insula::gateway {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t most_bytes_of_secret = 4096;

bool all_of(const std::string& text, bool (*good)(char)) { return std::all_of(text.begin(), text.end(), good); }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_key_character(char c) {
  return is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '-' || c == '_';
}

std::string read_private(const fs::path& file) {
  check_private(file);
  std::ifstream in(file, std::ios::binary);
  std::string text(std::istreambuf_iterator<char>(in), {});
  if (!in || text.size() > most_bytes_of_secret) throw InputError(fmt::format("{} holds no secret", file.string()));
  return text;
}

}  // namespace

bool is_key(const std::string& text) {
  return text.size() >= 32 && text.size() <= 128 && all_of(text, is_key_character);
}

std::string new_key() { return system_random(64, "0123456789abcdef"); }

void read_pins(const fs::path& file, Secrets& secrets) {
  const auto json = nlohmann::json::parse(read_private(file), nullptr, false);
  for (const auto& [name, pin] : {std::pair{"pin", &secrets.pin}, std::pair{"observer_pin", &secrets.observer_pin}}) {
    if (!json.is_object() || !json.contains(name)) continue;
    *pin = json[name].is_string() ? json[name].get<std::string>() : std::string();
    if (!is_pin(*pin)) throw InputError(fmt::format("{}: {} must be 6 to 12 digits", file.string(), name));
  }
  if (secrets.pin.empty()) throw InputError(fmt::format("{} holds no PIN", file.string()));
  if (secrets.pin == secrets.observer_pin)
    throw InputError(fmt::format("{}: instructors and observers need different PINs", file.string()));
}

void read_key(const fs::path& file, Secrets& secrets) {
  std::string key = read_private(file);
  while (!key.empty() && (key.back() == '\n' || key.back() == '\r')) key.pop_back();
  if (!is_key(key))
    throw InputError(fmt::format("{}: a key is one line of 32 to 128 letters, digits, - and _", file.string()));
  secrets.key = key;
}

}  // namespace insula::gateway
