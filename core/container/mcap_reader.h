// SPDX-License-Identifier: GPL-3.0-or-later
// Reads an MCAP file, whole or damaged. What is whole is given; what is not is described in damage().
//
// The index at the file's end is used when its checksum is right. Otherwise the records are walked from the start.
// Every length is checked against the file before anything is allocated, and every chunk and attachment against its
// checksum.
#pragma once
#include <cstdio>
#include <filesystem>
#include <functional>
#include <optional>
#include <set>

#include "core/container/mcap_format.h"

struct ZSTD_DCtx_s;

namespace insula {

class McapReader {
 public:
  struct Schema {
    std::string name, encoding, data;
  };
  struct Channel {
    std::uint16_t schema = 0;
    std::string topic, encoding;
    mcap::Text metadata;
  };
  struct Chunk {
    std::uint64_t first_ns = 0, last_ns = 0, start = 0, length = 0;
  };
  struct Attachment {
    std::uint64_t start = 0, length = 0;
    std::string name, media_type;
  };
  struct Message {
    std::uint16_t channel = 0;
    std::uint32_t sequence = 0;
    std::uint64_t time_ns = 0;
    mcap::Bytes data;  ///< valid until the function that was given it returns
  };

  /// Throws InputError if the file cannot be opened or does not begin as an MCAP file.
  explicit McapReader(const std::filesystem::path& file);
  ~McapReader();
  McapReader(const McapReader&) = delete;
  McapReader& operator=(const McapReader&) = delete;

  const std::string& profile() const { return profile_; }
  const std::string& library() const { return library_; }  ///< that wrote the file
  const std::map<std::uint16_t, Schema>& schemas() const { return schemas_; }
  const std::map<std::uint16_t, Channel>& channels() const { return channels_; }
  const std::vector<Chunk>& chunks() const { return chunks_; }  ///< in the order of the file
  const std::vector<Attachment>& attachments() const { return attachments_; }
  const std::map<std::string, mcap::Text>& descriptions() const { return described_; }  ///< metadata records, by name
  std::uint64_t bytes() const { return size_; }
  /// Whether the file was ended properly.
  bool ended() const { return ended_; }
  /// What was found damaged until now, for a person: one line each, with its place in the file. At most 100.
  const std::vector<std::string>& damage() const { return damage_; }

  /// The channel of that topic, if the file has it.
  std::optional<std::uint16_t> channel(std::string_view topic) const;
  /// Calls `take` with the messages of these channels with first_ns <= time <= last_ns, chunk by chunk in the order of
  /// the file; it returns false to end. Damaged chunks are left out and noted.
  void read(const std::set<std::uint16_t>& channels, std::uint64_t first_ns, std::uint64_t last_ns,
            const std::function<bool(const Message&)>& take);
  /// Data of an attachment; nothing, and a note, if it is damaged.
  std::optional<mcap::Buffer> data(const Attachment& attachment);

 private:
  bool load(std::uint64_t at, std::uint64_t length, mcap::Buffer& into);
  bool unpack(const Chunk& chunk);
  bool read_summary();
  void walk();
  void take_record(mcap::Op op, mcap::Bytes content, std::uint64_t start, std::uint64_t length);
  bool take_index_entry(mcap::Op op, mcap::Take& entry);
  void note(std::uint64_t at, const std::string& what);

  std::filesystem::path file_;
  std::FILE* in_ = nullptr;
  ZSTD_DCtx_s* zstd_ = nullptr;
  std::uint64_t size_ = 0;
  bool ended_ = false;
  std::string profile_, library_;
  std::map<std::uint16_t, Schema> schemas_;
  std::map<std::uint16_t, Channel> channels_;
  std::vector<Chunk> chunks_;
  std::vector<Attachment> attachments_;
  std::vector<std::pair<std::uint64_t, std::uint64_t>> metadata_at_;
  std::map<std::string, mcap::Text> described_;
  std::vector<std::string> damage_;
  mcap::Buffer record_, chunk_;
};

}  // namespace insula
