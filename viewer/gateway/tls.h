// SPDX-License-Identifier: GPL-3.0-or-later
// Certificates of TLS: given ones, and one that this machine makes for itself.
#pragma once
#include <boost/asio/ssl/context.hpp>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace insula::gateway {

struct CertificateFiles {
  std::filesystem::path certificate;  ///< PEM, with the chain; empty: no TLS
  std::filesystem::path key;          ///< PEM
};

/// The certificate that is kept in a folder (tls_certificate.pem, tls_key.pem). It is made anew if it is missing, ends
/// within 30 days, or lacks one of the names. It is good for two years, for the loopback names, the machine's name, its
/// addresses and the given names. Throws InputError if it cannot be made.
CertificateFiles self_made_certificate(const std::filesystem::path& folder, const std::vector<std::string>& names);

/// For TLS 1.2 and newer. Throws InputError if the files do not fit.
std::unique_ptr<boost::asio::ssl::context> server_context(const CertificateFiles& files);

/// For requests to a host. fingerprint: of its certificate; empty: one that the system trusts for that host.
std::unique_ptr<boost::asio::ssl::context> client_context(const std::string& fingerprint, const std::string& host);

/// SHA-256 of a certificate: "AB:CD:...". Throws InputError.
std::string fingerprint(const std::filesystem::path& certificate);

}  // namespace insula::gateway
