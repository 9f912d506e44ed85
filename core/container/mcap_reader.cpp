// SPDX-License-Identifier: GPL-3.0-or-later
// The index of a whole file, the walk through a damaged one, and the messages of its chunks.
#include "core/container/mcap_reader.h"

#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <cerrno>

#include "core/base/input_error.h"

namespace insula {
using namespace mcap;
namespace {

constexpr std::uint64_t max_record_bytes = 64u << 20;  // of records other than attachments
constexpr std::uint64_t max_attachment_bytes = 1u << 30;
constexpr std::size_t max_notes = 100;
// Of a chunk: bytes from its start to the name of its compression, and enough to hold its head.
constexpr std::size_t to_compression = record_head + 28;
constexpr std::array<std::uint8_t, 8> zstd_named = {4, 0, 0, 0, 'z', 's', 't', 'd'};
constexpr std::size_t search_block = 1u << 20;

}  // namespace

McapReader::McapReader(const std::filesystem::path& file) : file_(file), in_(std::fopen(file.string().c_str(), "rb")) {
  if (!in_) throw InputError(file.string() + ": cannot be read: " + std::strerror(errno));
  zstd_ = ZSTD_createDCtx();
  std::error_code failed;
  size_ = std::filesystem::file_size(file, failed);
  Buffer begin;
  if (failed || !load(0, magic.size(), begin) || !std::equal(begin.begin(), begin.end(), magic.begin())) {
    std::fclose(in_);
    ZSTD_freeDCtx(zstd_);
    throw InputError(file.string() + ": is not an MCAP file");
  }
  if (Buffer head; load(magic.size(), record_head, head)) {
    Take t(head);
    const auto op = t.number<std::uint8_t>();
    const auto length = t.number<std::uint64_t>();
    if (op == std::uint8_t(Op::header) && length < max_record_bytes && load(magic.size() + record_head, length, head)) {
      Take content(head);
      profile_ = content.string();
      library_ = content.string();
    } else {
      note(magic.size(), "the header is damaged");
    }
  }
  ended_ = read_summary();
  if (!ended_) walk();
  for (const auto& [start, length] : metadata_at_) {
    Buffer one;
    if (!load(start, length, one)) continue;
    Take t(one);
    t.raw(record_head);
    std::string name = t.string();
    Text values = t.text();
    if (t.ok() && one.front() == std::uint8_t(Op::metadata)) described_[std::move(name)] = std::move(values);
    else note(start, "a description is damaged");
  }
}

McapReader::~McapReader() {
  std::fclose(in_);
  ZSTD_freeDCtx(zstd_);
}

void McapReader::note(std::uint64_t at, const std::string& what) {
  if (damage_.size() < max_notes) damage_.push_back(fmt::format("byte {}: {}", at, what));
}

bool McapReader::load(std::uint64_t at, std::uint64_t length, Buffer& into) {
  if (at > size_ || length > size_ - at) return false;
  into.resize(std::size_t(length));
  return std::fseek(in_, long(at), SEEK_SET) == 0 && std::fread(into.data(), 1, into.size(), in_) == into.size();
}

bool McapReader::read_summary() {
  Buffer tail;
  if (size_ < tail_bytes || !load(size_ - tail_bytes, tail_bytes, tail)) return false;
  Take footer(tail);
  if (footer.number<std::uint8_t>() != std::uint8_t(Op::footer) || footer.number<std::uint64_t>() != 20) return false;
  const auto begin = footer.number<std::uint64_t>();
  footer.number<std::uint64_t>();
  const auto said = footer.number<std::uint32_t>();
  if (!std::equal(magic.begin(), magic.end(), tail.end() - std::ptrdiff_t(magic.size()))) return false;
  const std::uint64_t end = size_ - tail_bytes;  // of the summary's records
  if (begin < magic.size() || begin > end || end - begin > max_record_bytes) return false;
  Buffer summary;
  if (!load(begin, size_ - magic.size() - 4 - begin, summary)) return false;
  if (said != 0 && said != crc32(summary)) return false;
  Take t(Bytes(summary).first(std::size_t(end - begin)));
  while (t.left() > 0) {
    const std::uint64_t start = begin + t.at();
    const auto op = Op(t.number<std::uint8_t>());
    const Bytes content = t.raw(t.number<std::uint64_t>());
    if (!t.ok()) return false;
    take_record(op, content, start, record_head + content.size());
  }
  return true;
}

/// False if the entry is damaged or leads out of the file.
bool McapReader::take_index_entry(Op op, Take& t) {
  const auto inside = [&](std::uint64_t at, std::uint64_t n) { return at <= size_ && n <= size_ - at; };
  if (op == Op::chunk_index) {
    Chunk c;
    c.first_ns = t.number<std::uint64_t>();
    c.last_ns = t.number<std::uint64_t>();
    c.start = t.number<std::uint64_t>();
    c.length = t.number<std::uint64_t>();
    if (!t.ok() || !inside(c.start, c.length)) return false;
    chunks_.push_back(c);
  } else if (op == Op::attachment_index) {
    Attachment a;
    a.start = t.number<std::uint64_t>();
    a.length = t.number<std::uint64_t>();
    t.raw(24);
    a.name = t.string();
    a.media_type = t.string();
    if (!t.ok() || !inside(a.start, a.length)) return false;
    attachments_.push_back(std::move(a));
  } else {
    const auto at = t.number<std::uint64_t>();
    const auto n = t.number<std::uint64_t>();
    if (!t.ok() || !inside(at, n) || n > max_record_bytes) return false;
    metadata_at_.emplace_back(at, n);
  }
  return true;
}

void McapReader::take_record(Op op, Bytes content, std::uint64_t start, std::uint64_t length) {
  Take t(content);
  switch (op) {
    case Op::schema: {
      const auto id = t.number<std::uint16_t>();
      Schema s{t.string(), t.string(), t.string()};
      if (t.ok() && id != 0) schemas_.emplace(id, std::move(s));
      else note(start, "a schema is damaged");
      break;
    }
    case Op::channel: {
      const auto id = t.number<std::uint16_t>();
      Channel c;
      c.schema = t.number<std::uint16_t>();
      c.topic = t.string();
      c.encoding = t.string();
      c.metadata = t.text();
      if (t.ok()) channels_.emplace(id, std::move(c));
      else note(start, "a channel is damaged");
      break;
    }
    case Op::chunk_index:
    case Op::attachment_index:
    case Op::metadata_index:
      if (!take_index_entry(op, t)) note(start, "an entry of the index is damaged");
      break;
    case Op::attachment: {  // only the head of its content
      t.raw(16);
      Attachment a;
      a.start = start;
      a.length = length;
      a.name = t.string();
      a.media_type = t.string();
      if (t.ok()) attachments_.push_back(std::move(a));
      else note(start, "an attachment is damaged");
      break;
    }
    case Op::metadata: metadata_at_.emplace_back(start, length); break;
    default: break;
  }
}

/// Without an index: from record to record. A record of impossible length is skipped up to the next chunk.
void McapReader::walk() {
  schemas_.clear();
  channels_.clear();
  chunks_.clear();
  attachments_.clear();
  metadata_at_.clear();
  std::uint64_t at = magic.size();
  Buffer head, content;
  const auto next_chunk = [&](std::uint64_t from) {
    Buffer block;
    for (; from + to_compression + zstd_named.size() <= size_; from += search_block) {
      const std::uint64_t n = std::min<std::uint64_t>(size_ - from, search_block + to_compression + zstd_named.size());
      if (!load(from, n, block)) break;
      for (auto it = block.begin();; ++it) {
        it = std::search(it, block.end(), zstd_named.begin(), zstd_named.end());
        if (it == block.end()) break;
        const auto behind = std::size_t(it - block.begin());
        if (behind >= to_compression && block[behind - to_compression] == std::uint8_t(Op::chunk))
          return from + behind - to_compression;
      }
    }
    return size_;
  };
  while (at < size_) {
    if (!load(at, record_head, head)) {
      note(at, "the file ends within a record");
      break;
    }
    Take t(head);
    const auto op = Op(t.number<std::uint8_t>());
    const auto n = t.number<std::uint64_t>();
    const bool large = op == Op::chunk || op == Op::attachment;
    const bool fits = n <= size_ - at - record_head && (large || n <= max_record_bytes);
    if (std::uint8_t(op) == 0 || !fits) {
      const std::uint64_t next = next_chunk(at + 1);
      note(at, next == size_ ? "the file ends within a record" : "a damaged record was skipped");
      at = next;
      continue;
    }
    if (op == Op::data_end || op == Op::footer) break;
    const std::uint64_t length = record_head + n;
    if (op == Op::chunk) {
      if (!load(at + record_head, std::min<std::uint64_t>(n, 28), content)) break;
      Take c(content);
      Chunk chunk;
      chunk.first_ns = c.number<std::uint64_t>();
      chunk.last_ns = c.number<std::uint64_t>();
      chunk.start = at;
      chunk.length = length;
      chunks_.push_back(chunk);
    } else if (op == Op::schema || op == Op::channel || op == Op::attachment || op == Op::metadata) {
      if (!load(at + record_head, large ? std::min<std::uint64_t>(n, 1u << 16) : n, content)) break;
      take_record(op, content, at, length);
    }
    at += length;
  }
}

std::optional<std::uint16_t> McapReader::channel(std::string_view topic) const {
  for (const auto& [id, c] : channels_)
    if (c.topic == topic) return id;
  return std::nullopt;
}

/// The chunk's records in chunk_; false and a note if they are not what was written.
bool McapReader::unpack(const Chunk& chunk) {
  if (chunk.length > max_chunk_bytes || !load(chunk.start, chunk.length, record_)) {
    note(chunk.start, "a chunk is damaged");
    return false;
  }
  Take t(record_);
  const bool is_chunk = t.number<std::uint8_t>() == std::uint8_t(Op::chunk);
  t.raw(8 + 16);
  const auto whole = t.number<std::uint64_t>();
  const auto said = t.number<std::uint32_t>();
  const std::string compression = t.string();
  const Bytes packed = t.raw(t.number<std::uint64_t>());
  if (!is_chunk || !t.ok() || whole > max_chunk_bytes) {
    note(chunk.start, "a chunk is damaged");
    return false;
  }
  if (compression.empty()) {
    chunk_.assign(packed.begin(), packed.end());
  } else if (compression == "zstd") {
    chunk_.resize(std::size_t(whole));
    const std::size_t n = ZSTD_decompressDCtx(zstd_, chunk_.data(), chunk_.size(), packed.data(), packed.size());
    if (ZSTD_isError(n) || n != chunk_.size()) {
      note(chunk.start, "a chunk is damaged");
      return false;
    }
  } else {
    note(chunk.start, "a chunk has another compression than zstd");
    return false;
  }
  if (said != 0 && said != crc32(chunk_)) {
    note(chunk.start, "the checksum of a chunk is wrong");
    return false;
  }
  return true;
}

void McapReader::read(const std::set<std::uint16_t>& channels, std::uint64_t first_ns, std::uint64_t last_ns,
                      const std::function<bool(const Message&)>& take) {
  for (const Chunk& chunk : chunks_) {
    if (chunk.last_ns < first_ns || chunk.first_ns > last_ns || !unpack(chunk)) continue;
    Take records(chunk_);
    while (records.left() > 0) {
      const auto op = Op(records.number<std::uint8_t>());
      const Bytes content = records.raw(records.number<std::uint64_t>());
      if (!records.ok()) {
        note(chunk.start, "a chunk has an incomplete record");
        break;
      }
      if (op != Op::message) continue;
      Take t(content);
      Message m;
      m.channel = t.number<std::uint16_t>();
      m.sequence = t.number<std::uint32_t>();
      m.time_ns = t.number<std::uint64_t>();
      t.number<std::uint64_t>();
      m.data = t.rest();
      if (!t.ok() || m.time_ns < first_ns || m.time_ns > last_ns || !channels.contains(m.channel)) continue;
      if (!take(m)) return;
    }
  }
}

std::optional<Buffer> McapReader::data(const Attachment& attachment) {
  Buffer all;
  if (attachment.length < record_head + 4 || attachment.length > max_attachment_bytes ||
      !load(attachment.start, attachment.length, all)) {
    note(attachment.start, "an attachment is damaged");
    return std::nullopt;
  }
  const Bytes content = Bytes(all).subspan(record_head);
  Take t(content.first(content.size() - 4));
  t.raw(16);
  t.string();
  t.string();
  const Bytes data = t.raw(t.number<std::uint64_t>());
  const bool whole = t.ok() && t.left() == 0 && all.front() == std::uint8_t(Op::attachment);
  const auto said = Take(content.last(4)).number<std::uint32_t>();
  if (!whole || (said != 0 && said != crc32(content.first(content.size() - 4)))) {
    note(attachment.start, "the attachment \"" + attachment.name + "\" is damaged");
    return std::nullopt;
  }
  return Buffer(data.begin(), data.end());
}

}  // namespace insula
