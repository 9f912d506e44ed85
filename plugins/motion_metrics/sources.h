// SPDX-License-Identifier: GPL-3.0-or-later
// Publications that define the metrics of this plugin.
#pragma once

namespace insula::sources {

inline constexpr const char* cotin = "Cotin et al., MICCAI 2002";
inline constexpr const char* balasubramanian = "Balasubramanian et al., J. NeuroEng. Rehabil. 12:112, 2015";
inline constexpr const char* hofstad = "Hofstad et al., Surg. Endosc. 27, 2013";
inline constexpr const char* neurotouch = "Alotaibi et al., Neurosurgery 11 Suppl. 2, 2015";
inline constexpr const char* harwell = "Harwell and Ferguson, Microsurgery 4, 1983";
inline constexpr const char* winkler = "Winkler-Schwartz et al., JAMA Netw. Open 2(8), 2019";
inline constexpr const char* insula = "Insula";

}  // namespace insula::sources
