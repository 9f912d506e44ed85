// SPDX-License-Identifier: GPL-3.0-or-later
// URL paths and the files behind them.
#include "viewer/gateway/static_files.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

namespace fs = std::filesystem;

namespace insula::gateway {
namespace {

int hex(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  if (c >= 'a' && c <= 'f') return c - 'a' + 10;
  if (c >= 'A' && c <= 'F') return c - 'A' + 10;
  return -1;
}

}  // namespace

std::optional<std::string> percent_decoded(std::string_view s) {
  std::string out;
  for (std::size_t i = 0; i < s.size(); ++i) {
    char c = s[i];
    if (c == '%') {
      if (i + 2 >= s.size() || hex(s[i + 1]) < 0 || hex(s[i + 2]) < 0) return std::nullopt;
      c = char(hex(s[i + 1]) * 16 + hex(s[i + 2]));
      i += 2;
    }
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) return std::nullopt;
    out += c;
  }
  return out;
}

std::optional<std::vector<std::string>> split_target(std::string_view target) {
  target = target.substr(0, target.find_first_of("?#"));
  if (!target.starts_with('/') || target.size() > 2048) return std::nullopt;
  std::vector<std::string> parts;
  for (std::size_t at = 1; at <= target.size();) {
    const std::size_t end = std::min(target.find('/', at), target.size());
    auto part = percent_decoded(target.substr(at, end - at));
    if (!part || *part == "." || *part == "..") return std::nullopt;
    // An escaped separator is never meant well.
    if (part->find_first_of("/\\") != std::string::npos) return std::nullopt;
    if (part->empty() && end != target.size()) return std::nullopt;
    parts.push_back(std::move(*part));
    at = end + 1;
  }
  if (target == "/") parts.assign(1, "");
  return parts;
}

std::string percent_encoded(std::string_view text) {
  static constexpr char digits[] = "0123456789ABCDEF";
  std::string out;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    const bool plain = (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
                       std::string_view("-._~").find(c) != std::string_view::npos;
    if (plain) out += c;
    else out += {'%', digits[byte >> 4], digits[byte & 15]};
  }
  return out;
}

std::optional<fs::path> file_below(const fs::path& root, const std::vector<std::string>& parts) {
  std::error_code error;
  const fs::path base = fs::canonical(root, error);
  if (error) return std::nullopt;
  fs::path path = base;
  for (const std::string& part : parts) path /= part;
  path = fs::canonical(path, error);
  if (error || !fs::is_regular_file(path, error)) return std::nullopt;
  const auto [rest, unused] = std::mismatch(base.begin(), base.end(), path.begin(), path.end());
  if (rest != base.end()) return std::nullopt;
  return path;
}

std::string_view mime_type(const fs::path& file) {
  static constexpr std::array<std::pair<std::string_view, std::string_view>, 17> types{{
      {".html", "text/html; charset=utf-8"},
      {".js", "text/javascript; charset=utf-8"},
      {".mjs", "text/javascript; charset=utf-8"},
      {".css", "text/css; charset=utf-8"},
      {".json", "application/json"},
      {".map", "application/json"},
      {".webmanifest", "application/manifest+json"},
      {".svg", "image/svg+xml"},
      {".png", "image/png"},
      {".jpg", "image/jpeg"},
      {".webp", "image/webp"},
      {".ico", "image/x-icon"},
      {".woff2", "font/woff2"},
      {".wasm", "application/wasm"},
      {".hdr", "application/octet-stream"},
      {".txt", "text/plain; charset=utf-8"},
      {".md", "text/plain; charset=utf-8"},
  }};
  const std::string extension = file.extension().string();
  for (const auto& [e, type] : types)
    if (e == extension) return type;
  return "application/octet-stream";
}

bool accepts_gzip(std::string_view header) {
  while (!header.empty()) {
    const std::size_t end = header.find(',');
    std::string part;
    for (const char c : header.substr(0, end))
      if (c != ' ' && c != '\t') part += c;
    if (part == "gzip") return true;
    if (part.starts_with("gzip;q=")) return std::atof(part.c_str() + 7) > 0;
    if (end == std::string_view::npos) return false;
    header.remove_prefix(end + 1);
  }
  return false;
}

fs::path find_page() {
  std::vector<fs::path> candidates;
  if (const char* named = std::getenv("INSULA_PAGE"); named != nullptr && *named != '\0')
    candidates.emplace_back(named);
  std::error_code error;
  const fs::path bin = fs::read_symlink("/proc/self/exe", error).parent_path();
  if (!error) {
    candidates.push_back(bin / "../share/insula/page");
    candidates.push_back(bin / "../../../viewer/page/dist");
  }
#ifdef INSULA_PAGE_DIR
  candidates.emplace_back(INSULA_PAGE_DIR);
#endif
  for (const fs::path& c : candidates)
    if (fs::is_regular_file(c / "index.html", error)) return fs::canonical(c, error);
  return {};
}

}  // namespace insula::gateway
