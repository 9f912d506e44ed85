// SPDX-License-Identifier: GPL-3.0-or-later
// insula session export: a session as tables, or as a log of lcm-logger.
#include <fmt/ostream.h>

#include "core/base/input_error.h"
#include "engine/command_line/sessions.h"
#include "engine/session/parquet.h"
#include "engine/session/session_export.h"

namespace insula {

namespace fs = std::filesystem;

int cmd_session_export(const CommandContext& context, const ExportOptions& options) {
  try {
    SessionReader session(options.file);
    if (options.format == "lcm") {
      std::error_code ignored;
      fs::create_directories(options.folder, ignored);
      const fs::path file = options.folder / (options.file.stem().string() + ".lcmlog");
      fmt::print(context.out, "{}: {} messages\n", file.string(), export_lcm_log(session, file));
    } else {
      const bool parquet = options.format == "parquet";
      std::vector<fs::path> files = export_tables(session, options.folder, parquet ? "csv" : options.format);
      if (parquet) files = to_parquet(files);
      for (const fs::path& file : files) fmt::print(context.out, "{}\n", file.string());
    }
    for (const std::string& line : session.container().damage())
      fmt::print(context.err, "warning: {}: {}\n", options.file.string(), line);
    return 0;
  } catch (const InputError& e) {
    fmt::print(context.err, "error: {}\n", e.what());
    return 2;
  }
}

}  // namespace insula
