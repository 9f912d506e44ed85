// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/scene_text.h"

#include <fmt/format.h>

#include "core/base/text.h"

namespace insula::case_builder {
namespace {

std::string point(const Vec3& p) {
  return fmt::format("{:.1f} {:.1f} {:.1f} mm", p.x() + 0.0, p.y() + 0.0, p.z() + 0.0);
}

std::string joined(const std::vector<std::string>& all) {
  std::string out;
  for (const std::string& s : all) out += (out.empty() ? "" : " ") + s;
  return out;
}

constexpr const char* head = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
constexpr const char* training_only = "For training only, never for the care of patients.";

/// The fissure held open, with the case's own lobes.
std::string fissure(const SceneFacts& f, const std::string& part) {
  return fmt::format("  <include file=\"{}/{}\">\n    <variable name=\"lobes\" value=\"{}\"/>\n  </include>\n",
                     f.assets.parts, part, f.assets.lobes);
}

constexpr const char* own_retractors = "retractors.xml";

/// The same, as the exercises about the aneurysm have it.
std::string held_fissure(const SceneFacts& f) {
  if (f.retractors) return fmt::format("  <include file=\"{}\"/>\n", own_retractors);
  return fissure(f, f.approach.open_part);
}

std::string numbers(const Vec3& v, int decimals) {
  return fmt::format("{:.{}f} {:.{}f} {:.{}f}", v.x() + 0.0, decimals, v.y() + 0.0, decimals, v.z() + 0.0, decimals);
}

std::string tool(const SceneFacts& f, const char* element, const char* id, const char* hand, const char* model,
                 const std::string& rest) {
  return fmt::format("  <{} id=\"{}\" hand=\"{}\" model=\"{}/instruments/{}/{}.urdf\"\n    {}/>\n", element, id, hand,
                     f.assets.meshes, model, model, rest);
}

constexpr const char* soft = " coupling=\"250 N/m\"";

std::string view(const SceneFacts& f, const ApproachView& v) {
  return fmt::format("  <view eye=\"{}\" target=\"{}\" up=\"{}\" field_of_view=\"{}\"/>", v.eye,
                     v.target.empty() ? point(f.neck + v.from_neck) : v.target, v.up, v.field_of_view);
}

/// The tissue about the vessel.
std::string tissue(const Approach& a) { return a.lobes[0] + " " + a.lobes[1] + " " + a.floor; }
/// What tools may meet besides the vessel.
std::string met(const Approach& a) { return tissue(a) + " " + joined(a.obstacles); }

std::string bed(const Approach& a) {
  return "  <contact id=\"bed\" between=\"artery " + tissue(a) +
         "\" friction=\"0\" tissue_alarm=\"0.3 mm\" tissue_spacing=\"1.5 mm\" tissue_max_contacts=\"12\" "
         "tissue_max_force=\"0.05 N\"/>\n";
}

/// What the structures bear, as in the exercises of the project. `vessel`: with the artery.
std::string limits(const SceneFacts& f, bool vessel) {
  std::string s;
  if (vessel) s += fmt::format("    <include file=\"{}/vessel_limits.xml\"/>\n", f.assets.parts);
  return s + fmt::format("    <include file=\"{}/{}\"/>\n", f.assets.parts, f.approach.limits_part);
}

/// The weak spot: the bleb, or the sac as a whole, whose wall is thicker.
std::string weak_spot(const SceneFacts& f, const ApproachField& field) {
  std::string s = fmt::format(
      "  <include file=\"{}/bleb.xml\">\n    <variable name=\"blood_bottom\" value=\"{}\"/>\n"
      "    <variable name=\"blood_up\" value=\"{}\"/>\n    <variable name=\"blood_radius\" value=\"{}\"/>\n"
      "    <variable name=\"blood_depth\" value=\"{}\"/>\n",
      f.assets.parts, point(f.neck - 5 * f.approach.to_surgeon), field.blood_up, field.blood_radius, field.blood_depth);
  if (!f.bleb)
    s += "    <variable name=\"bleb_region\" value=\"sac\"/>\n    <variable name=\"bleb_force\" value=\"1.5 N\"/>\n"
         "    <variable name=\"bleb_sharp_force\" value=\"0.15 N\"/>\n";
  return s + "  </include>\n";
}

/// Metrics of the hands, and of what the exercise is about.
std::string metrics(const SceneFacts& f, bool strands, bool vessel) {
  const auto include = [&](const char* part) {
    return fmt::format("    <include file=\"{}/{}.xml\"/>\n", f.assets.parts, part);
  };
  std::string s = include("metrics");
  if (strands) s += include("strand_metrics");
  if (!vessel) return s;
  if (f.bleb) return s + include("bleeding_metrics");
  return s + fmt::format(
                 "    <include file=\"{}/bleeding_metrics.xml\">\n      <variable name=\"dome_regions\" "
                 "value=\"sac\"/>\n    </include>\n",
                 f.assets.parts);
}

/// What the clip left, and how each branch flowed.
std::string clip_metrics(const SceneFacts& f) {
  std::string s =
      "    <event_metric id=\"clips_released\" text=\"Clips let go in the field\" event=\"clip_released\" "
      "better=\"low\"/>\n"
      "    <channel_metric id=\"neck_remnant\" text=\"Remnant of the neck at the end\" channel=\"clip.remnant\" "
      "better=\"low\"/>\n";
  for (const std::string_view branch : split_blanks(f.branches))
    s += fmt::format(
        "    <channel_metric id=\"{0}_flow_least\" text=\"Least flow of {0} over that at rest\" "
        "channel=\"clip.{0}.flow\" statistic=\"smallest\" better=\"high\"/>\n",
        branch);
  return s;
}

std::string judged(const SceneFacts& f, const char* hold) {
  return fmt::format(
      "    <goal_clipped id=\"clip\" text=\"Close the neck and keep the branches open\" on=\"artery\" branches=\"{0}\" "
      "max_grade=\"2\" min_flow=\"0.75\" sealed=\"0.2\" hold=\"{1}\"/>\n"
      "    <fault_stenosis id=\"stenosis\" text=\"The clip narrows a vessel: take it back\" on=\"artery\" "
      "branches=\"{0}\" limit=\"0.5\" grace=\"3 s\"/>\n",
      f.branches, hold);
}

/// Painted parts of the wall.
std::string painted_parts(const SceneFacts& f) {
  std::string s;
  for (std::size_t i = 0; i < f.patches.size(); ++i) {
    const PatchOf& p = f.patches[i];
    std::string spots;
    for (const Vec3& x : p.spots)
      spots +=
          fmt::format("{}{:.2f} {:.2f} {:.2f} mm", spots.empty() ? "" : "; ", x.x() + 0.0, x.y() + 0.0, x.z() + 0.0);
    s += fmt::format(
        "    <membrane id=\"wall_patch_{}\" spots=\"{}\" spot_radius=\"{:g} mm\" thickness=\"{:g} mm\" "
        "young=\"{:g} MPa\" added_mass=\"1 kg/m2\"/>\n",
        i + 1, spots, p.radius_mm, p.thickness_mm, p.young_mpa);
  }
  return s;
}

}  // namespace

std::string artery_part(const SceneFacts& f) {
  std::string s = head;
  s += fmt::format(
      "<!-- The vessel of the case {}: wall, blood, pulse. Thickness and modulus of each region are proposals. {} "
      "-->\n<part>\n",
      f.name, training_only);
  s += "  <shell_body id=\"artery\" tangent_tolerance=\"0.1\" wall=\"artery/vessel.json\">\n";
  for (std::size_t i = 0; i < f.walls.size(); ++i)
    s += fmt::format(
        "    <membrane id=\"wall_{}\" regions=\"{}\" thickness=\"{:g} mm\" young=\"{:g} MPa\" added_mass=\"1 "
        "kg/m2\"/>\n",
        i + 1, f.walls[i].regions, f.walls[i].thickness_mm, f.walls[i].young_mpa);
  s += painted_parts(f);
  s += fmt::format("    <anchor_springs id=\"tethers\" regions=\"{}\" stiffness=\"1 kPa/mm\"/>\n", f.tethered);
  s += "    <surface id=\"artery_wall\" material=\"vessel\" thickness=\"0.3 mm\"/>\n"
       "    <surface id=\"artery_picture\" mesh=\"artery/picture.ply\" mesh_unit=\"mm\" material=\"vessel\" "
       "contact=\"false\"/>\n"
       "  </shell_body>\n"
       "  <pressure id=\"heart\" on=\"artery\" systolic=\"120 mmHg\" diastolic=\"80 mmHg\" heart_rate=\"70 1/min\"/>\n"
       "  <blood_flow id=\"flow\" pressure=\"heart\" thickness=\"0.3 mm\" closed_below=\"0.2\"/>\n"
       "  <self_contact id=\"lumen\" on=\"artery_wall\" thickness=\"0.22 mm\" contact_stiffness=\"3 kN/m\" "
       "friction=\"0\" max_contacts=\"40\" spacing=\"0.8 mm\" alarm=\"0.3 mm\"/>\n"
       "</part>\n";
  return s;
}

/// As scenes/parts/retracted_fissure.xml has them.
std::string retractors_part(const SceneFacts& f) {
  const Approach& a = f.approach;
  std::string s = head, arms;
  s += fmt::format("<!-- The fissure held open by retractors where the author wants them. {} -->\n<part>\n",
                   training_only);
  s += fmt::format("  <include file=\"{}/{}\">\n    <variable name=\"lobes\" value=\"{}\"/>\n  </include>\n",
                   f.assets.parts, a.closed_part, f.assets.lobes);
  for (std::size_t k = 0; k < f.retractors->size(); ++k) {
    const RetractorAt& r = (*f.retractors)[k];
    const std::string id = fmt::format("arm_{}", k + 1);
    arms += " " + id;
    s +=
        tool(f, "retractor", id.c_str(), "none", "retractor",
             fmt::format("home=\"{} mm\" shaft=\"{}\" flat=\"{}\" coupling=\"2000 N/m\" angular_coupling=\"2 N m/rad\" "
                         "approach=\"{} mm\"",
                         numbers(r.tip, 3), numbers(r.shaft, 4), numbers(r.flat, 4), numbers(-r.pull * r.flat, 3)));
  }
  s += "  <contact id=\"lobes\" between=\"" + a.lobes[0] + " " + a.lobes[1] + " " + joined(a.obstacles) +
       "\" friction=\"0\" tissue_alarm=\"0.8 mm\" tissue_spacing=\"2 mm\" tissue_max_contacts=\"40\" "
       "tissue_max_force=\"0.05 N\"/>\n";
  for (std::size_t k = 0; k < f.retractors->size(); ++k)
    s += fmt::format(
        "  <contact id=\"held_{0}\" between=\"{1} arm_{0}\" friction=\"0.1\" contact_geometry=\"vertices\" "
        "spacing=\"1 mm\" max_contacts=\"60\" patch=\"6 mm\" max_correction=\"0.2 mm\" alarm=\"0.5 mm\" "
        "contact_stiffness=\"1000 N/m\"/>\n",
        k + 1, (*f.retractors)[k].lobe);
  if (!arms.empty()) s += "  <contact id=\"arms\" between=\"" + a.floor + arms + "\"/>\n";
  return s + "</part>\n";
}

std::string field_part(const SceneFacts& f) {
  const Approach& a = f.approach;
  const std::string clips = joined(f.clips);
  std::string s = head;
  s += fmt::format("<!-- What the exercises with clips share. {} -->\n<part>\n", training_only);
  s += held_fissure(f);
  s += "  <include file=\"artery.xml\"/>\n";
  for (const std::string& c : f.clips)
    s += fmt::format("  <clip id=\"{}\" model=\"{}/clips/{}/{}.urdf\"/>\n", c, f.assets.meshes, c, c);
  s += view(f, a.clipping.view) + "\n";
  s += "  <settle time=\"3 s\"/>\n  <solver max_sweeps=\"100\" tolerance=\"1e-7 m\" conjugate=\"true\" "
       "newton=\"8\"/>\n\n";
  s += tool(f, "suction", "suction", "left", "suction", a.clipping.left + soft);
  s += tool(f, "dissector", "probe", "left", "dissector", "sharp=\"never\" " + a.clipping.left + soft);
  s += tool(f, "clip_applier", "applier", "right", "clip_applier",
            a.clipping.right + fmt::format(" coupling=\"500 N/m\" clips=\"{}\"", clips));
  s += tool(f, "dissector", "stylus", "right", "dissector", a.clipping.right + soft);
  s += tool(f, "micro_doppler", "doppler", "right", "micro_doppler", a.clipping.right + soft);
  s += "\n" + weak_spot(f, a.clipping) + bed(a);
  s += "  <contact id=\"tools\" between=\"artery " + met(a) +
       " suction probe applier stylus "
       "doppler\" friction=\"0.1\" spacing=\"1 mm\" max_contacts=\"10\" max_correction=\"0.2 mm\"/>\n";
  s += fmt::format(
      "  <contact id=\"blades\" between=\"artery {}\" friction=\"0.35\" contact_geometry=\"vertices\" patch=\"2.5 mm\" "
      "max_contacts=\"60\" alarm=\"0.12 mm\" max_correction=\"0.1 mm\"/>\n",
      clips);
  s += fmt::format(
      "  <contact id=\"clips_in_the_field\" between=\"{} {}\" friction=\"0.2\" max_force=\"2 N\" spacing=\"2 mm\" "
      "max_contacts=\"6\" alarm=\"0.5 mm\" max_correction=\"0.2 mm\"/>\n",
      a.floor, clips);
  s += fmt::format(
      "  <contact id=\"clips_on_the_lobes\" between=\"{} {}\" friction=\"0\" max_force=\"0.1 N\" "
      "spacing=\"2 mm\" max_contacts=\"6\" alarm=\"0.5 mm\" max_correction=\"0.2 mm\"/>\n</part>\n",
      a.lobes[0] + " " + a.lobes[1], clips);
  return s;
}

namespace {
/// The membrane between the strands of an element.
std::string membrane(const std::string& id, const std::string& strands) {
  return fmt::format("  <arachnoid_membrane id=\"{}\" strands=\"{}\" stiffness=\"8 N/m\" strength=\"0.012 N\"/>\n", id,
                     strands);
}
}  // namespace

std::vector<std::string> all_strand_sets(const Approach& a) { return {a.lobes[0], a.lobes[1], "branches"}; }

std::string strands(const SceneFacts& f, const std::string& kind) {
  const Vec3 &to_surgeon = f.approach.to_surgeon, shift = f.strand_shift * to_surgeon,
             ball = 0.4 * f.neck + 0.6 * f.dome + 1.5 * to_surgeon + shift;
  const double radius = 0.55 * f.dome_reach + 2;
  const bool own = kind == "branches";
  const std::string fibres = fmt::format(
      "  <strand_springs id=\"to_{}\" from=\"artery_wall\" to=\"{}\" created_at=\"settled\" centre=\"{}\" "
      "radius=\"{:.1f} mm\" density=\"{:.3g} 1/cm2\" max_length=\"{} mm\" seed=\"{}\"\n"
      "    stiffness=\"40 N/m\" slack=\"1.1\" strength=\"0.04 N\" cut_force=\"0.015 N\" cut_length=\"0.8 mm\" "
      "reach=\"0.6 mm\"/>\n",
      kind, own ? std::string("artery_wall") : kind + "_surface",
      point(own ? Vec3(f.neck + 2 * to_surgeon + shift) : ball), own ? radius - 1 : radius,
      f.strand_share * (own ? 40 : 24), own ? "3" : "7",
      kind == f.approach.lobes[0]   ? 11
      : kind == f.approach.lobes[1] ? 12
                                    : 14);
  return fibres + membrane("membrane_to_" + kind, "to_" + kind);
}

namespace {

std::string opened(const SceneFacts& f, const std::string& comment, const std::string& title) {
  return fmt::format("{}<!-- {} {} -->\n<scene title=\"{}: {}\" time_step=\"16.6667 ms\">\n", head, comment,
                     training_only, f.name, title);
}

/// What the start page sorts cases by.
std::string case_facts(const SceneFacts& f) {
  std::string s;
  if (!f.site.empty()) s += fmt::format(" site=\"{}\"", f.site);
  if (f.difficulty > 0) s += fmt::format(" difficulty=\"{}\"", f.difficulty);
  return s;
}

std::string opening_exercise(const SceneFacts& f) {
  const Approach& a = f.approach;
  const ApproachOpening& o = a.opening;
  const std::string lobes = a.lobes[0] + " " + a.lobes[1];
  std::string s = opened(f, "Exercise 1: " + o.comment + ".", o.scene);
  s += fissure(f, a.closed_part);
  s += view(f, o.view) +
       "\n  <solver "
       "max_sweeps=\"80\" tolerance=\"1e-7 m\"/>\n\n";
  s += fmt::format(
      "  <!-- The vessel lies below: seen through the opened lips, not touched yet. -->\n  <obstacle "
      "id=\"artery\">\n    <surface id=\"artery_wall\" mesh=\"artery/picture.ply\" mesh_unit=\"mm\" "
      "material=\"vessel\" contact=\"false\"/>\n  </obstacle>\n");
  s += tool(f, "suction", "left_suction", "left", "suction", o.left + soft);
  s += tool(f, "dissector", "right_dissector", "right", "dissector", o.right + soft);
  s += fmt::format(
      "  <strand_springs id=\"arachnoid\" from=\"{}_surface\" to=\"{}_surface\" density=\"42 1/cm2\" "
      "max_length=\"4.5 mm\" centre=\"{}\" radius=\"{}\" seed=\"7\"\n",
      a.lobes[0], a.lobes[1], o.strands_centre, o.strands_radius);
  s += "    stiffness=\"6 N/m\" slack=\"1.1\" strength=\"0.02 N\" cut_force=\"0.015 N\" cut_length=\"0.8 mm\" "
       "reach=\"0.6 mm\"/>\n";
  s += membrane("membrane", "arachnoid");
  s += "  <contact id=\"lobes\" between=\"" + lobes +
       "\" friction=\"0\" tissue_alarm=\"0.8 mm\" "
       "tissue_spacing=\"2 mm\" tissue_max_contacts=\"40\"/>\n"
       "  <contact id=\"at_floor_and_bone\" between=\"" +
       met(a) +
       "\" friction=\"0\" "
       "tissue_spacing=\"2 mm\" tissue_max_contacts=\"40\" tissue_max_force=\"0.05 N\"/>\n"
       "  <contact id=\"tools\" between=\"" +
       met(a) +
       " left_suction right_dissector\" "
       "friction=\"0.1\" "
       "spacing=\"1 mm\" max_contacts=\"10\"/>\n\n"
       "  <exercise" +
       case_facts(f) + fmt::format(" id=\"{}\" title=\"{}\" text=\"{}\">\n", o.id, o.title, o.text) +
       "    <goal_opening id=\"open\" text=\"Part the lips of the fissure by 5 mm and hold them\" "
       "a=\"" +
       a.lobes[0] + "_surface\" b=\"" + a.lobes[1] + "_surface\" at=\"" + o.opens_at +
       "\" distance=\"5 mm\" hold=\"2 s\"/>\n"
       "    <goal_strands id=\"divide\" text=\"Divide all arachnoid strands\" fraction=\"1\"/>\n"
       "    <goal_two_hands id=\"together\" text=\"Divide strands while the suction tube holds a lip aside\" "
       "event=\"strand_cut\" count=\"10\" on=\"" +
       lobes +
       "\" force=\"0.02 N\" "
       "remaining=\"arachnoid.standing\"/>\n" +
       limits(f, false) + metrics(f, true, false) +
       "    <fault_torn id=\"torn\" text=\"A strand tore: cut it before you draw the lobe further\"/>\n"
       "    <fault_order id=\"order\" text=\"Too deep too early: divide the strands at the surface first\" "
       "inward=\"" +
       o.inward +
       "\" margin=\"5 mm\" allowed=\"6\"/>\n"
       "    <time_limit id=\"time\" text=\"Ten minutes are over\" limit=\"600 s\"/>\n";
  if (f.opened) s += "    <motion id=\"steady\" file=\"" + o.file + "_steady.csv\"/>\n";
  s += "  </exercise>\n</scene>\n";
  return s;
}

std::string dissection_exercise(const SceneFacts& f) {
  const Approach& a = f.approach;
  std::string s = opened(f, "Exercise 2: free the aneurysm of its strands.", "dissection of the aneurysm");
  s += held_fissure(f);
  s += "  <include file=\"artery.xml\"/>\n";
  s +=
      view(f, a.dissection.view) + "\n  <settle time=\"3 s\"/>\n  <solver max_sweeps=\"80\" tolerance=\"1e-7 m\"/>\n\n";
  s += tool(f, "suction", "left_suction", "left", "suction", a.dissection.left + soft);
  s += tool(f, "dissector", "right_stylus", "right", "dissector", a.dissection.right + soft);
  s += bed(a) + "  <contact id=\"tools\" between=\"artery " + met(a) +
       " left_suction right_stylus\" "
       "friction=\"0.1\" spacing=\"1 mm\" max_contacts=\"10\"/>\n";
  s += weak_spot(f, a.dissection);
  for (const std::string& kind : f.strand_sets) s += strands(f, kind);
  s += "\n  <exercise" + case_facts(f) +
       " id=\"aneurysm_dissection\" title=\"Dissection of the aneurysm\" text=\"Divide all strands with "
       "the dissector's edge: turn the blade across each and sweep it slowly, the outermost first. Keep off the "
       "dome, and pull on nothing.\">\n"
       "    <goal_strands id=\"divide\" text=\"Divide all strands around the aneurysm\" fraction=\"1\"/>\n" +
       limits(f, true) + metrics(f, true, true) +
       "    <fault_torn id=\"torn\" text=\"A strand tore: divide it with the edge instead\"/>\n"
       "    <fault_rupture id=\"rupture\" text=\"The aneurysm has ruptured\" fails=\"true\"/>\n"
       "    <time_limit id=\"time\" text=\"Fifteen minutes are over\" limit=\"900 s\"/>\n";
  if (f.rehearsed) s += "    <motion id=\"steady\" file=\"2_aneurysm_dissection_steady.csv\"/>\n";
  s += "  </exercise>\n</scene>\n";
  return s;
}

std::string clipping_exercise(const SceneFacts& f) {
  const std::string clipping_text = fmt::format(
      "Load the applier with {} or another clip. Hold button 1 to open the blades, bring them over the dome, across "
      "its neck, tips just past it, and let them close; button 2 lets the clip go, and takes it back if it lies badly.",
      f.clips.front());
  std::string s = opened(f, "Exercise 3: clip the aneurysm.", "clipping");
  s += "  <include file=\"field.xml\"/>\n\n";
  s += fmt::format("  <exercise{} id=\"clipping\" title=\"Clipping\" text=\"{}\">\n", case_facts(f), clipping_text);
  s += judged(f, "3 s");
  s += "    <fault_rupture id=\"rupture\" text=\"The dome has ruptured\"/>\n" + limits(f, true) +
       metrics(f, false, true) + clip_metrics(f) +
       "    <time_limit id=\"time\" text=\"Fifteen minutes are over\" limit=\"900 s\"/>\n"
       "    <motion id=\"steady\" file=\"3_clipping_steady.csv\"/>\n  </exercise>\n</scene>\n";
  return s;
}

std::string rupture_exercise(const SceneFacts& f) {
  std::string s = opened(f, "Exercise 4: the dome ruptures.", "rupture");
  s += "  <include file=\"field.xml\"/>\n\n  <complications id=\"chance\">\n    <complication "
       "id=\"rupture_by_itself\" command=\"bleeding rupture\" probability=\"1\" from=\"8 s\" to=\"40 s\"/>\n"
       "    <complication id=\"pressure_rises\" command=\"heart set_systolic 150\" probability=\"0.3\" from=\"20 s\" "
       "to=\"120 s\"/>\n  </complications>\n\n"
       "  <exercise" +
       case_facts(f) +
       " id=\"rupture\" title=\"Rupture\" text=\"The dome bleeds. Hold the field dry with the suction "
       "tube, put a temporary clip across the parent artery, then close the neck with a permanent clip, and take the "
       "temporary clip off within three minutes.\">\n"
       "    <goal_bleeding_stopped id=\"stop\" text=\"Stop the bleeding\" rate=\"4 ml/min\" hold=\"2 s\"/>\n"
       "    <goal_two_hands id=\"together\" text=\"Suck the blood away while the other hand closes a clip\" "
       "event=\"clip_shut\" channel=\"bleeding.sucked\" limit=\"10 ml/min\"/>\n";
  s += judged(f, "2 s");
  s += "    <goal_temporary_removed id=\"removed\" text=\"Take the temporary clip off\" rate=\"4 ml/min\"/>\n"
       "    <timer_rupture id=\"since_rupture\" text=\"Since the rupture\" limit=\"300 s\" rate=\"4 ml/min\"/>\n"
       "    <timer_temporary_clip id=\"occlusion\" text=\"Temporary clip\" limit=\"180 s\"/>\n" +
       limits(f, true) + metrics(f, false, true) + clip_metrics(f) +
       "    <motion id=\"steady\" file=\"4_rupture_steady.csv\"/>\n  </exercise>\n</scene>\n";
  return s;
}

}  // namespace

std::string exercise(const SceneFacts& f, int number) {
  return with_rules(proposed_exercise(f, number), number, f.rules, f.folder);
}

std::string proposed_exercise(const SceneFacts& f, int number) {
  switch (number) {
    case 1: return opening_exercise(f);
    case 2: return dissection_exercise(f);
    case 3: return clipping_exercise(f);
    default: return rupture_exercise(f);
  }
}

}  // namespace insula::case_builder
