// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/intake.h"
#include "tools/case_builder/wall.h"
#include <iostream>
using namespace insula::case_builder;
int main(int, char** a) { try { CaseFolder f{a[1], "x"}; Options o; if (a[3]) o.label = 1, o.smoothing = atof(a[3]); Progress p(stderr); run_intake(f, a[2], o, p); run_wall(f, o, p); } catch (const std::exception& e) { std::cerr << e.what() << "\n"; } }
