// SPDX-License-Identifier: GPL-3.0-or-later
// Tables as Parquet files, by the Apache Arrow library of Python (pyarrow), which reads and writes them where it is
// installed. Debian 12 has no Arrow for C++.
#pragma once
#include <filesystem>
#include <vector>

namespace insula {

/// Turns each NAME.csv into NAME.parquet beside it and removes it. The types of columns are those that Arrow infers.
/// Runs `python3`, or the program that INSULA_PYTHON names. Returns the new files. Throws InputError if that Python has
/// no pyarrow, or a file cannot be written; the tables then remain as they were.
std::vector<std::filesystem::path> to_parquet(const std::vector<std::filesystem::path>& tables);

}  // namespace insula
