// SPDX-License-Identifier: GPL-3.0-or-later
// Maps a URL to a file that may be served.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace insula::gateway {

/// The parts of a request target's path, percent-decoded, without query and fragment. Returns nothing for a path that
/// does not start with "/", or that has bad escapes, control characters, backslashes, or "." or ".." parts in any
/// encoding. A trailing slash gives an empty last part.
std::optional<std::vector<std::string>> split_target(std::string_view target);

/// A text without its escapes ("%20"). Nothing if one is wrong.
std::optional<std::string> percent_decoded(std::string_view text);

/// A text as a value in a query.
std::string percent_encoded(std::string_view text);

/// The regular file root/parts..., which must lie within root after symbolic links are resolved.
std::optional<std::filesystem::path> file_below(const std::filesystem::path& root,
                                                const std::vector<std::string>& parts);

/// Content type by file extension.
std::string_view mime_type(const std::filesystem::path& file);

/// Whether an Accept-Encoding header admits gzip: it names gzip, and not with the weight 0.
bool accepts_gzip(std::string_view header);

/// The page's folder: INSULA_PAGE, or else beside the executable in a build or installation tree, or else in the source
/// folder of the build. Empty if none has an index.html.
std::filesystem::path find_page();

}  // namespace insula::gateway
