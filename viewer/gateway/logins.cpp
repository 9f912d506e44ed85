// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/logins.h"

#include <openssl/crypto.h>
#include <openssl/sha.h>

#include <algorithm>
#include <array>
#include <utility>

#include "core/base/pin.h"
#include "core/base/system_random.h"
#include "core/base/text.h"

namespace insula::gateway {
namespace {

std::string digest(const std::string& text) {
  std::array<unsigned char, SHA256_DIGEST_LENGTH> out{};
  SHA256(reinterpret_cast<const unsigned char*>(text.data()), text.size(), out.data());
  return {out.begin(), out.end()};
}

/// In a time that does not depend on where they differ. An empty secret is none.
bool same_secret(const std::string& given, const std::string& secret) {
  const std::string a = digest(given), b = digest(secret);
  return CRYPTO_memcmp(a.data(), b.data(), a.size()) == 0 && !secret.empty();
}

std::string new_secret() { return system_random(64, "0123456789abcdef"); }  // 256 bits

/// A PIN that was typed into the wrong field is not kept.
bool is_name_of_person(const std::string& name) {
  const auto control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  return !name.empty() && name.size() <= 60 && !is_pin(name) && find_invalid_utf8(name) == name.npos &&
         std::none_of(name.begin(), name.end(), control);
}

template <class Map, class Time>
void drop_ended(Map& map, Time now) {
  std::erase_if(map, [&](const auto& entry) { return entry.second.ends <= now; });
}

template <class Map>
void make_room(Map& map, std::size_t most) {
  while (map.size() >= most)
    map.erase(std::min_element(map.begin(), map.end(),
                               [](const auto& a, const auto& b) { return a.second.ends < b.second.ends; }));
}

}  // namespace

Logins::Logins(Secrets secrets, std::function<Clock::time_point()> now)
    : secrets_(std::move(secrets)), now_(std::move(now)) {}

bool Logins::too_many_wrong(const std::string& address) {
  const auto minute_ago = now_() - std::chrono::minutes(1);
  const auto forget = [&](auto& times) {
    while (!times.empty() && times.front() <= minute_ago) times.pop_front();
    return times.empty();
  };
  for (auto i = wrong_.begin(); i != wrong_.end();) i = forget(i->second) ? wrong_.erase(i) : std::next(i);
  forget(wrong_of_all_);
  const auto found = wrong_.find(address);
  return wrong_until_now_ >= wrong_ever || wrong_of_all_.size() >= std::size_t(wrong_a_minute_of_all) ||
         (found != wrong_.end() && found->second.size() >= std::size_t(wrong_a_minute));
}

Logins::Outcome Logins::refuse(const std::string& address, std::string why) {
  wrong_[address].push_back(now_());
  wrong_of_all_.push_back(now_());
  ++wrong_until_now_;
  return {Access::none, {}, false, std::move(why)};
}

Logins::Outcome Logins::admit(Access access, const std::string& name) {
  drop_ended(tokens_, now_());
  make_room(tokens_, most_tokens);
  std::string token = new_secret();
  const std::string number = "login " + std::to_string(++logins_);
  const std::string who = is_name_of_person(name) ? name + " (" + number + ")" : number;
  tokens_[digest(token)] = {access, now_() + lasts, who};
  return {access, std::move(token), false, {}, who};
}

Logins::Outcome Logins::log_in(const std::string& pin, const std::string& address, const std::string& name) {
  if (too_many_wrong(address)) return {Access::none, {}, true, "too many wrong tries"};
  // Both are compared, so that the time does not tell which one it is not.
  const bool instructor = same_secret(pin, secrets_.pin), observer = same_secret(pin, secrets_.observer_pin);
  if (!instructor && !observer) return refuse(address, "this is not the PIN");
  return admit(instructor ? Access::instructor : Access::observer, name);
}

std::string Logins::ticket() {
  drop_ended(tickets_, now_());
  make_room(tickets_, most_tokens);
  std::string out = new_secret();
  tickets_[digest(out)] = {Access::instructor, now_() + ticket_lasts};
  return out;
}

Logins::Outcome Logins::redeem(const std::string& ticket, const std::string& address) {
  if (too_many_wrong(address)) return {Access::none, {}, true, "too many wrong tries"};
  drop_ended(tickets_, now_());
  const auto found = tickets_.find(digest(ticket));
  if (found == tickets_.end()) return refuse(address, "this ticket is used or has ended");
  const Access access = found->second.access;
  tickets_.erase(found);
  return admit(access, "ticket of an overview");
}

void Logins::log_out(const std::string& token) { tokens_.erase(digest(token)); }

Access Logins::access_of(const std::string& token) {
  const auto found = tokens_.find(digest(token));
  return found == tokens_.end() || found->second.ends <= now_() ? Access::none : found->second.access;
}

std::string Logins::who(const std::string& token) {
  const auto found = tokens_.find(digest(token));
  return found == tokens_.end() || found->second.ends <= now_() ? "no login" : found->second.who;
}

Logins::Outcome Logins::access_of_key(const std::string& key, const std::string& address) {
  if (too_many_wrong(address)) return {Access::none, {}, true, "too many wrong tries"};
  if (!same_secret(key, secrets_.key)) return refuse(address, "this is not the key");
  return {Access::instructor, {}, false, {}};
}

}  // namespace insula::gateway
