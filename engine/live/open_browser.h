// SPDX-License-Identifier: GPL-3.0-or-later
// A browser for a page of this machine.
#pragma once
#include <string>

namespace insula {

/// Opens the user's browser if there is a display. It goes on after this process.
void open_browser(const std::string& url);

}  // namespace insula
