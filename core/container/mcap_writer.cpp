// SPDX-License-Identifier: GPL-3.0-or-later
// The records of a file in the order of writing, and its summary.
#include "core/container/mcap_writer.h"

#include <zlib.h>
#include <zstd.h>

#include <algorithm>
#include <cerrno>
#include <utility>

#include "core/base/input_error.h"

namespace insula {
using namespace mcap;

std::uint32_t mcap::crc32(Bytes bytes, std::uint32_t before) {
  return std::uint32_t(::crc32_z(before, bytes.data(), bytes.size()));
}

namespace {

Buffer record(Op op, Bytes content) {
  Buffer out;
  Put(out).number(std::uint8_t(op)).number(std::uint64_t(content.size())).raw(content);
  return out;
}

}  // namespace

McapWriter::McapWriter(const std::filesystem::path& file, const std::string& profile, const std::string& library)
    : McapWriter(file, profile, library, Options()) {}

McapWriter::McapWriter(const std::filesystem::path& file, const std::string& profile, const std::string& library,
                       Options options)
    : file_(file), options_(options), out_(std::fopen(file.string().c_str(), "wb")) {
  if (!out_) throw InputError(file.string() + ": cannot be written: " + std::strerror(errno));
  std::setvbuf(out_, nullptr, _IONBF, 0);  // records are whole already
  zstd_ = ZSTD_createCCtx();
  ZSTD_CCtx_setParameter(zstd_, ZSTD_c_compressionLevel, options.level);
  put(magic);
  scratch_.clear();
  Put(scratch_).string(profile).string(library);
  put_record(Op::header, scratch_);
}

McapWriter::~McapWriter() {
  try {
    close();
  } catch (const InputError&) {
    // The caller did not ask.
  }
  if (out_) std::fclose(out_);
  ZSTD_freeCCtx(zstd_);
}

void McapWriter::put(Bytes bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), out_) != bytes.size()) {
    const std::string why = std::strerror(errno);
    std::fclose(out_);
    out_ = nullptr;
    throw InputError(file_.string() + ": cannot be written: " + why);
  }
  at_ += bytes.size();
}

void McapWriter::put_record(Op op, Bytes content) { put(record(op, content)); }

std::uint16_t McapWriter::add_schema(const std::string& name, const std::string& encoding, const std::string& data) {
  if (!out_ || schema_count_ == UINT16_MAX) throw InputError(file_.string() + ": no more schemas");
  const std::uint16_t id = ++schema_count_;
  scratch_.clear();
  Put(scratch_).number(id).string(name).string(encoding).string(data);
  const Buffer one = record(Op::schema, scratch_);
  put(one);
  Put(schemas_).raw(one);
  return id;
}

std::uint16_t McapWriter::add_channel(const std::string& topic, std::uint16_t schema, const std::string& encoding,
                                      const Text& metadata, std::size_t lane) {
  if (!out_ || channel_.size() == UINT16_MAX || lane >= max_lanes)
    throw InputError(file_.string() + ": no more channels");
  channel_.emplace_back();
  channel_.back().lane = lane;
  while (lanes_.size() <= lane) {
    lanes_.emplace_back();
    lanes_.back().chunk.reserve(options_.chunk_bytes + options_.chunk_bytes / 4);
  }
  const auto id = std::uint16_t(channel_.size());
  scratch_.clear();
  Put(scratch_).number(id).number(schema).string(topic).string(encoding).text(metadata);
  const Buffer one = record(Op::channel, scratch_);
  put(one);
  Put(channels_).raw(one);
  return id;
}

void McapWriter::write(std::uint16_t channel, std::uint64_t time_ns, Bytes data) {
  if (!out_) throw InputError(file_.string() + ": is closed");
  Channel& c = channel_.at(std::size_t(channel) - 1);
  auto& [open, chunk] = lanes_[c.lane];
  if (chunk.empty()) open.first_ns = open.last_ns = time_ns;
  open.first_ns = std::min(open.first_ns, time_ns);
  open.last_ns = std::max(open.last_ns, time_ns);
  if (messages_ == 0) first_ns_ = time_ns;
  first_ns_ = std::min(first_ns_, time_ns);
  last_ns_ = std::max(last_ns_, time_ns);
  Put(c.index).number(time_ns).number(std::uint64_t(chunk.size()));
  Put(chunk)
      .number(std::uint8_t(Op::message))
      .number(std::uint64_t(message_head + data.size()))
      .number(channel)
      .number(std::uint32_t(c.messages))
      .number(time_ns)
      .number(time_ns)
      .raw(data);
  ++c.messages;
  ++messages_;
  if (chunk.size() >= options_.chunk_bytes) flush(c.lane);
}

void McapWriter::flush() {
  if (!out_) throw InputError(file_.string() + ": is closed");
  for (std::size_t lane = 0; lane < lanes_.size(); ++lane) flush(lane);
}

void McapWriter::flush(std::size_t lane) {
  if (!out_) throw InputError(file_.string() + ": is closed");
  auto& [open, chunk] = lanes_.at(lane);
  if (chunk.empty()) return;
  packed_.resize(ZSTD_compressBound(chunk.size()));
  const std::size_t n = ZSTD_compress2(zstd_, packed_.data(), packed_.size(), chunk.data(), chunk.size());
  if (ZSTD_isError(n)) throw InputError(file_.string() + ": compression failed: " + ZSTD_getErrorName(n));
  packed_.resize(n);
  open.start = at_;
  open.whole = chunk.size();
  open.packed = n;
  scratch_.clear();
  Put(scratch_)
      .number(open.first_ns)
      .number(open.last_ns)
      .number(open.whole)
      .number(crc32(chunk))
      .string("zstd")
      .number(open.packed)
      .raw(packed_);
  put_record(Op::chunk, scratch_);
  open.length = at_ - open.start;
  open.index_at.clear();
  for (std::size_t k = 0; k < channel_.size(); ++k) {
    Buffer& index = channel_[k].index;
    if (index.empty() || channel_[k].lane != lane) continue;
    open.index_at[std::uint16_t(k + 1)] = at_;
    scratch_.clear();
    Put(scratch_).number(std::uint16_t(k + 1)).number(std::uint32_t(index.size())).raw(index);
    put_record(Op::message_index, scratch_);
    index.clear();
  }
  open.index_length = at_ - open.start - open.length;
  chunks_.push_back(open);
  chunk.clear();
}

void McapWriter::attach(const std::string& name, const std::string& media_type, std::uint64_t time_ns, Bytes data) {
  if (!out_) throw InputError(file_.string() + ": is closed");
  Buffer content;
  content.reserve(data.size() + name.size() + media_type.size() + 64);
  Put(content)
      .number(time_ns)
      .number(time_ns)
      .string(name)
      .string(media_type)
      .number(std::uint64_t(data.size()))
      .raw(data);
  Put(content).number(crc32(content));
  const std::uint64_t start = at_;
  put_record(Op::attachment, content);
  attachments_.push_back({start, at_ - start, time_ns, data.size(), name, media_type});
}

void McapWriter::describe(const std::string& name, const Text& metadata) {
  if (!out_) throw InputError(file_.string() + ": is closed");
  scratch_.clear();
  Put(scratch_).string(name).text(metadata);
  const std::uint64_t start = at_;
  put_record(Op::metadata, scratch_);
  described_.push_back({start, at_ - start, name});
}

void McapWriter::close() {
  if (!out_) return;
  flush();
  scratch_.clear();
  Put(scratch_).number(std::uint32_t(0));  // the chunks have checksums of their own
  put_record(Op::data_end, scratch_);
  put_summary();
  put(magic);
  std::FILE* out = std::exchange(out_, nullptr);
  if (std::fclose(out) != 0) throw InputError(file_.string() + ": cannot be written: " + std::strerror(errno));
}

void McapWriter::put_summary() {
  Buffer summary, content, offsets;
  const std::uint64_t begin = at_;
  std::uint64_t group = begin;
  const auto add = [&](Op op) {
    Put(summary).raw(record(op, content));
    content.clear();
  };
  const auto end_group = [&](Op op) {
    const std::uint64_t end = begin + summary.size();
    if (end > group) {
      Put(content).number(std::uint8_t(op)).number(group).number(end - group);
      Put(offsets).raw(record(Op::summary_offset, content));
      content.clear();
    }
    group = end;
  };
  Put(summary).raw(schemas_);
  end_group(Op::schema);
  Put(summary).raw(channels_);
  end_group(Op::channel);
  for (const ChunkPlace& c : chunks_) {
    Put p(content);
    p.number(c.first_ns).number(c.last_ns).number(c.start).number(c.length);
    p.number(std::uint32_t(10 * c.index_at.size()));
    for (const auto& [channel, place] : c.index_at) p.number(channel).number(place);
    p.number(c.index_length).string("zstd").number(c.packed).number(c.whole);
    add(Op::chunk_index);
  }
  end_group(Op::chunk_index);
  for (const AttachmentPlace& a : attachments_) {
    Put(content).number(a.start).number(a.length).number(a.time_ns).number(a.time_ns).number(a.size);
    Put(content).string(a.name).string(a.media_type);
    add(Op::attachment_index);
  }
  end_group(Op::attachment_index);
  for (const MetadataPlace& m : described_) {
    Put(content).number(m.start).number(m.length).string(m.name);
    add(Op::metadata_index);
  }
  end_group(Op::metadata_index);
  Put p(content);
  p.number(messages_).number(schema_count_).number(std::uint32_t(channel_.size()));
  p.number(std::uint32_t(attachments_.size())).number(std::uint32_t(described_.size()));
  p.number(std::uint32_t(chunks_.size())).number(first_ns_).number(last_ns_);
  p.number(std::uint32_t(10 * channel_.size()));
  for (std::size_t k = 0; k < channel_.size(); ++k) p.number(std::uint16_t(k + 1)).number(channel_[k].messages);
  add(Op::statistics);
  end_group(Op::statistics);

  const std::uint64_t offsets_at = begin + summary.size();
  Put(summary).raw(offsets);
  // The footer's checksum covers its own record up to the checksum.
  Put(summary).number(std::uint8_t(Op::footer)).number(std::uint64_t(20)).number(begin).number(offsets_at);
  Put(summary).number(crc32(summary));
  put(summary);
}

}  // namespace insula
