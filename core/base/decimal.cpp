// SPDX-License-Identifier: GPL-3.0-or-later
// The standard library's function, or else that of fast_float.
#include "core/base/decimal.h"

#if !defined(__cpp_lib_to_chars)
#include "core/base/decimal_by_fast_float.h"
#endif

namespace insula {

std::from_chars_result read_decimal(const char* first, const char* last, double& value) {
#if defined(__cpp_lib_to_chars)
  return std::from_chars(first, last, value);
#else
  return read_decimal_by_fast_float(first, last, value);
#endif
}

}  // namespace insula
