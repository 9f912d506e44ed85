// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/intake.h"
#include "tools/case_builder/place.h"
#include "tools/case_builder/project.h"
#include "tools/case_builder/scenes.h"
#include "tools/case_builder/wall.h"
#include <iostream>
using namespace insula::case_builder;
int main(int n, char** a) { try { CaseFolder f{a[1], "x"}; Options o; Progress p(stderr); if (std::string(a[2]) != "-") { if (std::string(a[2]).find("label") != std::string::npos) o.label = 1; run_intake(f, a[2], o, p); run_wall(f, o, p); run_place(f, find_project("."), o, p);}
 if (n > 3) { o.clip = a[3]; }
 if (n > 4) { o.lift = atof(a[4]); }
 if (n > 5) { o.slide = atof(a[5]); }
 if (n > 6) { o.turn = atof(a[6]); }
 run_scenes(f, find_project("."), o, p); } catch (const std::exception& e) { std::cerr << e.what() << "\n"; } }
