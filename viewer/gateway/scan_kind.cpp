// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/scan_kind.h"

#include <zlib.h>

#include <array>

#include "core/base/text.h"
#include "core/model/formats/dicom_mark.h"

namespace insula::gateway {
namespace {

constexpr std::size_t nifti_head = 352;

/// NIfTI-1, data format: the header's size in either byte order, and the magic text at its end.
SurfaceKind nifti_kind(std::string_view bytes, const char* extension) {
  if (bytes.size() < nifti_head) return {};
  const std::string_view size = bytes.substr(0, 4), magic = bytes.substr(344, 4);
  if (size != std::string_view("\x5c\x01\0\0", 4) && size != std::string_view("\0\0\x01\x5c", 4)) return {};
  if (magic == std::string_view("ni1\0", 4)) return {"", "this scan needs another file: write it as one .nii file"};
  return magic == std::string_view("n+1\0", 4) ? SurfaceKind{extension, ""} : SurfaceKind{};
}

SurfaceKind gzip_kind(std::string_view bytes) {
  std::array<char, nifti_head> head{};
  z_stream z{};
  z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  z.avail_in = uInt(bytes.size());
  z.next_out = reinterpret_cast<Bytef*>(head.data());
  z.avail_out = uInt(head.size());
  if (inflateInit2(&z, 16 + MAX_WBITS) == Z_OK) {
    inflate(&z, Z_SYNC_FLUSH);
    inflateEnd(&z);
  }
  const SurfaceKind kind = nifti_kind({head.data(), head.size()}, ".nii.gz");
  if (kind.extension.empty() && kind.refused.empty()) return {"", "this compressed file is no scan: NIfTI is taken"};
  return kind;
}

/// The value of a line "key = value" or "key: value" of a text that ends at an empty line or a zero byte.
std::string_view value_of(std::string_view text, std::string_view key, char sign) {
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    const std::string_view line = text.substr(0, end);
    text.remove_prefix(std::min(end + 1, text.size()));
    const std::size_t at = line.find(sign);
    if (at != std::string_view::npos && trim(line.substr(0, at)) == key) return trim(line.substr(at + 1));
    if (line.find('\0') != std::string_view::npos) break;
  }
  return {};
}

SurfaceKind nrrd_kind(std::string_view head) {
  const bool other = !value_of(head, "data file", ':').empty() || !value_of(head, "datafile", ':').empty();
  return other ? SurfaceKind{"", "this scan needs another file: write it as one .nrrd file"} : SurfaceKind{".nrrd", ""};
}

SurfaceKind meta_kind(std::string_view head) {
  const bool image = value_of(head, "ObjectType", '=') == "Image" || !value_of(head, "DimSize", '=').empty();
  if (!image) return {};
  const std::string_view data = value_of(head, "ElementDataFile", '=');
  if (data != "LOCAL" && data != "Local" && data != "local")
    return {"", "this scan needs another file: write it as one .mha file"};
  return {".mha", ""};
}

}  // namespace

SurfaceKind scan_kind(std::string_view head) {
  if (head.starts_with("\x1f\x8b")) return gzip_kind(head);
  if (head.starts_with("PK\x03\x04")) return {".zip", ""};
  if (head.starts_with("NRRD000")) return nrrd_kind(head);
  if (is_dicom_file(head)) return {".dcm", ""};
  if (const SurfaceKind kind = nifti_kind(head, ".nii"); !kind.extension.empty() || !kind.refused.empty()) return kind;
  return meta_kind(head);
}

}  // namespace insula::gateway
