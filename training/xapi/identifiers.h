// SPDX-License-Identifier: GPL-3.0-or-later
// Names that are the same whenever they are made: UUIDs of version 5 and IRIs. A statement that is sent again has the
// same id, so that no learning record store keeps it twice.
#pragma once
#include <string>
#include <string_view>

namespace insula::xapi {

/// Start of all IRIs that Insula defines: activities of its own scenes, and extensions. The top-level domain "invalid"
/// belongs to nobody (RFC 6761), so the names can never become somebody else's.
inline constexpr std::string_view vocabulary = "https://insula.invalid/xapi";

/// Whether the text is a UUID in its usual form: 8-4-4-4-12 hexadecimal digits.
bool is_uuid(std::string_view text);
/// The UUID of version 5 of a name in a namespace (RFC 9562, SHA-1). Throws InputError if `space` is no UUID.
std::string uuid_v5(std::string_view space, std::string_view name);
/// Whether the text begins with a scheme and has none of the characters that no IRI has (RFC 3987).
bool is_iri(std::string_view text);
/// A part of a path, with everything but letters, digits and "-._~" percent-encoded (RFC 3986).
std::string encoded(std::string_view part);

}  // namespace insula::xapi
