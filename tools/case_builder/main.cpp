// SPDX-License-Identifier: GPL-3.0-or-later
// insula_case: from a vessel's surface or a scan to a training case.
#include "tools/case_builder/commands.h"

int main(int argc, char** argv) { return insula::case_builder::run_command({argv + 1, argv + argc}, stdout, stderr); }
