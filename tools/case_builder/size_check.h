// SPDX-License-Identifier: GPL-3.0-or-later
// Whether sizes are those of a cerebral artery or of a brain, and which unit would make them so.
#pragma once
#include <optional>
#include <string>

namespace insula::case_builder {

inline constexpr double min_extent = 4, max_extent = 200;    ///< mm, of a vessel's whole surface
inline constexpr double min_calibre = 0.6, max_calibre = 8;  ///< mm, of the widest opening
inline constexpr double min_brain = 15, max_brain = 250;     ///< mm, of a lobe's or a brain's surface

/// Empty when a surface so large (mm) may be one; else what is wrong and which unit to give. `mm_per_unit` is the one
/// in use.
std::string check_extent(double extent_mm, double mm_per_unit);
/// The same for the calibre of the widest opening.
std::string check_calibre(double calibre_mm, double mm_per_unit);
/// The same for a surface of a brain.
std::string check_brain(double extent_mm, double mm_per_unit);
/// The power of ten that brings a vessel of a wrong size to a usual one. Nothing when its size is right, or when no
/// power of ten makes it so.
std::optional<double> scale_of_extent(double extent_mm);
std::optional<double> scale_of_calibre(double calibre_mm);

}  // namespace insula::case_builder
