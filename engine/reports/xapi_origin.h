// SPDX-License-Identifier: GPL-3.0-or-later
// What statements about the runs of a store say beside the run.
#pragma once
#include "training/store/outbox.h"
#include "training/xapi/statements.h"

namespace insula {

/// The store's home page, and the descriptions of the project's exercises.
xapi::Origin xapi_origin(const training::Outbox& outbox);

}  // namespace insula
