// SPDX-License-Identifier: GPL-3.0-or-later
// From a URL to a file that may be served, or nothing.
#pragma once
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace insula::gateway {

/// The parts of a request target's path, percent-decoded, without query and fragment. Nothing for anything odd: not
/// starting with "/", bad escapes, control characters, backslashes, "." or ".." parts (however written). A trailing
/// slash gives an empty last part.
std::optional<std::vector<std::string>> split_target(std::string_view target);

/// The regular file root/parts..., which must lie within root after symbolic links are resolved.
std::optional<std::filesystem::path> file_below(const std::filesystem::path& root,
                                                const std::vector<std::string>& parts);

/// Content type by file extension.
std::string_view mime_type(const std::filesystem::path& file);

/// The page's folder: INSULA_PAGE, else beside the executable in a build or installation tree, else where the sources
/// were when this was built. Empty when there is none with an index.html.
std::filesystem::path find_page();

}  // namespace insula::gateway
