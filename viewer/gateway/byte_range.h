// SPDX-License-Identifier: GPL-3.0-or-later
// Requests for a part of a file (RFC 9110, 14).
#pragma once
#include <cstdint>
#include <optional>
#include <string_view>

namespace insula::gateway {

struct ByteRange {
  std::uint64_t first = 0, length = 0;  ///< length 0: there are no such bytes
};

/// The part of a file of `size` bytes that a Range header asks for: "bytes=2-5", "bytes=2-" or "bytes=-4". Nothing if
/// the header is another one or asks for several parts; such a header is answered with the whole file.
std::optional<ByteRange> byte_range(std::string_view header, std::uint64_t size);

}  // namespace insula::gateway
