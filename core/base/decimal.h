// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers in texts, independent of the locale.
#pragma once
#include <charconv>

namespace insula {

/// std::from_chars of a double, also where the standard library lacks it (libc++ before version 20). The bits and the
/// codes are the same: a number that no normal or subnormal double is near to is out of range.
std::from_chars_result read_decimal(const char* first, const char* last, double& value);

}  // namespace insula
