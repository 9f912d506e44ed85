// SPDX-License-Identifier: GPL-3.0-or-later
// Lists of labels as command lines have them.
#pragma once

#include <string>
#include <vector>

namespace insula::mesh_tool {

// "2,4,10-16" to labels, in the order given, from 1 to a million. Throws std::runtime_error, which names the item that
// is neither a label nor a range of labels: digits and one dash are all that it may hold.
std::vector<int> label_list(const std::string& text);

}  // namespace insula::mesh_tool
