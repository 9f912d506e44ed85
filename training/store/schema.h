// SPDX-License-Identifier: GPL-3.0-or-later
// The tables of the training store, and how an older file becomes a present one.
#pragma once
#include <filesystem>

#include "training/store/database.h"

namespace insula::training {

/// Number of the present schema, which SQLite keeps as user_version.
int schema_version();

/// Brings the file to the present schema, in one transaction. Before an existing file is changed, a copy of it is kept
/// beside it (NAME.before_N). Throws InputError if a newer program has written it.
void migrate(const Database& database);

}  // namespace insula::training
