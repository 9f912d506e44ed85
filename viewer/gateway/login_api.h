// SPDX-License-Identifier: GPL-3.0-or-later
// Requests by which pages of other machines log in, and the credentials that requests bring.
#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "viewer/gateway/audit.h"
#include "viewer/gateway/logins.h"
#include "viewer/gateway/rate_limit.h"

namespace insula::gateway {

/// What a request brings to prove who it is.
struct Credentials {
  std::string token;  ///< of the cookie
  std::string key;    ///< of "Authorization: Bearer"
};

class LoginApi {
 public:
  LoginApi(Logins& logins, Audit& audit) : logins_(logins), audit_(audit) {}

  /// port: the gateway's. Browsers keep one set of cookies for all ports of a machine, so each has a name of its own.
  void set_place(std::uint16_t port, bool encrypted);
  Credentials credentials(std::string_view cookie, std::string_view authorization) const;
  /// Of a request from another machine. Without a PIN and a key, everybody may observe.
  Access access_of(const Credentials& credentials, const std::string& address);

  /// For the record.
  std::string who(const Credentials& credentials);

  struct Answer {
    int status = 200;
    std::string json;
    std::string set_cookie;  ///< empty: none
  };
  /// {"access": none, observer, instructor or here; "needed": whether other machines must log in}
  std::string state(Access access) const;
  /// body: {"pin", "name": may be missing} or {"ticket"}. 200 with a cookie, 400, 401, or 429 after too many wrong
  /// tries.
  Answer log_in(const std::string& body, const std::string& address);
  Answer log_out(const Credentials& credentials);

 private:
  Logins& logins_;
  Audit& audit_;
  RateLimit refused_lines_{1, 20};  ///< in the record
  std::string cookie_ = "insula";
  bool encrypted_ = false;
};

}  // namespace insula::gateway
