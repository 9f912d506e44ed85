// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/session/picture_recorder.h"

#include <unistd.h>
#include <zstd.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "core/base/input_error.h"
#include "core/base/removed_at_end.h"
#include "core/bus/codec.h"
#include "engine/live/bundle.h"
#include "engine/live/frame.h"
#include "engine/session/session_format.h"

namespace insula {
namespace fs = std::filesystem;
namespace {

constexpr int zstd_level = 6;

mcap::Buffer compressed(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  const std::string bytes{std::istreambuf_iterator<char>(in), {}};
  if (!in) throw InputError(file.string() + ": cannot be read");
  mcap::Buffer out(ZSTD_compressBound(bytes.size()));
  const std::size_t n = ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), zstd_level);
  if (ZSTD_isError(n)) throw InputError(file.string() + ": compression failed: " + ZSTD_getErrorName(n));
  out.resize(n);
  return out;
}

}  // namespace

void put_bundle(McapWriter& file, const Simulation& simulation) {
  std::string name = (fs::temp_directory_path() / "insula_bundle_XXXXXX").string();
  if (!::mkdtemp(name.data())) throw InputError(name + ": no folder can be made there");
  const RemovedAtEnd folder(name);
  write_bundle(simulation, folder.path(), 0);
  for (const auto& entry : fs::directory_iterator(folder.path()))
    file.attach(session::bundle_prefix + entry.path().filename().string() + ".zst", "application/zstd", 0,
                compressed(entry.path()));
}

void PictureRecorder::take(const Simulation& simulation, SessionMode mode) {
  fill_frame(simulation, frame_, {mode});
  frame_.sequence = ++number_;
  key_ = since_key_ == 0;
  since_key_ = (since_key_ + 1) % pictures_a_key;
  encoder_.encode(frame_, key_, geometry_bytes_);
  // The geometry stays out of the frame, and keeps its memory for the next picture.
  exchange_geometry();
  frame_.bodies = frame_.drawables = 0;
  encode(frame_, frame_bytes_);
  exchange_geometry();
}

void PictureRecorder::exchange_geometry() {
  frame_.body.swap(geometry_.body);
  frame_.drawable.swap(geometry_.drawable);
  frame_.body_force_N.swap(geometry_.body_force_N);
}

}  // namespace insula
