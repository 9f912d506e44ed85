// SPDX-License-Identifier: GPL-3.0-or-later
// The learning record store that a command tells what persons do.
#pragma once
#include <filesystem>
#include <string>

namespace insula {

struct RecordStoreOptions {
  std::string lrs;                    ///< its address; empty: nothing is sent
  std::filesystem::path login;        ///< file with NAME:PASSWORD; empty: of the environment
  std::filesystem::path authorities;  ///< certificates (PEM) that are trusted; empty: those of this machine
};

}  // namespace insula
