// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/xapi/http_record_store.h"

#include <curl/curl.h>
#include <fmt/format.h>

#include <algorithm>
#include <fstream>

#include "core/base/input_error.h"
#include "core/base/text.h"
#include "training/xapi/statements.h"

namespace insula::xapi {
namespace {

constexpr long connect_s = 10, whole_s = 60;
constexpr std::size_t longest_answer = 4 << 20;

struct FreeUrl {
  void operator()(CURLU* u) const { curl_url_cleanup(u); }
};
struct FreeList {
  void operator()(curl_slist* l) const { curl_slist_free_all(l); }
};

std::string part(CURLU* url, CURLUPart which) {
  char* text = nullptr;
  if (curl_url_get(url, which, &text, 0) != CURLUE_OK) return {};
  std::string out = text;
  curl_free(text);
  return out;
}

/// The checked address of the resource for statements.
std::string statements_address(const std::string& endpoint) {
  const auto refuse = [&](const char* why) { throw InputError(fmt::format("--lrs {}: {}", shown(endpoint), why)); };
  const std::unique_ptr<CURLU, FreeUrl> url(curl_url());
  if (curl_url_set(url.get(), CURLUPART_URL, endpoint.c_str(), 0) != CURLUE_OK) refuse("this is no address");
  if (!part(url.get(), CURLUPART_USER).empty() || !part(url.get(), CURLUPART_PASSWORD).empty())
    throw InputError(
        "--lrs: name and password do not belong into the address; give them by --login or the environment");
  if (!part(url.get(), CURLUPART_QUERY).empty() || !part(url.get(), CURLUPART_FRAGMENT).empty())
    refuse("the address has a part after \"?\" or \"#\"");
  const std::string scheme = part(url.get(), CURLUPART_SCHEME), host = part(url.get(), CURLUPART_HOST);
  const bool here = host == "localhost" || host == "127.0.0.1" || host == "[::1]";
  if (scheme != "https" && !(scheme == "http" && here)) refuse("it begins with https://, or leads to this machine");
  std::string out = part(url.get(), CURLUPART_URL);
  while (!out.empty() && out.back() == '/') out.pop_back();
  return out + "/statements";
}

std::size_t take(const char* bytes, std::size_t size, std::size_t count, void* to) {
  auto& text = *static_cast<std::string*>(to);
  if (text.size() + size * count > longest_answer) return 0;  // the transfer then fails
  text.append(bytes, size * count);
  return size * count;
}

}  // namespace

struct HttpRecordStore::Connection {
  Connection() : handle(curl_easy_init()) {
    if (!handle) throw InputError("libcurl cannot be used");
  }
  ~Connection() { curl_easy_cleanup(handle); }
  CURL* handle;
};

HttpRecordStore::HttpRecordStore(const std::string& endpoint, Login login, const std::filesystem::path& authorities)
    : statements_(statements_address(endpoint)),
      login_(std::move(login)),
      authorities_(authorities.string()),
      connection_(std::make_unique<Connection>()) {
  if (!authorities.empty() && !std::ifstream(authorities).good())
    throw InputError(authorities_ + ": the certificates cannot be read");
}
HttpRecordStore::~HttpRecordStore() = default;

Answer HttpRecordStore::post(const std::string& statements) { return ask(statements_, &statements); }
Answer HttpRecordStore::get(const std::string& id) { return ask(statements_ + "?statementId=" + id, nullptr); }

Answer HttpRecordStore::ask(const std::string& url, const std::string* body) {
  CURL* c = connection_->handle;
  curl_easy_reset(c);  // the connection itself stays open
  std::unique_ptr<curl_slist, FreeList> headers;
  for (const std::string& line : {fmt::format("X-Experience-API-Version: {}", version),
                                  std::string("Content-Type: application/json"), std::string("Expect:")}) {
    curl_slist* longer = curl_slist_append(headers.get(), line.c_str());
    if (!longer) return {0, "no memory", 0};
    headers.release();
    headers.reset(longer);
  }
  Answer answer;
  char why[CURL_ERROR_SIZE] = "";
  curl_easy_setopt(c, CURLOPT_URL, url.c_str());
  curl_easy_setopt(c, CURLOPT_PROTOCOLS_STR, "http,https");
  curl_easy_setopt(c, CURLOPT_HTTPHEADER, headers.get());
  curl_easy_setopt(c, CURLOPT_NOSIGNAL, 1L);
  curl_easy_setopt(c, CURLOPT_CONNECTTIMEOUT, connect_s);
  curl_easy_setopt(c, CURLOPT_TIMEOUT, whole_s);
  curl_easy_setopt(c, CURLOPT_ERRORBUFFER, why);
  curl_easy_setopt(c, CURLOPT_WRITEFUNCTION, take);
  curl_easy_setopt(c, CURLOPT_WRITEDATA, &answer.text);
  if (!authorities_.empty()) curl_easy_setopt(c, CURLOPT_CAINFO, authorities_.c_str());
  if (!login_.user.empty()) {
    curl_easy_setopt(c, CURLOPT_HTTPAUTH, CURLAUTH_BASIC);
    curl_easy_setopt(c, CURLOPT_USERNAME, login_.user.c_str());
    curl_easy_setopt(c, CURLOPT_PASSWORD, login_.password.c_str());
  }
  if (body) {
    curl_easy_setopt(c, CURLOPT_POSTFIELDSIZE_LARGE, curl_off_t(body->size()));
    curl_easy_setopt(c, CURLOPT_POSTFIELDS, body->c_str());
  }
  const CURLcode code = curl_easy_perform(c);
  if (code != CURLE_OK) return {0, *why ? why : curl_easy_strerror(code), 0};
  long status = 0;
  curl_off_t wait = 0;
  curl_easy_getinfo(c, CURLINFO_RESPONSE_CODE, &status);
  curl_easy_getinfo(c, CURLINFO_RETRY_AFTER, &wait);
  answer.status = int(status), answer.retry_after_s = std::max<curl_off_t>(wait, 0);
  return answer;
}

}  // namespace insula::xapi
