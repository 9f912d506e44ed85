// SPDX-License-Identifier: GPL-3.0-or-later
// Plain values one after the other, in the order of this machine's bytes.
#pragma once
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

#include "core/base/input_error.h"

namespace insula::python {

template <class T>
void put(std::string& to, const T& value) {
  static_assert(std::is_trivially_copyable_v<T>);
  to.append(reinterpret_cast<const char*>(&value), sizeof value);
}
inline void put_text(std::string& to, std::string_view text) {
  put(to, std::uint32_t(text.size()));
  to.append(text);
}

/// Throws InputError where the bytes end too early.
class ByteReader {
 public:
  explicit ByteReader(std::string_view bytes) : left_(bytes) {}
  bool at_end() const { return left_.empty(); }
  template <class T>
  T take() {
    T value;
    std::memcpy(&value, bytes(sizeof value).data(), sizeof value);
    return value;
  }
  std::string text() { return std::string(bytes(take<std::uint32_t>())); }
  std::string_view rest() const { return left_; }

 private:
  std::string_view bytes(std::size_t n) {
    if (n > left_.size()) throw InputError("the state is cut off");
    const std::string_view out = left_.substr(0, n);
    left_.remove_prefix(n);
    return out;
  }
  std::string_view left_;
};

}  // namespace insula::python
