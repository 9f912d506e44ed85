// SPDX-License-Identifier: GPL-3.0-or-later
// insula new-plugin NAME --kind KIND
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <ostream>

#include "core/base/text.h"
#include "core/registry/plugin_loader.h"
#include "engine/authoring/embedded.h"
#include "engine/authoring/new_plugin.h"

namespace fs = std::filesystem;

namespace insula {
namespace {

struct KindText {
  std::string_view kind, name, doc;
};
constexpr std::array<KindText, 7> kinds{{
    {"constraint", "constraint", "a spring from a surface to a place that never moves"},
    {"force", "force model", "springs along the edges of a soft body"},
    {"body", "rigid body", "a rigid body on a spring, with a stop below"},
    {"support", "support", "holds the nodes within a ball"},
    {"instrument", "instrument", "a probe that marks places while the button is held"},
    {"exercise", "rule of exercises", "reached when a tip has stayed at a place"},
    {"metric", "metric", "how steadily a tip stays at a place"},
}};

/// "pia_patch" becomes "PiaPatch".
std::string class_name(std::string_view name) {
  std::string out;
  bool up = true;
  for (const char c : name) {
    if (c == '_') up = true;
    else {
      out += up && c >= 'a' && c <= 'z' ? char(c - 'a' + 'A') : c;
      up = false;
    }
  }
  return out;
}

/// Reason why the name is not valid; empty if it is.
std::string name_error(const Registry& registry, const std::string& name) {
  const auto small = [](char c) { return c >= 'a' && c <= 'z'; };
  const bool good =
      !name.empty() && name.size() <= 40 && small(name.front()) &&
      std::all_of(name.begin(), name.end(), [&](char c) { return small(c) || (c >= '0' && c <= '9') || c == '_'; });
  if (!good)
    return in_quotes(name) +
           " is no name of a plugin: small letters, digits and _, a letter first, at most 40 of them, such as "
           "pia_patch";
  for (const auto* info : registry.all())
    if (info->element == name || info->plugin == name)
      return fmt::format("\"{}\" is taken by {}; choose another name", name,
                         info->plugin == "core" ? "the core" : "plugin " + info->plugin);
  // Words that CMake or the base classes reserve.
  for (const std::string_view word :
       {"all", "clean", "constraint", "force_model", "help", "insula", "install", "instrument", "exercise_rule",
        "metric", "package", "part", "include", "variable", "test", "body", "support"})
    if (name == word) return in_quotes(name) + " is a word with a meaning of its own; choose another name";
  return {};
}

std::string filled(std::string_view text, const std::vector<std::pair<std::string_view, std::string>>& words) {
  std::string out(text);
  for (const auto& [word, value] : words)
    for (std::size_t at = out.find(word); at != std::string::npos; at = out.find(word, at + value.size()))
      out.replace(at, word.size(), value);
  return out;
}

/// Path of a file of the table in the new folder; empty: this kind does not need it.
fs::path place_of(std::string_view file, const KindText& kind, const std::string& name) {
  const std::size_t slash = file.find('/');
  const std::string_view part = file.substr(0, slash), rest = file.substr(slash + 1);
  if (part != "common" && part != kind.kind) return {};
  if (rest == "gitignore") return ".gitignore";
  if (rest == "block.msh") return "meshes/block.msh";
  if (rest == "probe.urdf") return "meshes/probe/probe.urdf";
  return filled(rest, {{"NAME", name}});
}

/// Hint that CMake needs to find Insula: none for an installation in /usr, else the folder of the build or prefix.
std::string where_insula_is() {
  std::error_code ec;
  const fs::path above = installed_plugin_folder().parent_path().parent_path().parent_path();
  if (fs::exists(above / "InsulaConfig.cmake", ec)) return " -DInsula_DIR=" + above.generic_string();
  if (above == "/usr" || above == "/usr/local") return {};
  return " -DCMAKE_PREFIX_PATH=" + above.generic_string();
}

}  // namespace

std::string plugin_kinds() {
  std::string out;
  for (const KindText& k : kinds) out += (out.empty() ? "" : &k == &kinds.back() ? " or " : ", ") + std::string(k.kind);
  return out;
}

int cmd_new_plugin(const CommandContext& context, const NewPluginOptions& options) {
  const auto kind = std::find_if(kinds.begin(), kinds.end(), [&](const KindText& k) { return k.kind == options.kind; });
  std::string why = name_error(context.registry, options.name);
  if (why.empty() && kind == kinds.end()) why = in_quotes(options.kind) + " is no kind: " + plugin_kinds();
  const fs::path folder = options.folder.empty() ? fs::path(options.name) : options.folder;
  std::error_code ec;
  if (why.empty() && fs::exists(folder, ec) && !(fs::is_directory(folder, ec) && fs::is_empty(folder, ec)))
    why = folder.generic_string() + " exists already and is not an empty folder";
  if (!why.empty()) {
    context.err << "error: " << why << '\n';
    return 2;
  }
  const std::vector<std::pair<std::string_view, std::string>> words{{"@name@", options.name},
                                                                    {"@Name@", class_name(options.name)},
                                                                    {"@kind@", options.kind},
                                                                    {"@doc@", std::string(kind->doc)}};
  for (const EmbeddedFile& file : new_plugin_files()) {
    const fs::path place = place_of(file.name, *kind, options.name);
    if (place.empty()) continue;
    fs::create_directories((folder / place).parent_path(), ec);
    std::ofstream out(folder / place, std::ios::binary);
    if (!(out << filled(file.text, words) << std::flush)) {
      context.err << "error: " << (folder / place).generic_string() << " cannot be written\n";
      return 1;
    }
  }
  context.out << fmt::format(
      "{0}: a{3} {1} called <{2}>, with test and example. Build and test it:\n"
      "  cmake -S {0} -B {0}/build{4} && cmake --build {0}/build && ctest --test-dir {0}/build\n",
      folder.generic_string(), kind->name, options.name, kind->kind == "instrument" ? "n" : "", where_insula_is());
  return 0;
}

}  // namespace insula
