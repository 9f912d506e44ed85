// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/tls.h"

#include <fmt/format.h>
#include <ifaddrs.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/x509v3.h>
#include <sys/stat.h>
#include <unistd.h>

#include <netinet/in.h>
#include <array>
#include <boost/asio/ip/address.hpp>
#include <boost/asio/ip/host_name.hpp>
#include <boost/asio/ssl/host_name_verification.hpp>
#include <cstdio>
#include <set>

#include "core/base/input_error.h"
#include "viewer/gateway/access.h"

namespace insula::gateway {
namespace fs = std::filesystem;
namespace asio = boost::asio;
namespace {

constexpr long day_s = 24 * 60 * 60, lasts_s = 730 * day_s, renewed_before_s = 30 * day_s;

template <class T, void (*release)(T*)>
struct Release {
  void operator()(T* p) const { release(p); }
};
using Certificate = std::unique_ptr<X509, Release<X509, X509_free>>;
using Key = std::unique_ptr<EVP_PKEY, Release<EVP_PKEY, EVP_PKEY_free>>;
struct CloseFile {
  void operator()(std::FILE* f) const { std::fclose(f); }
};
using File = std::unique_ptr<std::FILE, CloseFile>;

bool is_address(const std::string& name) {
  boost::system::error_code error;
  asio::ip::make_address(name, error);
  return !error;
}

/// Addresses of this machine's interfaces, without link-local ones, which have a scope.
void add_addresses(std::set<std::string>& names) {
  ifaddrs* list = nullptr;
  if (getifaddrs(&list) != 0) return;
  for (const ifaddrs* i = list; i != nullptr; i = i->ifa_next) {
    if (i->ifa_addr == nullptr) continue;
    if (i->ifa_addr->sa_family == AF_INET) {
      const auto& in = *reinterpret_cast<const sockaddr_in*>(i->ifa_addr);
      names.insert(asio::ip::address_v4(ntohl(in.sin_addr.s_addr)).to_string());
    } else if (i->ifa_addr->sa_family == AF_INET6) {
      asio::ip::address_v6::bytes_type bytes;
      std::copy_n(reinterpret_cast<const sockaddr_in6*>(i->ifa_addr)->sin6_addr.s6_addr, bytes.size(), bytes.begin());
      const asio::ip::address_v6 address(bytes);
      if (!address.is_link_local()) names.insert(address.to_string());
    }
  }
  freeifaddrs(list);
}

std::string subject_names(const std::vector<std::string>& given) {
  std::set<std::string> names{"localhost", "127.0.0.1", "::1"};
  boost::system::error_code error;
  const std::string machine = host_name(asio::ip::host_name(error));
  if (!error && !machine.empty()) names.insert({machine, machine + ".local"});
  add_addresses(names);
  for (const std::string& name : given) names.insert(host_name(name.find("::") == name.npos ? name : "[" + name + "]"));
  names.erase("");
  std::string out;
  for (const std::string& name : names)
    out += fmt::format("{}{}:{}", out.empty() ? "" : ",", is_address(name) ? "IP" : "DNS", name);
  return out;
}

Certificate read_certificate(const fs::path& file) {
  const File in(std::fopen(file.c_str(), "rb"));
  return Certificate(in ? PEM_read_X509(in.get(), nullptr, nullptr, nullptr) : nullptr);
}

/// SHA-256; empty: there is none.
std::string digits_of(const X509* certificate) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned size = 0;
  if (certificate == nullptr || X509_digest(certificate, EVP_sha256(), digest.data(), &size) != 1) return {};
  std::string out;
  for (unsigned i = 0; i < size; ++i) out += fmt::format("{}{:02X}", i == 0 ? "" : ":", digest[i]);
  return out;
}

bool is_good_for(X509* certificate, const std::vector<std::string>& names) {
  std::time_t soon = std::time(nullptr) + renewed_before_s;
  if (X509_cmp_time(X509_get0_notAfter(certificate), &soon) <= 0) return false;
  for (const std::string& name : names) {
    const int fits = is_address(name) ? X509_check_ip_asc(certificate, name.c_str(), 0)
                                      : X509_check_host(certificate, name.c_str(), 0, 0, nullptr);
    if (fits != 1) return false;
  }
  return true;
}

bool add_extension(X509* certificate, int what, const std::string& value) {
  X509_EXTENSION* extension = X509V3_EXT_conf_nid(nullptr, nullptr, what, value.c_str());
  const bool added = extension != nullptr && X509_add_ext(certificate, extension, -1) == 1;
  X509_EXTENSION_free(extension);
  return added;
}

Certificate make(EVP_PKEY* key, const std::vector<std::string>& names) {
  Certificate out(X509_new());
  X509* c = out.get();
  X509_set_version(c, 2);
  ASN1_INTEGER_set_int64(X509_get_serialNumber(c), std::time(nullptr));
  X509_gmtime_adj(X509_getm_notBefore(c), -day_s);  // clocks of the room may differ
  X509_gmtime_adj(X509_getm_notAfter(c), lasts_s);
  X509_set_pubkey(c, key);
  X509_NAME* name = X509_get_subject_name(c);
  X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_ASC, reinterpret_cast<const unsigned char*>("Insula"), -1, -1, 0);
  X509_set_issuer_name(c, name);
  const bool made = add_extension(c, NID_subject_alt_name, subject_names(names)) &&
                    add_extension(c, NID_basic_constraints, "critical,CA:FALSE") &&
                    add_extension(c, NID_ext_key_usage, "serverAuth") && X509_sign(c, key, EVP_sha256()) > 0;
  return made ? std::move(out) : nullptr;
}

/// Readable by its owner alone from its beginning.
File create_private(const fs::path& file) {
  fs::remove(file);
  const mode_t before = ::umask(0077);
  File out(std::fopen(file.c_str(), "wbx"));
  ::umask(before);
  return out;
}

void write(const CertificateFiles& files, X509* certificate, EVP_PKEY* key) {
  const File key_file = create_private(files.key), certificate_file = create_private(files.certificate);
  if (!key_file || !certificate_file ||
      PEM_write_PrivateKey(key_file.get(), key, nullptr, nullptr, 0, nullptr, nullptr) != 1 ||
      PEM_write_X509(certificate_file.get(), certificate) != 1)
    throw InputError(fmt::format("no certificate can be written to {}", files.certificate.parent_path().string()));
}

}  // namespace

CertificateFiles self_made_certificate(const fs::path& folder, const std::vector<std::string>& names) {
  const CertificateFiles files{folder / "tls_certificate.pem", folder / "tls_key.pem"};
  const Certificate old = read_certificate(files.certificate);
  std::error_code error;
  if (old && fs::exists(files.key, error) && is_good_for(old.get(), names)) return files;
  fs::create_directories(folder, error);
  const Key key(EVP_EC_gen("P-256"));
  const Certificate fresh = key ? make(key.get(), names) : nullptr;
  if (!fresh) throw InputError("OpenSSL makes no certificate for these names");
  write(files, fresh.get(), key.get());
  return files;
}

std::unique_ptr<asio::ssl::context> server_context(const CertificateFiles& files) {
  using asio::ssl::context;
  auto out = std::make_unique<context>(context::tls_server);
  boost::system::error_code error;
  const auto check = [&](const char* what, const fs::path& file) {
    if (error) throw InputError(fmt::format("{}: this is no {} of TLS: {}", file.string(), what, error.message()));
  };
  out->set_options(context::default_workarounds | context::no_tlsv1 | context::no_tlsv1_1, error);
  out->use_certificate_chain_file(files.certificate.string(), error);
  check("certificate", files.certificate);
  out->use_private_key_file(files.key.string(), context::pem, error);
  check("key for that certificate", files.key);
  return out;
}

std::unique_ptr<asio::ssl::context> client_context(const std::string& fingerprint, const std::string& host) {
  using asio::ssl::context;
  auto out = std::make_unique<context>(context::tls_client);
  out->set_options(context::default_workarounds | context::no_tlsv1 | context::no_tlsv1_1);
  out->set_verify_mode(asio::ssl::verify_peer);
  if (fingerprint.empty()) {
    out->set_default_verify_paths();
    out->set_verify_callback(asio::ssl::host_name_verification(host));
    return out;
  }
  // The listed certificate stands for itself, whoever signed it.
  out->set_verify_callback([fingerprint](bool, asio::ssl::verify_context& at) {
    const bool of_host = X509_STORE_CTX_get_error_depth(at.native_handle()) == 0;
    return !of_host || digits_of(X509_STORE_CTX_get_current_cert(at.native_handle())) == fingerprint;
  });
  return out;
}

std::string fingerprint(const fs::path& file) {
  const std::string out = digits_of(read_certificate(file).get());
  if (out.empty()) throw InputError(fmt::format("{}: this is no certificate of TLS", file.string()));
  return out;
}

}  // namespace insula::gateway
