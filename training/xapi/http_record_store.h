// SPDX-License-Identifier: GPL-3.0-or-later
// A learning record store over HTTP. Certificates are verified, and no redirection is followed.
#pragma once
#include <filesystem>
#include <memory>
#include <string>

#include "training/xapi/login.h"
#include "training/xapi/record_store.h"

namespace insula::xapi {

class HttpRecordStore : public RecordStore {
 public:
  /// endpoint: address of the store, to which "/statements" is added. Throws InputError if it is no address, if it
  /// contains a name or a password, or if it is not encrypted and leads to another machine. authorities: file of the
  /// certificates (PEM) that are trusted; empty: those of this machine. Throws InputError if it cannot be read.
  HttpRecordStore(const std::string& endpoint, Login login, const std::filesystem::path& authorities = {});
  ~HttpRecordStore() override;

  Answer post(const std::string& statements) override;
  Answer get(const std::string& id) override;

 private:
  struct Connection;
  Answer ask(const std::string& url, const std::string* body);

  std::string statements_;  // address
  Login login_;
  std::string authorities_;  // file
  std::unique_ptr<Connection> connection_;
};

}  // namespace insula::xapi
