// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/commands.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <iostream>
#include <optional>

#include "core/base/input_error.h"
#include "core/sim/exercise.h"
#include "engine/sharing/case_archive.h"
#include "tools/case_builder/approach.h"
#include "tools/case_builder/brain.h"
#include "tools/case_builder/clip_trial.h"
#include "tools/case_builder/inspect.h"
#include "tools/case_builder/intake.h"
#include "tools/case_builder/paint.h"
#include "tools/case_builder/place.h"
#include "tools/case_builder/pose_view.h"
#include "tools/case_builder/project.h"
#include "tools/case_builder/real_time.h"
#include "tools/case_builder/region_walls.h"
#include "tools/case_builder/report.h"
#include "tools/case_builder/retractors.h"
#include "tools/case_builder/rules.h"
#include "tools/case_builder/scenes.h"
#include "tools/case_builder/unit_options.h"
#include "tools/case_builder/wall.h"
#include "tools/case_builder/wall_patches.h"

namespace insula::case_builder {
namespace {

constexpr const char* stages[] = {"intake", "wall", "brain", "place", "scenes", "report"};

/// What the command line says besides the options of the case itself.
struct Line {
  std::string stage, name, input, folder, out;
  bool on = false;
  bool inspect = false;  ///< a look at the input, no case
  bool clip = false;     ///< a clip is tried
  bool pose = false;     ///< poses of the vessel are looked at
};

// Options whose values have a unit. joined_values() joins the words of such a value.
const std::vector<std::string> with_unit = {
    "--seed", "--around", "--rebuild", "--cut",   "--neck", "--neck-points", "--inlet", "--keep",      "--bleb",
    "--gap",  "--spin",   "--lift",    "--slide", "--turn", "--pose",        "--unit",  "--brain-unit"};

/// A length or an angle; `take` gets it in the unit option.bare.
template <class Q>
void quantity(CLI::App* app, const std::string& name, std::function<void(double)> take, const QuantityOption& option) {
  const auto read = [option](const std::string& text, std::string& error) {
    return read_with_unit(text, Q::units(), Q::name, option, error);
  };
  const auto check = [read](const std::string& text) {
    std::string error;
    read(text, error);
    return error;
  };
  const auto set = [read, take](const std::string& text) {
    std::string error;
    if (const auto value = read(text, error)) take(*value);
  };
  app->add_option_function<std::string>(name, set, option.doc)->type_name("QUANTITY")->check(check);
}

/// A point, a plane or two points; `take` gets their numbers, lengths in mm.
CLI::Option* shape(CLI::App* app, const std::string& name, Shape what,
                   std::function<void(const std::vector<std::vector<double>>&)> take, const std::string& text) {
  const auto check = [what](const std::string& given) {
    std::string error;
    read_shape(given, what, error);
    return error;
  };
  const auto set = [what, take](const std::vector<std::string>& given) {
    std::vector<std::vector<double>> all;
    std::string error;
    for (const std::string& one : given)
      if (auto numbers = read_shape(one, what, error)) all.push_back(std::move(*numbers));
    take(all);
  };
  return app->add_option_function<std::vector<std::string>>(name, set, text)
      ->expected(1)
      ->type_name("\"" + std::string(pattern(what)) + "\"")
      ->check(check);
}

template <std::size_t N>
void shape_to(CLI::App* app, const std::string& name, Shape what, std::optional<std::array<double, N>>& to,
              const std::string& text) {
  const auto take = [&to](const std::vector<std::vector<double>>& all) {
    std::array<double, N> a;
    std::copy(all.back().begin(), all.back().end(), a.begin());
    to = a;
  };
  shape(app, name, what, take, text);
}

void file_unit(CLI::App* app, const std::string& name, std::optional<double>& mm, const std::string& text) {
  const auto check = [](const std::string& given) {
    std::string error;
    read_file_unit(given, error);
    return error;
  };
  const auto set = [&mm](const std::string& given) {
    std::string error;
    mm = read_file_unit(given, error);
  };
  app->add_option_function<std::string>(name, set, text)->type_name("UNIT")->check(check);
}

/// What CLI11 asks of a value: why it is refused, or nothing.
template <class Value>
std::function<std::string(const std::string&)> refusal_of(Value (*read)(const std::string&)) {
  return [read](const std::string& given) {
    try {
      read(given);
      return std::string();
    } catch (const InputError& e) {
      return std::string(e.what());
    }
  };
}

void intake_options(CLI::App* app, Options& o) {
  file_unit(app, "--unit", o.unit_mm,
            "unit of a surface file: m, cm, mm, um, inch or a length such as \"0.35 mm\" (default: mm; glTF: m)");
  app->add_flag("--mirror,!--no-mirror", o.mirror,
                "the input, vessel and brain, is of the left side: mirror it at x = 0; positions given here stay those "
                "of your files");
  app->add_flag("--any-size", o.any_size, "take sizes that no cerebral artery has");
  app->add_option("--label", o.label, "volumes: the vessel's label");
  app->add_option("--threshold", o.threshold, "volumes: grey value from which on it is vessel");
  app->add_option("--smooth", o.smoothing, "volumes: smoothing of the border, in voxels")->check(CLI::Range(0.0, 5.0));
  shape_to(app, "--seed", Shape::point, o.seed, "a point: the piece nearest to it is the vessel");
  quantity<Length>(app, "--around", [&o](double mm) { o.around = mm; },
                   {.bare = "mm",
                    .min = "5 mm",
                    .max = "200 mm",
                    .doc = "volumes: take only what lies so near to the seed along each axis"});
  app->add_option_function<std::string>(
         "--paint", [&o](const std::string& file) { o.paint = read_strokes(file); },
         "volumes: a JSON file with what was painted into the vessel or erased by hand")
      ->check(CLI::ExistingFile);
  app->add_flag("--keep-largest", o.keep_largest, "of several pieces take the largest, however large the others are");
  quantity<Length>(
      app, "--rebuild", [&o](double mm) { o.rebuild = mm; },
      {.bare = "mm", .min = "0.03 mm", .max = "2 mm", .doc = "make the surface anew from a grid of this spacing"});
  const auto take_cuts = [&o](const std::vector<std::vector<double>>& all) {
    o.cuts.clear();
    for (const std::vector<double>& v : all) o.cuts.push_back({v[0], v[1], v[2], v[3], v[4], v[5]});
  };
  shape(app, "--cut", Shape::plane, take_cuts,
        "cut the vessel across at the point, what lies in the direction goes; may be given again")
      ->take_all();
}

void wall_options(CLI::App* app, Options& o) {
  shape_to(app, "--neck", Shape::plane, o.neck, "plane of the neck: a point and the direction towards the dome");
  shape_to(app, "--neck-points", Shape::two_points, o.neck_points, "two points on opposite sides of the neck");
  shape_to(app, "--inlet", Shape::point, o.inlet,
           "a point near the opening where blood comes in (default: the widest)");
  quantity<Length>(app, "--keep", [&o](double mm) { o.keep = mm; },
                   {.bare = "mm",
                    .min = "0 mm",
                    .max = "200 mm",
                    .doc = "length of vessel kept along each centreline from the neck; 0 mm: all"});
  app->add_option_function<int>(
         "--vertices", [&o](int vertices) { o.vertices = vertices, o.keep_vertices = true, o.coarser.reset(); },
         "of the wall, about (default: 1650, or fewer where real time asks for it)")
      ->check(CLI::Range(400, 6000));
  quantity<Length>(
      app, "--bleb", [&o](double mm) { o.bleb = mm; },
      {.bare = "mm", .min = "0 mm", .max = "4 mm", .doc = "radius of the weak spot at the dome; 0 mm: none"});
  app->add_option_function<std::vector<std::string>>(
         "--wall", [&o](const std::vector<std::string>& v) { o.walls = v; },
         "thickness or stiffness of a region: REGION.PARAMETER=VALUE, such as \"neck.young=7 MPa\" or "
         "\"vessels.thickness=0.4 mm\"; may be given again")
      ->take_all()
      ->check(refusal_of<WallChange>(read_wall_change));
  app->add_option_function<std::vector<std::string>>(
         "--wall-patch",
         [&o](const std::vector<std::string>& v) {
           o.wall_patches.clear();
           for (const std::string& one : v) o.wall_patches.push_back(read_wall_patch(one));
         },
         "a part of the wall about points of it, with a thickness or a stiffness of its own: \"X Y Z mm, radius=1 mm, "
         "young=7 MPa, thickness=0.5 mm\", with as many points as you like; may be given again")
      ->take_all()
      ->check(refusal_of<WallPatch>(read_wall_patch));
  app->add_flag_callback(
      "--no-wall-patches", [&o] { o.wall_patches.clear(); }, "take back what --wall-patch has changed");
  app->add_flag_callback(
      "--walls-as-proposed", [&o] { o.walls.clear(); }, "take back what --wall has changed");
}

void brain_options(CLI::App* app, Options& o) {
  app->add_option_function<std::vector<std::string>>(
         "--brain", [&o](const std::vector<std::string>& v) { o.brain = v; },
         "your own brain in the MNI frame: a volume of labels, NAME=FILE for frontal, temporal and insula each, or one "
         "closed surface")
      ->take_all();
  app->add_option_function<std::vector<std::string>>(
         "--lobe", [&o](const std::vector<std::string>& v) { o.lobe_labels = v; },
         "NAME=LABELS of that volume, such as frontal=2,4,10-16")
      ->take_all();
  file_unit(app, "--brain-unit", o.brain_unit_mm,
            "unit of the brain's surfaces, as --unit has it (default: mm; glTF: m)");
  app->add_flag("--brain-in-place", o.brain_in_place,
                "do not move the brain so that its fissure lies where the arms and the microscope stand");
  app->add_option("--brain-nodes", o.brain_nodes, "of both lobes' tetrahedra, at most")->check(CLI::Range(200, 20000));
}

void retractor_options(CLI::App* app, Options& o) {
  app->add_option_function<std::vector<std::string>>(
         "--retractor",
         [&o](const std::vector<std::string>& v) {
           o.retractors.emplace();
           for (const std::string& one : v) o.retractors->push_back(read_retractor(one));
         },
         "a brain retractor in place of those of the approach: \"LOBE, X Y Z mm, shaft=X Y Z, flat=X Y Z, pull=5 mm\", "
         "the lobe it draws aside, its tip in the frame of the lobes, the direction to its handle, that of the side "
         "which presses, and how far it draws; what is left out is as in the approach; may be given again")
      ->take_all()
      ->check(refusal_of<RetractorChoice>(read_retractor));
  app->add_flag_callback(
      "--no-retractors", [&o] { o.retractors.emplace(); }, "no brain retractor at all");
  app->add_flag_callback(
      "--retractors-as-proposed", [&o] { o.retractors.reset(); }, "the retractors of the approach again");
}

void place_options(CLI::App* app, Options& o) {
  app->add_option("--approach", o.approach,
                  "the way to the aneurysm, a name of meshes/*/approach.json (default: sylvian)");
  shape_to(app, "--pose", Shape::motion, o.pose,
           "where the vessel is moved to, in place of the search: a rotation (its axis times its angle) about the "
           "origin of your file's frame, then a shift into the frame of the lobes");
  app->add_flag_callback(
      "--no-pose", [&o] { o.pose.reset(); }, "search for the place again");
  app->add_flag("--in-place", o.in_place, "the input lies in the frame of the lobes (MNI, mm) already");
  app->add_option("--lobes", o.lobes, "folder with lobes of your own, named as in meshes/lobes, in its frame (MNI, mm)")
      ->check(CLI::ExistingDirectory);
  quantity<Length>(app, "--gap", [&o](double mm) { o.gap = mm; },
                   {.bare = "mm", .min = "0.1 mm", .max = "2 mm", .doc = "room between wall and lobes"});
  quantity<Angle>(app, "--spin", [&o](double degrees) { o.spin = degrees, o.keep_spin = true; },
                  {.bare = "deg",
                   .min = "-360 deg",
                   .max = "360 deg",
                   .doc = "turn about the sac's axis (default: the one with the most room)"});
  retractor_options(app, o);
}

void scene_options(CLI::App* app, Options& o) {
  const Exercise declared;
  app->add_option("--site", o.site, "where the aneurysm is; the start page groups cases by it")
      ->check(CLI::IsMember(
          std::vector<std::string>(declared.site.spec().choices.begin(), declared.site.spec().choices.end())));
  app->add_option("--difficulty", o.difficulty, "from 1, for a first case, to 5, for an expert")
      ->check(CLI::Range(1, 5));
  app->add_option("--clip", o.clip, "clip for the neck, of meshes/clips (default: chosen)");
  quantity<Length>(app, "--lift", [&o](double mm) { o.lift = mm; },
                   {.bare = "mm", .min = "-10 mm", .max = "10 mm", .doc = "of the blades over the neck's plane"});
  quantity<Length>(app, "--slide", [&o](double mm) { o.slide = mm; },
                   {.bare = "mm", .min = "-15 mm", .max = "15 mm", .doc = "of the blades' middle beyond the neck's"});
  app->add_option_function<std::vector<std::string>>(
         "--rule", [&o](const std::vector<std::string>& v) { o.rules = v; },
         "a goal, fault, clock or complication of an exercise, or its strands: EXERCISE.ID.PARAMETER=VALUE, such as "
         "3.clip.max_grade=1, or EXERCISE.ID=off; may be given again (rules.json has all of them)")
      ->take_all()
      ->check(refusal_of<RuleChange>(read_rule_change));
  app->add_flag_callback(
      "--rules-as-proposed", [&o] { o.rules.clear(); }, "take back what --rule has changed");
  app->add_option("--plays", o.plays,
                  "placements of the clip that are played at most, until one succeeds (default: 16)")
      ->check(CLI::Range(1, 100));
  app->add_flag("--rehearse,!--no-rehearse", o.rehearse,
                "play the exercises until scripted hands succeed (default); else exercise 2 has none, and the clip "
                "lies where its geometry says, which is quicker");
  quantity<Angle>(app, "--turn", [&o](double degrees) { o.turn = degrees; },
                  {.bare = "deg",
                   .min = "-180 deg",
                   .max = "180 deg",
                   .doc = "of the blades about the dome's axis from the surgeon's side"});
}

/// Those that make no case and change none.
void look_commands(CLI::App& app, Line& line, Options& o) {
  auto* look = app.add_subcommand(
      "inspect", "tell what a file holds and where the neck may be, as JSON, before a case is made of it");
  look->add_option("input", line.input, "file, or folder of a DICOM series")->required();
  look->add_option("--out", line.out, "folder that gets what was found, in place of the print");
  intake_options(look, o);
  look->callback([&line] { line.inspect = true; });
  auto* clip = app.add_subcommand(
      "clip", "try a clip over the neck of a built case, and tell as JSON what it leaves; the case stays as it is");
  clip->add_option("folder", line.folder, "of the case")->required();
  clip->add_option("--out", line.out, "file that gets what was found, in place of the print");
  scene_options(clip, o);
  clip->callback([&line] { line.clip = true; });
  auto* pose = app.add_subcommand(
      "pose",
      "read poses of a built case's vessel, \"X Y Z mm RX RY RZ deg\" a line, and tell as JSON what the vessel "
      "overlaps there and how its neck is seen; after the word part, with the lobes parted; the case stays as it is");
  pose->add_option("folder", line.folder, "of the case")->required();
  pose->add_option("--out", line.out, "folder that gets the surfaces, for a picture")->required();
  pose->callback([&line] { line.pose = true; });
}

/// 0: parsed; else the exit status, help or complaint already said.
int parse(const std::vector<std::string>& arguments, Line& line, Options& o, std::FILE* out, std::FILE* err) {
  CLI::App app{"Makes training cases from patients' vessels. For training only, never for the care of patients.",
               "insula case"};
  app.require_subcommand(1);
  auto* fresh =
      app.add_subcommand("new",
                         "a case from a surface (STL, OBJ, PLY, OFF, glTF, VTP, VTU, HDF5) or a volume (NIfTI, "
                         "MetaImage, NRRD, DICOM as a folder or zip)");
  fresh->add_option("name", line.name, "of the case: letters, digits, _ and -")->required();
  fresh->add_option("input", line.input, "file, or folder of a DICOM series")->required();
  fresh->add_option("--out", line.out, "folder that gets the case's folder (default: scenes/cases of the project)");
  intake_options(fresh, o), wall_options(fresh, o), brain_options(fresh, o), place_options(fresh, o),
      scene_options(fresh, o);
  look_commands(app, line, o);
  for (const char* stage : stages) {
    auto* again = app.add_subcommand(
        stage, std::string("do the stage ") + stage + " of a case again, from what the one before wrote");
    again->add_option("folder", line.folder, "of the case")->required();
    if (stage == std::string("intake"))
      again->add_option("input", line.input, "file, or folder of a DICOM series")->required(), intake_options(again, o);
    if (stage == std::string("wall")) wall_options(again, o);
    if (stage == std::string("brain")) brain_options(again, o);
    if (stage == std::string("place")) place_options(again, o);
    if (stage == std::string("scenes")) scene_options(again, o);
    again->add_flag("--on", line.on, "and all stages after it");
    again->callback([&line, stage] { line.stage = stage; });
  }
  const std::vector<std::string> words = joined_values(arguments, with_unit);
  std::vector<std::string> reversed(words.rbegin(), words.rend());
  try {
    app.parse(reversed);
  } catch (const CLI::CallForHelp&) {
    std::fputs(
        (app.get_subcommands().empty() ? app.help("", CLI::AppFormatMode::All) : app.get_subcommands()[0]->help())
            .c_str(),
        out);
    return -1;
  } catch (const CLI::ParseError& e) {
    std::fprintf(err, "error: %s\nRun with --help for more.\n", e.what());
    return 2;
  }
  return 0;
}

void do_stage(const std::string& stage, const CaseFolder& folder, const Line& line, const fs::path& project, Options& o,
              Progress& progress) {
  if (stage == "intake") run_intake(folder, line.input, o, progress);
  if (stage == "wall") run_wall(folder, o, progress);
  if (stage == "brain") run_brain(folder, project, o, progress);
  if (stage == "place") run_place(folder, project, o, progress);
  if (stage == "scenes") {
    if (keep_real_time(folder, project, o, usual_pace(), progress)) write_options(folder, o);
    run_scenes(folder, project, o, progress);
  }
  if (stage == "report") run_report(folder, project, o, progress);
}

/// Options of a case, with those of the command line over them.
Options options_of(CaseFolder& folder, const std::vector<std::string>& arguments, std::FILE* out, std::FILE* err) {
  Options o = read_options(folder);
  Line again;
  parse(arguments, again, o, out, err);
  return o;
}

int tell_clip(const Line& line, const std::vector<std::string>& arguments, std::FILE* out, std::FILE* err,
              Progress& progress) {
  CaseFolder folder{line.folder, {}};
  const Options o = options_of(folder, arguments, out, err);
  const Json found = try_clip(folder, find_project(folder.path), o, progress);
  if (line.out.empty()) std::fprintf(out, "%s\n", found.dump(1).c_str());
  else write_json(line.out, found);
  return 0;
}

int tell_poses(const Line& line, std::FILE* out) {
  CaseFolder folder{line.folder, {}};
  const Options o = read_options(folder);
  answer_poses(PoseView(folder, find_project(folder.path), o), line.out, std::cin, out);
  return 0;
}

}  // namespace

int run_command(const std::vector<std::string>& arguments, std::FILE* out, std::FILE* err) {
  Line line;
  Options o;
  try {
    if (const int status = parse(arguments, line, o, out, err)) return status < 0 ? 0 : status;
    Progress progress(err);
    if (line.inspect) {
      run_inspect(line.input, line.out, o, out, progress);
      return 0;
    }
    if (line.clip) return tell_clip(line, arguments, out, err, progress);
    if (line.pose) return tell_poses(line, out);
    CaseFolder folder;
    if (line.stage.empty()) {
      if (!is_case_name(line.name))
        throw InputError("the name of a case has letters, digits, _ and - only, 64 at most: \"" + line.name +
                         "\" has not");
      const fs::path into = line.out.empty() ? find_project(fs::current_path()) / "scenes/cases" : fs::path(line.out);
      folder = {into / line.name, line.name};
      if (fs::exists(folder.path))
        throw InputError(folder.path.string() +
                         " exists already; remove it, or do a stage of it again: insula case wall " +
                         folder.path.string());
    } else {
      folder.path = line.folder;
      const Options before = read_options(folder);
      o = options_of(folder, arguments, out, err);
      // Another vessel may not ask for a coarser wall.
      const bool changed = to_json(o) != to_json(before);
      if (line.stage == "intake" || (line.stage == "wall" && changed)) o.coarser.reset();
    }
    const fs::path project = find_project(folder.path);
    folder.opening = read_approach(project, o.approach).opening.file;
    const auto first =
        line.stage.empty() ? std::begin(stages) : std::find(std::begin(stages), std::end(stages), line.stage);
    // A new case's folder is there from the first stage that worked.
    for (auto stage = first; stage != std::end(stages); ++stage) {
      do_stage(*stage, folder, line, project, o, progress);
      if (stage == first) write_options(folder, o);
      if (!line.stage.empty() && !line.on) break;
    }
    const fs::path last = folder.path / "report.html";
    std::fprintf(out, "%s: done; look at %s\n", folder.path.string().c_str(),
                 fs::exists(last) ? last.string().c_str() : folder.path.string().c_str());
    if (line.stage.empty())
      std::fprintf(out, "next: insula check %s && insula play %s\n", (folder.path / "3_clipping.xml").string().c_str(),
                   (folder.path / "3_clipping.xml").string().c_str());
    return 0;
  } catch (const InputError& e) {
    std::fprintf(err, "\nerror: %s\n", e.what());
    return 2;
  } catch (const std::exception& e) {
    std::fprintf(err, "\nerror: %s\n", e.what());
    return 1;
  }
}

}  // namespace insula::case_builder
