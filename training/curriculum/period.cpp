// SPDX-License-Identifier: GPL-3.0-or-later
#include "training/curriculum/period.h"

#include <array>

namespace insula {
namespace {
constexpr std::array<Unit, 4> periods{{{"day", 86400}, {"week", 604800}, {"h", 3600}, {"min", 60}}};
}  // namespace

std::span<const Unit> Period::units() { return periods; }

}  // namespace insula
