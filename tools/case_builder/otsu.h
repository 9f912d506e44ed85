// SPDX-License-Identifier: GPL-3.0-or-later
// A grey value that parts the bright from the dark.
#pragma once
#include <cstdint>
#include <span>

namespace insula::case_builder {

/// Otsu's threshold of the values in `counts`, bins of equal width; the index of the first bin of the brighter class,
/// 1 to counts.size() - 1. Two bins at least.
std::size_t otsu_bin(std::span<const std::uint64_t> counts);

}  // namespace insula::case_builder
