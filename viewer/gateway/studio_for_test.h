// SPDX-License-Identifier: GPL-3.0-or-later
// The case builder's page in tests: a script stands for the case builder.
#pragma once
#include <gtest/gtest.h>

#include <fstream>
#include <optional>
#include <thread>

#include "core/base/removed_at_end.h"
#include "core/testing/temp_folder.h"
#include "viewer/gateway/studio.h"

namespace insula::gateway {

namespace fs = std::filesystem;
using nlohmann::json;

inline constexpr const char* off_file = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";

/// Writes what the stages write, says how far it is, and does what the file "behaviour" beside it says.
inline constexpr const char* builder = R"(#!/bin/sh
here=$(dirname "$0")
behaviour=$(cat "$here/behaviour" 2>/dev/null)
echo "$@" >> "$here/asked"
what=$1
case=$2
all="$*"
while [ "$1" != --out ]; do shift; done
echo "wall     40 %  checks"
[ "$what$behaviour" = newhang ] && exec sleep 100
[ "$what$behaviour" = newcrash ] && kill -SEGV $$
[ "$what$behaviour" = newrefuse ] && echo "error: no sac was found" && exit 2
[ "$what$behaviour" = inspectcrash ] && kill -SEGV $$
[ "$what$behaviour" = inspectrefuse ] && echo "error: holds 2 DICOM series" && exit 2
[ "$what$behaviour" = poserefuse ] && echo "error: is no case" && exit 2
[ "$what" = pose ] && echo '{"surfaces": ["vessel"]}' && mkdir -p "$2" && echo ply > "$2/vessel.ply" &&
  while read -r line; do echo "{\"told\": \"$line\"}"; done && exit 0
[ "$what" = clip ] && echo '{"grade": 1}' > "$2" && exit 0
mkdir -p "$2"
case "$all" in */upload/scan*)
  echo '{"threshold": 7}' > "$2/scan.json" && echo voxels > "$2/scan.raw" && echo scan > "$2/scan.mha" && exit 0;;
esac
[ "$what" = inspect ] && echo '{"openings": [], "neck": {"proposals": []}}' > "$2/inspect.json" && exit 0
mkdir -p "$2/$case" && echo '{"problems": []}' > "$2/$case/report.json" && touch "$2/$case/3_clipping.xml"
)";

class StudioTest : public ::testing::Test {
 protected:
  StudioTest() {
    const fs::path program = folder_.write("bin/insula_case", builder);
    fs::permissions(program, fs::perms::owner_all);
    restart();
  }
  /// As after a crash of the gateway: nothing is said to the studio before.
  void restart() { studio_.emplace(StudioPlaces{folder_.path() / "data", folder_.path() / "bin"}); }
  void behave(const std::string& how) { folder_.write("bin/behaviour", how); }

  ApiAnswer sent(const std::string& file, const std::string& bytes) {
    const fs::path content = studio_->incoming();
    std::ofstream(content, std::ios::binary) << bytes;
    const RemovedAtEnd goes(content);
    return studio_->upload("file=" + file, content);
  }
  json upload(const std::string& file = "vessel.off", const std::string& bytes = off_file) {
    return json::parse(sent(file, bytes).json);
  }
  /// As a page that shows the present choices, unless `more` has another revision.
  ApiAnswer ask(const std::string& act, const std::string& name, json more = json::object()) {
    more["name"] = name;
    if (!more.contains("revision")) more["revision"] = revision(name);
    return studio_->post(act, more.dump());
  }
  std::int64_t revision(const std::string& name) const {
    const auto p = StudioProjects(folder_.path() / "data/studio").read(name);
    return p ? p->revision : 0;
  }
  json project(const std::string& name) { return json::parse(studio_->get("project", "name=" + name).json); }
  /// The project, once `what` is no longer at work.
  json wait(const std::string& name, const char* what) {
    for (int k = 0; k < 500; ++k) {
      studio_->look();
      const json now = project(name);
      if (now[what]["state"] != "running") return now;
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    ADD_FAILURE() << what << " does not end";
    return project(name);
  }
  /// A project whose file has been read.
  std::string ready(const std::string& file = "vessel.off") {
    const std::string name = upload(file)["name"];
    EXPECT_EQ(wait(name, "inspect")["inspect"]["state"], "done");
    return name;
  }

  test_files::TempFolder folder_;
  std::optional<Studio> studio_;
};

}  // namespace insula::gateway
