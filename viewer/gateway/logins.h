// SPDX-License-Identifier: GPL-3.0-or-later
// Logins of pages on other machines: PINs are exchanged for random tokens, which say what their holder may do.
#pragma once
#include <chrono>
#include <deque>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <utility>

#include "viewer/gateway/access.h"
#include "viewer/gateway/secrets.h"

namespace insula::gateway {

class Logins {
 public:
  using Clock = std::chrono::steady_clock;
  explicit Logins(Secrets secrets, std::function<Clock::time_point()> now = Clock::now);

  static constexpr auto lasts = std::chrono::hours(12);           ///< of a token
  static constexpr auto ticket_lasts = std::chrono::seconds(30);  ///< of a ticket
  static constexpr std::size_t most_tokens = 256;                 ///< then the oldest one ends
  static constexpr int wrong_a_minute = 5;                        ///< from one address; 20 from all together
  static constexpr int wrong_a_minute_of_all = 20;
  static constexpr int wrong_ever = 1000;  ///< then nobody logs in any more, so that PINs cannot be guessed for days

  /// Whether pages of other machines must log in. Without a PIN and a key they may only observe.
  bool needed() const { return !secrets_.pin.empty() || !secrets_.key.empty(); }

  /// From now on. Who is logged in stays so.
  void set_secrets(Secrets secrets) { secrets_ = std::move(secrets); }

  struct Outcome {
    Access access = Access::none;  ///< none: refused
    std::string token;
    bool too_many = false;  ///< wrong tries; this one was not looked at
    std::string why;        ///< it was refused
    std::string who = {};   ///< for the record: the given name and the number of the login
  };
  /// address: of the asking machine. A wrong PIN is counted for it. name: as the person calls himself; nobody checks
  /// it; empty, malformed or a PIN: none.
  Outcome log_in(const std::string& pin, const std::string& address, const std::string& name = {});
  /// Exchanges a ticket, once.
  Outcome redeem(const std::string& ticket, const std::string& address);
  /// Admits whoever shows it first, as an instructor.
  std::string ticket();
  void log_out(const std::string& token);

  /// Of the holder of a token; none if it is unknown or has ended.
  Access access_of(const std::string& token);
  /// Its holder; "no login" if it is unknown or has ended.
  std::string who(const std::string& token);
  /// Of a program that shows the key. A wrong one is counted as a wrong PIN is.
  Outcome access_of_key(const std::string& key, const std::string& address);

 private:
  struct Token {
    Access access;
    Clock::time_point ends;
    std::string who = {};
  };
  bool too_many_wrong(const std::string& address);
  Outcome refuse(const std::string& address, std::string why);
  Outcome admit(Access access, const std::string& name);

  Secrets secrets_;
  std::function<Clock::time_point()> now_;
  // By SHA-256, so that the time of a search tells nothing of a token.
  std::map<std::string, Token> tokens_, tickets_;
  std::map<std::string, std::deque<Clock::time_point>> wrong_;  ///< of the last minute, by address
  std::deque<Clock::time_point> wrong_of_all_;
  int wrong_until_now_ = 0, logins_ = 0;
};

}  // namespace insula::gateway
