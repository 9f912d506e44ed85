// SPDX-License-Identifier: GPL-3.0-or-later
#include "labels.h"

#include <algorithm>
#include <charconv>
#include <stdexcept>
#include <string_view>

namespace insula::mesh_tool {
namespace {

constexpr int highest = 1000000;

// 0 when the text is no label.
int label(std::string_view text) {
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() && value >= 1 && value <= highest ? value : 0;
}

}  // namespace

std::vector<int> label_list(const std::string& text) {
  std::vector<int> out;
  for (std::size_t at = 0; at <= text.size();) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    const std::string item = text.substr(at, comma - at);
    const std::size_t dash = item.find('-');
    const int first = label(std::string_view(item).substr(0, dash)),
              last = dash == std::string::npos ? first : label(std::string_view(item).substr(dash + 1));
    if (first == 0 || last < first)
      throw std::runtime_error("\"" + item.substr(0, 40) +
                               "\" is neither a label nor a range of labels; write a list like 2,4,10-16");
    for (int k = first; k <= last; ++k) out.push_back(k);
    at = comma + 1;
  }
  return out;
}

}  // namespace insula::mesh_tool
