// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/session/parquet.h"

#include <poll.h>

#include <cstdlib>
#include <string>

#include "core/base/child_process.h"
#include "core/base/input_error.h"

namespace insula {
namespace {

namespace fs = std::filesystem;

constexpr const char* program = R"(
import sys
try:
    from pyarrow import csv, parquet
except ImportError as error:
    sys.exit(f"{error}: Parquet needs pyarrow (pip install pyarrow); csv and json do without")
for name in sys.argv[1:]:
    table = csv.read_csv(name, parse_options=csv.ParseOptions(newlines_in_values=True))
    parquet.write_table(table, name.removesuffix(".csv") + ".parquet", compression="zstd")
)";

/// What a program says until it has ended. Throws InputError with the last of it if it fails.
void run(const std::vector<std::string>& command) {
  ChildProcess child;
  if (const std::string why = child.start(command); !why.empty()) throw InputError(why);
  std::string last;
  const auto keep = [&](std::string_view line) { last = line; };
  for (;;) {
    pollfd waiting{child.output(), POLLIN, 0};
    ::poll(&waiting, 1, 50);
    child.read_lines(keep);
    const std::optional<ChildExit> ended = child.reap();
    if (!ended) continue;
    child.finish_output(keep);
    if (ended->status == 127) throw InputError(command[1] + " cannot be run; Parquet needs Python with pyarrow");
    if (ended->status != 0) throw InputError(last.empty() ? command[1] + " " + ended->text() : last);
    return;
  }
}

}  // namespace

std::vector<fs::path> to_parquet(const std::vector<fs::path>& tables) {
  const char* python = std::getenv("INSULA_PYTHON");
  // env looks for it in the folders of PATH.
  std::vector<std::string> command{"/usr/bin/env", python && *python ? python : "python3", "-c", program};
  for (const fs::path& table : tables) command.push_back(table.string());
  run(command);
  std::vector<fs::path> out;
  for (const fs::path& table : tables) {
    out.push_back(fs::path(table).replace_extension(".parquet"));
    std::error_code ignored;
    fs::remove(table, ignored);
  }
  return out;
}

}  // namespace insula
